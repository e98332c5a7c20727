//! Writes the report as one HTML file that needs no network and no other file. It has its own
//! content security policy (`default-src 'none'`, inline style and script).
//!
//! Without JavaScript it has its tables, its static figures and, by their addresses, the pages of
//! its points. The script (`report.js`) draws zoomable plots in place of the static ones.

mod accuracy;
mod data;
mod points;
mod remarks;
mod shock_film;
mod source;
pub(super) mod text;

pub use shock_film::ShockFilm;
pub use source::ReportSource;

use remarks::{is_reservation, said_of};
use text::{escaped, figure};

use super::critical_shock::critical_shock_figure;
use super::crossings;
use super::margin_curves::margin_curves;
use super::outcome_map::outcome_map;
use super::savings;
use super::table;
use crate::store::summary::{PointSummary, Status, Summary};
use std::fmt::Write as _;

/// The page.
pub fn html(source: &ReportSource<'_>) -> String {
    let summary = source.summary;
    let title = escaped(&summary.study);
    let totals = &summary.totals;
    let mut page = format!(
        r##"<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<title>{title}</title>
<style>
{style}</style>
</head>
<body>
<a class="skip" href="#table">to the table</a>
<header>
<h1>{title}</h1>
<p>{ok} of {points} points bracketed, {above} above and {below} below the searched range, {undecided} undecided, {open} open; {runs} simulations.</p>
<p class="quiet">{program}, study {digest}</p>
</header>
"##,
        style = include_str!("style.css"),
        ok = totals.ok,
        points = totals.points,
        above = totals.above_range,
        below = totals.below_range,
        undecided = totals.undecided,
        open = totals.open,
        runs = totals.runs,
        program = escaped(source.program),
        digest = escaped(&summary.digest),
    );
    let sections = sections(source);
    page.push_str("<nav aria-label=\"Sections\"><ul>\n");
    for section in &sections {
        let _ = writeln!(
            page,
            "<li><a href=\"#{}\">{}</a></li>",
            section.id, section.heading
        );
    }
    page.push_str("</ul></nav>\n<main>\n<div id=\"controls\" role=\"group\" aria-label=\"What the plots show\"></div>\n");
    for section in &sections {
        let _ = write!(
            page,
            "<section id=\"{id}\" aria-labelledby=\"{id}-heading\">\n<h2 id=\"{id}-heading\">{}</h2>\n{}\n</section>\n",
            section.heading,
            section.body,
            id = section.id
        );
    }
    page.push_str("</main>\n");
    page.push_str(&data::block(summary, source.runs, source.film));
    let _ = write!(
        page,
        "<pre id=\"csv\" hidden>{}</pre>\n<script>\n{}</script>\n</body>\n</html>\n",
        escaped(&table::csv(summary)),
        include_str!("report.js")
    );
    page
}

/// One part of the page.
struct Section {
    id: &'static str,
    heading: &'static str,
    body: String,
}

