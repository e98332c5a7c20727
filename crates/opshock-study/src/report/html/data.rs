//! The data that the page's script draws, as a JSON block of the page.

use super::shock_film::ShockFilm;
use crate::report::chart::{Figure, Scale, colour};
use crate::report::coordinates;
use crate::report::critical_layout::{Layout, PanelOfLines};
use crate::report::outcome_map::RunDot;
use crate::report::terms;
use crate::store::summary::Summary;
use serde_json::{Value, json};

/// Points, runs as `[point, amplitude, verdict, clearance nm]`, and the panels of the critical shocks.
pub(super) fn block(
    summary: &Summary,
    layout: &Layout,
    drawn: &Figure,
    runs: &[RunDot],
    film: Option<&ShockFilm>,
) -> String {
    let points: Vec<Value> = summary
        .points
        .iter()
        .enumerate()
        .map(|(row, point)| {
            // The line of the row, and its abscissa.
            let own = layout.panels.iter().filter(|panel| !panel.is_worst);
            let mut lines = own.flat_map(|panel| panel.lines.iter().map(move |line| (panel, line)));
            let line = lines.find_map(|(panel, line)| {
                let mark = line.marks.iter().find(|(_, marked)| *marked == row)?;
                Some((panel, line, mark.0))
            });
            json!({
                "name": coordinates::name(summary, point),
                "series": line.map(|(_, line, _)| &line.name),
                "line": line.map(|(panel, line, _)| format!("{} {}", panel.title, line.name)),
                "colour": line.map(|(_, line, _)| line.colour),
                "x": line.map(|(_, _, x)| x),
                "sign": point.sign.as_str(),
                "crit": point.known_g(),
                "half": point.uncertainty_g,
                "survived": point.survived_g,
                "failed": point.failed_g,
                "touch": point.onset_g,
                "status": point.status,
                "reserved": terms::is_reserved(point),
            })
        })
        .collect();
    let runs: Vec<Value> = runs
        .iter()
        .map(|run| {
            let clearance = run.h_min_m.map(|h| (h * 1e12).round() / 1e3);
            json!([run.point, run.amplitude_g, run.verdict, clearance])
        })
        .collect();
    let panels: Vec<Value> = layout.panels.iter().map(panel).collect();
    let colours: Vec<String> = colour::CYCLE.into_iter().map(colour::hex).collect();
    let first = drawn.panels.first();
    let words = layout.ticks.iter().any(|(_, word)| word.is_some());
    let layout = json!({
        "label": coordinates::label(summary, layout.x),
        "range": first.and_then(|panel| panel.x.range),
        "words": words.then_some(&layout.ticks),
        "y": {
            "label": first.map(|panel| &panel.y.label),
            "log": first.is_some_and(|panel| panel.y.scale == Scale::Log),
            "range": first.map(|panel| panel.y.range.unwrap_or((0.0, 1.0))),
        },
        "panels": panels,
    });
    let data = json!({
        "points": points, "runs": runs, "film": film, "layout": layout, "colours": colours,
    });
    // A `<` could end the block.
    format!(
        "<script type=\"application/json\" id=\"data\">{}</script>\n",
        data.to_string().replace('<', "\\u003c")
    )
}

fn panel(panel: &PanelOfLines) -> Value {
    let lines = panel.lines.iter().map(|line| {
        let rows: Vec<usize> = line.marks.iter().map(|(_, row)| *row).collect();
        json!({"name": line.name, "colour": line.colour, "style": line.style, "marks": rows})
    });
    json!({"title": panel.title, "worst": panel.is_worst, "lines": lines.collect::<Vec<_>>()})
}
