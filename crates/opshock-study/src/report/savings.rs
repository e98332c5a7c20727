//! What the rules saved in a sweep, from the simulations it finished.
//!
//! Runs are counted. Their cost is told in accepted steps of the head, of which nearly all of a
//! sweep's time is made, so that a report says the same on every machine; what was not run is
//! estimated as the method beside it says.

use serde::Serialize;

use crate::search::Verdict;
use crate::store::{Results, RunRow, Status};

/// What one rule saved.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Saving {
    /// Rule, as `opshock explain` lists it.
    pub rule: &'static str,
    /// Runs not made or made shorter.
    pub runs: u64,
    /// Head steps not made.
    pub head_steps: u64,
    /// Head steps not made over those that would have been made without the rule.
    pub share: f64,
    /// How both were found.
    pub method: &'static str,
}

/// Savings of the rules that act between and within the simulations of a search; none for a sweep
/// with all effects.
pub fn savings(results: &Results) -> Vec<Saving> {
    let plan: serde_json::Value = serde_json::from_str(&results.plan).unwrap_or_default();
    if plan["effects"] != "auto" {
        return Vec::new();
    }
    let made: u64 = results.runs.iter().map(steps).sum();
    let saving = |rule, (runs, head_steps): (u64, u64), method| Saving {
        rule,
        runs,
        head_steps,
        share: match made + head_steps {
            0 => 0.0,
            all => head_steps as f64 / all as f64,
        },
        method,
    };
    vec![
        saving(
            "R4",
            not_repeated(results),
            "counted: runs without ramp below the first touch of a ramp, which that ramp did not \
             repeat, and their steps",
        ),
        saving(
            "R6",
            cut_short(results),
            "counted: failing runs; their steps after touch estimated by the surviving runs of the \
             same point",
        ),
    ]
}

fn steps(row: &RunRow) -> u64 {
    row.result().cost.steps
}

/// Runs of points without ramp below the first touch of the same point with one.
fn not_repeated(results: &Results) -> (u64, u64) {
    let points = &results.summary.points;
    let mut saved = (0, 0);
    for ramped in points.iter().filter(|point| point.status != Status::Open) {
        let Some(onset_g) = ramped.onset_g.filter(|_| ramped.ramp != "none") else {
            continue;
        };
        let bare = points.iter().position(|bare| {
            bare.ramp == "none"
                && bare.pulse_ms == ramped.pulse_ms
                && bare.sign == ramped.sign
                && bare.axes == ramped.axes
        });
        let below = |row: &&RunRow| {
            Some(row.point) == bare && row.levels.is_none() && row.amplitude_g < onset_g
        };
        for row in results.runs.iter().filter(below) {
            saved.0 += 1;
            saved.1 += steps(row);
        }
    }
    saved
}

/// Failing runs, and the steps by which surviving ones of their point are longer on average.
fn cut_short(results: &Results) -> (u64, u64) {
    let mut saved = (0, 0);
    for point in 0..results.summary.points.len() {
        let of_point = |row: &&RunRow| row.point == point && row.levels.is_none();
        let rows: Vec<&RunRow> = results.runs.iter().filter(of_point).collect();
        let survivors: Vec<u64> = rows
            .iter()
            .filter(|row| row.result().verdict == Verdict::Survives)
            .filter(|row| row.run.key.window_factor == 1)
            .map(|row| steps(row))
            .collect();
        let usual = survivors.iter().sum::<u64>() / survivors.len().max(1) as u64;
        for row in rows {
            if matches!(row.result().verdict, Verdict::Fails { .. }) {
                saved.0 += 1;
                saved.1 += usual.saturating_sub(steps(row));
            }
        }
    }
    saved
}

/// A line for each rule.
pub fn lines(savings: &[Saving]) -> Vec<String> {
    let line = |saving: &Saving| {
        format!(
            "{} saved {} runs, {} head steps, {:.0} % of the work ({})",
            saving.rule,
            saving.runs,
            saving.head_steps,
            100.0 * saving.share,
            saving.method
        )
    };
    savings.iter().map(line).collect()
}
