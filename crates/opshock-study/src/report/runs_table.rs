//! Lists every simulation behind a table of critical shocks, a row each. Times are s after the onset of the pulse.

use super::table::csv_line;
use crate::search::Verdict;
use crate::store::{Results, RunRow};
use serde_json::{Map, Value, json};

/// CSV: coordinates of the point, then what was asked and answered; what does not exist is empty.
pub fn csv(results: &Results) -> String {
    let rows = rows(results);
    let header = header(results);
    let mut text = csv_line(&header);
    for row in rows {
        let cells: Vec<String> = row
            .into_iter()
            .map(|value| match value {
                Value::Null => String::new(),
                Value::String(text) => text,
                other => other.to_string(),
            })
            .collect();
        text.push_str(&csv_line(&cells));
    }
    text
}

/// `{"study", "digest", "runs": [...]}` with the columns of the CSV as keys.
pub fn json(results: &Results) -> Value {
    let header = header(results);
    let runs: Vec<Value> = rows(results)
        .into_iter()
        .map(|row| Value::Object(header.iter().cloned().zip(row).collect::<Map<_, _>>()))
        .collect();
    json!({
        "study": results.summary.study,
        "digest": results.summary.digest,
        "runs": runs,
    })
}

fn header(results: &Results) -> Vec<String> {
    let before = ["ramp", "pulse_ms", "sign"].into_iter().map(String::from);
    let after = [
        "sequence",
        "purpose",
        "amplitude_g",
        "window_factor",
        "retry",
        "verdict",
        "cause",
        "t_fail_s",
        "x_m",
        "y_m",
        "h_min_m",
        "t_min_s",
        "steps",
        "film_solves",
        "structure_steps",
        "film_unknowns",
        "levels",
    ];
    before
        .chain(results.summary.axes.iter().cloned())
        .chain(after.into_iter().map(String::from))
        .collect()
}

fn rows(results: &Results) -> Vec<Vec<Value>> {
    results
        .runs
        .iter()
        .filter_map(|run| row(results, run))
        .collect()
}

fn row(results: &Results, run: &RunRow) -> Option<Vec<Value>> {
    let point = results.summary.points.get(run.point)?;
    let answer = run.result();
    let (t_fail_s, x_m, y_m, cause) = match &answer.verdict {
        Verdict::Survives => (None, None, None, None),
        Verdict::Fails { t_fail_s, x_m, y_m } => (Some(*t_fail_s), Some(*x_m), Some(*y_m), None),
        Verdict::Undecided { cause, .. } => (None, None, None, Some(cause.as_str())),
    };
    let retry = crate::search::Retry::from_place(run.run.key.retry).map(|retry| retry.label());
    let mut row = vec![
        json!(point.ramp),
        json!(point.pulse_ms),
        json!(point.sign.as_str()),
    ];
    row.extend(point.axes.iter().map(|value| json!(value)));
    row.extend([
        json!(run.sequence),
        json!(run.purpose.as_str()),
        json!(run.amplitude_g),
        json!(run.run.key.window_factor),
        json!(retry.unwrap_or_default()),
        json!(answer.verdict.as_str()),
        json!(cause),
        json!(t_fail_s),
        json!(x_m),
        json!(y_m),
        json!(answer.h_min_m),
        json!(answer.t_min_s),
        json!(answer.cost.steps),
        json!(answer.cost.film_solves),
        json!(answer.cost.structure_steps),
        json!(answer.cost.film_unknowns),
        json!(run.levels.label()),
    ]);
    Some(row)
}