/// The parts, in their order. A part that has nothing to show is left out.
fn sections(source: &ReportSource<'_>) -> Vec<Section> {
    let summary = source.summary;
    let has_runs = !source.runs.is_empty();
    let mut sections = Vec::new();
    let mut add = |id, heading, body: String| sections.push(Section { id, heading, body });
    add(
        "critical",
        "Critical shock",
        replaced(
            &critical_shock_figure(summary, "").svg(),
            "Critical shock against pulse width",
            "critical",
        ),
    );
    add("table", "Table", main_table(summary));
    if !source.crossings.is_empty() {
        let body = crossings::section(source.crossings, &summary.axes);
        add("crossings", "Crossings", body);
    }
    add(
        "points",
        "Points",
        "<p>A name in the table, or a mark in a plot, opens the page of its point here.</p>\n"
            .to_owned()
            + &points::pages(summary, source.runs),
    );
    add(
        "compare",
        "Compare",
        "<div id=\"compare-tool\"></div>".to_owned(),
    );
    if has_runs {
        add(
            "map",
            "Outcome map",
            format!(
                "<p>Every simulation that the answers rest on, at its pulse width and amplitude: \
                 open circles survive, full squares touch.</p>\n{}",
                replaced(
                    &outcome_map(summary, source.runs).svg(),
                    "Outcome of every simulation",
                    "map"
                )
            ),
        );
        add(
            "margin",
            "Margin",
            format!(
                "<p>Smallest clearance between slider and disk against amplitude.</p>\n{}",
                replaced(
                    &margin_curves(summary, source.runs).svg(),
                    "Smallest clearance against amplitude",
                    "margin"
                )
            ),
        );
    }
    if let Some(film) = source.film {
        add(
            "film",
            "One shock",
            format!(
                "<p>{}. Displacements are drawn some hundred times too large; an arm in contact is orange. \
                 The figures of a run without this script: <code>opshock run --plots</code>.</p>\n\
                 <div id=\"film-stage\"></div>",
                escaped(&film.label)
            ),
        );
    }
    if let Some(body) = accuracy::section(summary, source.accuracy) {
        add("accuracy", "Accuracy", body);
    }
    add("effects", "Effects", effects(source));
    add("trouble", "Trouble", reservations(summary));
    add("provenance", "Provenance", provenance(source));
    sections
}

/// Effects simulated for each ramp, those left out, and the rules that apply.
fn effects(source: &ReportSource<'_>) -> String {
    let mut text = String::new();
    let plan: serde_json::Value = serde_json::from_str(source.plan).unwrap_or_default();
    if let Some(ramps) = plan["ramps"].as_object() {
        text.push_str(
            "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">ramp</th><th scope=\"col\">simulated</th>\
             <th scope=\"col\">left out</th><th scope=\"col\">rules below touch</th><th scope=\"col\">rules above touch</th></tr></thead><tbody>\n",
        );
        for (ramp, plan) in ramps {
            let effects = plan["effects"].as_object();
            let list = |wanted: bool| -> String {
                let all = effects.into_iter().flatten();
                let kept = all.filter(|(_, state)| (state.as_str() != Some("off")) == wanted);
                let words: Vec<String> = kept
                    .map(|(name, state)| match state.as_str() {
                        Some("on" | "off") | None => name.clone(),
                        Some(state) => format!("{name} ({state})"),
                    })
                    .collect();
                words.join(", ")
            };
            let rules = |key: &str| -> String {
                let rules = plan[key].as_array().into_iter().flatten();
                rules
                    .filter_map(|rule| rule.as_str())
                    .collect::<Vec<_>>()
                    .join(", ")
            };
            let cells = [
                list(true),
                list(false),
                rules("rules_below_touch"),
                rules("rules_above_touch"),
            ];
            let cells = cells.map(|cell| format!("<td class=\"wrap\">{}</td>", escaped(&cell)));
            let _ = writeln!(
                text,
                "<tr><th scope=\"row\">{}</th>{}</tr>",
                escaped(ramp),
                cells.concat()
            );
        }
        text.push_str("</tbody></table></div>\n");
    }
    let saved = savings::lines(source.savings);
    for line in &saved {
        let _ = writeln!(text, "<p>{}</p>", escaped(line));
    }
    if text.is_empty() {
        text.push_str("<p>The results name no effects.</p>");
    }
    text
}

/// A figure that the script replaces by a zoomable one.
fn replaced(svg: &str, label: &str, plot: &str) -> String {
    let figure = figure(svg, label).replacen("<figure>", "<figure class=\"static\">", 1);
    format!("{figure}<div class=\"plot\" data-plot=\"{plot}\"></div>")
}

