//! The data that the page's script draws, as a JSON block of the page.

use super::points;
use super::shock_film::ShockFilm;
use crate::report::outcome_map::RunDot;
use crate::store::summary::Summary;
use serde_json::{Value, json};

/// Points as lists by column, runs as `[point, amplitude, verdict, clearance nm]`.
pub(super) fn block(summary: &Summary, runs: &[RunDot], film: Option<&ShockFilm>) -> String {
    let points: Vec<Value> = summary
        .points
        .iter()
        .map(|point| {
            let axes: String = summary
                .axes
                .iter()
                .zip(&point.axes)
                .map(|(axis, value)| format!(", {axis} = {value}"))
                .collect();
            json!({
                "name": points::name(summary, point),
                "series": format!("{}{axes}", point.ramp),
                "ms": point.pulse_ms,
                "sign": point.sign.as_str(),
                "crit": point.a_crit_g,
                "fail": point.a_fail_g,
                "low": point.err_low_g,
                "high": point.err_high_g,
                "touch": point.onset_g,
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
    let data = json!({"points": points, "runs": runs, "film": film});
    // A `<` could end the block.
    format!(
        "<script type=\"application/json\" id=\"data\">{}</script>\n",
        data.to_string().replace('<', "\\u003c")
    )
}
