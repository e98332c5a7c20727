//! Writes the drawn curves as CSV.

use super::case::{Clock, Curve, PaperCase};
use opshock_study::report::column_named;

/// Spacing of the rows of disk and ramp in the tables, s: a tenth of the 20 us mean of the contact
/// force, the fastest curve among them.
const TABLE_STEP_S: f64 = 2e-6;

/// The curves' columns as CSV, named `CASE_COLUMN`. Columns on one time share `time_s`; those on
/// times of their own, as the head's, follow a `CASE_head_time_s` (`CASE_time_s`) and end where it
/// ends.
pub(super) fn table(
    cases: &[(String, &PaperCase)],
    curves: &[Curve],
    zoom_ms: Option<(f64, f64)>,
) -> String {
    let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
    for clock in [Clock::Disk, Clock::Head] {
        let of_clock: Vec<&Curve> = curves.iter().filter(|c| c.clock == clock).collect();
        if of_clock.is_empty() {
            continue;
        }
        let mut shared: Option<&[f64]> = None;
        for (name, case) in cases {
            let source = case.columns(clock);
            let time = column_named(source, "time_s").values.as_slice();
            let rows = rows(time, clock, zoom_ms);
            let taken = |values: &[f64]| rows.iter().map(|&row| values[row]).collect();
            if clock == Clock::Head {
                columns.push((format!("{name}_head_time_s"), taken(time)));
            } else if shared.is_none() {
                columns.push(("time_s".into(), taken(time)));
                shared = Some(time);
            } else if shared != Some(time) {
                columns.push((format!("{name}_time_s"), taken(time)));
            }
            for curve in &of_clock {
                let values = taken(&column_named(source, curve.column).values);
                columns.push((format!("{name}_{}", curve.column), values));
            }
        }
    }
    let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    let mut text = names.join(",") + "\n";
    let longest = columns.iter().map(|(_, values)| values.len()).max();
    for row in 0..longest.unwrap_or(0) {
        let cells: Vec<String> = columns
            .iter()
            .map(|(_, values)| match values.get(row) {
                Some(value) if value.is_finite() => format!("{value:e}"),
                _ => String::new(),
            })
            .collect();
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// Rows of a history that its table holds: all of the head and of a zoom, else every so many.
fn rows(time_s: &[f64], clock: Clock, zoom_ms: Option<(f64, f64)>) -> Vec<usize> {
    let step_s = match time_s {
        [first, second, ..] => second - first,
        _ => TABLE_STEP_S,
    };
    let stride = match (clock, zoom_ms) {
        (Clock::Disk, None) => ((TABLE_STEP_S / step_s).round() as usize).max(1),
        _ => 1,
    };
    (0..time_s.len())
        .step_by(stride)
        .filter(|&row| zoom_ms.is_none_or(|(from, to)| (from..=to).contains(&(1e3 * time_s[row]))))
        .collect()
}