fn main_table(summary: &Summary) -> String {
    let (header, rows) = table::readable(summary);
    let words = 3 + summary.axes.len();
    let numeric = |column: usize| column == 1 || (words..words + 5).contains(&column);
    let mut text = String::from(
        "<p>A<sub>crit</sub>: highest surviving amplitude below the lowest failing one, \
         A<sub>fail</sub>. Uncertainty: ends of the uncertainty interval below and above A<sub>crit</sub>. First touch: amplitude at which the disk \
         first reaches the ramp. Shaded rows carry a reservation. A click on a heading sorts.</p>\n\
         <p><button type=\"button\" id=\"copy\">copy as CSV</button> <span id=\"copied\" role=\"status\"></span></p>\n\
         <div class=\"scroll\"><table class=\"sortable\">\n<thead><tr>",
    );
    for (column, name) in header.iter().enumerate() {
        let class = if numeric(column) { " class=\"n\"" } else { "" };
        let _ = write!(
            text,
            "<th scope=\"col\"{class}><button type=\"button\">{}</button></th>",
            escaped(name)
        );
    }
    text.push_str("</tr></thead>\n<tbody>\n");
    for (place, (point, row)) in summary.points.iter().zip(&rows).enumerate() {
        let reserved = point.status != Status::Ok || point.flags.iter().any(is_reservation);
        let class = if reserved { " class=\"reserved\"" } else { "" };
        let _ = write!(text, "<tr data-point=\"{place}\"{class}>");
        for (column, cell) in row.iter().enumerate() {
            let class = if numeric(column) { " class=\"n\"" } else { "" };
            let value = sort_value(point, column, words)
                .map_or(String::new(), |value| format!(" data-v=\"{value}\""));
            let cell = escaped(cell);
            let _ = match column {
                0 => write!(
                    text,
                    "<th scope=\"row\"><a href=\"#point-{place}\">{cell}</a></th>"
                ),
                _ => write!(text, "<td{class}{value}>{cell}</td>"),
            };
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</tbody>\n</table></div>");
    text
}

/// The number a cell sorts by, where its text is not one.
fn sort_value(point: &PointSummary, column: usize, words: usize) -> Option<f64> {
    match column.checked_sub(words)? {
        0 => point.a_crit_g,
        1 => point.a_fail_g,
        2 => point.err_high_g,
        _ => None,
    }
}

fn reservations(summary: &Summary) -> String {
    let mut text = String::new();
    for point in &summary.points {
        let said = said_of(point);
        if said.is_empty() {
            continue;
        }
        let place = summary.points.iter().position(|other| other == point);
        let _ = writeln!(
            text,
            "<li><a href=\"#point-{}\">{}</a>: {}</li>",
            place.unwrap_or_default(),
            escaped(&points::name(summary, point)),
            said.join("; ")
        );
    }
    if text.is_empty() {
        "<p>None: every point is bracketed, nothing was retried.</p>".into()
    } else {
        format!("<ul>\n{text}</ul>")
    }
}

fn provenance(source: &ReportSource<'_>) -> String {
    let summary = source.summary;
    let mut text = String::from("<dl>");
    let mut entry = |name: &str, value: &str| {
        let _ = write!(text, "<dt>{name}</dt><dd>{}</dd>", escaped(value));
    };
    entry("program", source.program);
    entry("study", &summary.study);
    entry("digest", &summary.digest);
    if let Some(values) = source.not_refined() {
        entry("not refined", &values);
    }
    if let Some(audit) = source.audit {
        let mut sentences = vec![audit.sentence()];
        sentences.extend(audit.differences.iter().map(ToString::to_string));
        entry("audit", &sentences.join("; "));
    }
    let cost = &summary.totals.cost;
    entry(
        "work",
        &format!(
            "{} simulations, {} without verdict; {} head steps, {} film solves of up to {} unknowns, {} structure steps",
            summary.totals.runs,
            summary.totals.undecided_runs,
            cost.steps,
            cost.film_solves,
            cost.film_unknowns,
            cost.structure_steps
        ),
    );
    text.push_str("</dl>");
    if let Some(study) = source.resolved_study {
        let _ = write!(
            text,
            "\n<details><summary>The study with every default</summary>\n<pre>{}</pre></details>",
            escaped(study)
        );
    }
    text
}
