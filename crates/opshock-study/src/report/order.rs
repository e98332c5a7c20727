//! Rows in the order of a table: further axes, ramp, sign, then width ascending.

use super::outcome_map::RunDot;
use crate::search::Sign;
use crate::store::summary::Summary;
use std::collections::HashMap;

/// The summary and its simulations with the rows in the order of tables. A sweep visits widths
/// from the ends inwards; a reader wants them ascending. Axes and ramps keep the order in which
/// they first appear.
pub fn in_table_order(summary: &Summary, runs: &[RunDot]) -> (Summary, Vec<RunDot>) {
    let points = &summary.points;
    let axes = appearances(points.iter().map(|point| {
        let values: Vec<String> = point.axes.iter().map(ToString::to_string).collect();
        values.join("\u{1f}")
    }));
    let ramps = appearances(points.iter().map(|point| point.ramp.clone()));
    let key = |point: usize| (axes[point], ramps[point], points[point].sign == Sign::Minus);
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        let by_width = points[a].pulse_ms.total_cmp(&points[b].pulse_ms);
        key(a).cmp(&key(b)).then(by_width)
    });
    let mut row_of = vec![0; points.len()];
    for (row, &point) in order.iter().enumerate() {
        row_of[point] = row;
    }
    let ordered = Summary {
        points: order.iter().map(|&point| points[point].clone()).collect(),
        ..summary.clone()
    };
    let runs = runs
        .iter()
        .filter(|run| run.point < points.len())
        .map(|run| RunDot {
            point: row_of[run.point],
            ..run.clone()
        })
        .collect();
    (ordered, runs)
}

/// For every name the place of its first appearance among the different ones.
fn appearances(names: impl Iterator<Item = String>) -> Vec<usize> {
    let mut seen = HashMap::new();
    names
        .map(|name| {
            let next = seen.len();
            *seen.entry(name).or_insert(next)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::summary::{PointSummary, Status, Totals};

    #[test]
    fn widths_ascend_and_runs_follow_their_rows() {
        let point = |ramp: &str, pulse_ms: f64, sign: Sign| PointSummary {
            ramp: ramp.into(),
            pulse_ms,
            sign,
            axes: vec![],
            a_crit_g: None,
            a_fail_g: None,
            err_low_g: None,
            err_high_g: None,
            err_parts: vec![],
            onset_g: None,
            runs: 0,
            status: Status::Open,
            flags: vec![],
            brackets_g: vec![],
            certified_from_g: None,
            largest_gap_pct: None,
        };
        let summary = Summary {
            study: String::new(),
            digest: String::new(),
            axes: vec![],
            points: vec![
                point("none", 0.5, Sign::Plus),
                point("none", 3.0, Sign::Plus),
                point("none", 0.5, Sign::Minus),
                point("rigid", 1.0, Sign::Plus),
                point("none", 1.0, Sign::Plus),
            ],
            totals: Totals::default(),
        };
        let run = |point: usize, amplitude_g: f64| RunDot {
            point,
            amplitude_g,
            verdict: "survives".into(),
            h_min_m: None,
        };
        let (ordered, runs) = in_table_order(&summary, &[run(4, 10.0), run(1, 30.0), run(9, 1.0)]);
        let rows: Vec<(&str, f64, Sign)> = ordered
            .points
            .iter()
            .map(|p| (p.ramp.as_str(), p.pulse_ms, p.sign))
            .collect();
        assert_eq!(
            rows,
            [
                ("none", 0.5, Sign::Plus),
                ("none", 1.0, Sign::Plus),
                ("none", 3.0, Sign::Plus),
                ("none", 0.5, Sign::Minus),
                ("rigid", 1.0, Sign::Plus),
            ]
        );
        let moved: Vec<(usize, f64)> = runs.iter().map(|r| (r.point, r.amplitude_g)).collect();
        assert_eq!(moved, [(1, 10.0), (2, 30.0)]);
    }
}
