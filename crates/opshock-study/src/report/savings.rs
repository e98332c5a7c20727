//! Computes what the rules R1 to R9, which leave out effects that a question does not need, saved in a sweep.
//!
//! Runs are counted. Their cost is given in accepted steps of the head, which take nearly all of a
//! sweep's time, and in seconds at this sweep's own seconds a step. Each saving says by which method
//! the runs not made were estimated. Rules that save building and structure alone are counted and
//! not timed: a few per cent of a sweep together.

use serde::Serialize;

use crate::search::Verdict;
use crate::store::{PointSummary, Results, RunRow, Status};

/// What one rule saved.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Saving {
    /// Rule, as `opshock explain` lists it.
    pub rule: &'static str,
    /// Runs not made, made shorter, or freed of a part; films for R9.
    pub runs: u64,
    /// Head steps not made.
    pub head_steps: u64,
    /// Head steps not made over those that would have been made without the rule.
    pub share: f64,
    /// What those steps would have taken at this sweep's seconds a step; `None` for rules that save
    /// no head steps. Not in JSON, which is the same for a sweep done again.
    #[serde(skip)]
    pub seconds: Option<f64>,
    /// What is counted, or why there is nothing.
    pub method: &'static str,
}

/// Savings of R1 to R9 in a search, in order; none for a sweep with all effects.
pub fn savings(results: &Results) -> Vec<Saving> {
    let plan: serde_json::Value = serde_json::from_str(&results.plan).unwrap_or_default();
    if plan["effects"] != "auto" {
        return Vec::new();
    }
    let made: u64 = results.runs.iter().map(steps).sum();
    // Runs that were taken from another point took no time.
    let timed = results
        .runs
        .iter()
        .filter(|row| row.run.machine.wall_s > 0.0);
    let timed: u64 = timed.map(steps).sum();
    let wall_s: f64 = results.runs.iter().map(|row| row.run.machine.wall_s).sum();
    let counted = |rule, runs: usize, method| Saving {
        rule,
        runs: runs as u64,
        head_steps: 0,
        share: 0.0,
        seconds: None,
        method,
    };
    let of_head = |rule, (runs, head_steps): (u64, u64), method| Saving {
        rule,
        runs,
        head_steps,
        share: match made + head_steps {
            0 => 0.0,
            all => head_steps as f64 / all as f64,
        },
        seconds: (timed > 0).then(|| wall_s * head_steps as f64 / timed as f64),
        method,
    };
    let points = &results.summary.points;
    let plain = || results.runs.iter().filter(|row| row.levels.is_none());
    let is_bare = |row: &&RunRow| points[row.point].ramp == "none";
    let bare = plain().filter(is_bare).count();
    vec![
        counted(
            "R1",
            0,
            "a critical shock needs the moving head in every run",
        ),
        counted(
            "R2",
            bare,
            "runs without ramp, whose disk moves in its axisymmetric modes only",
        ),
        counted(
            "R3",
            plain().count() - bare,
            "runs with a ramp, whose other disk modes were not computed before the first touch",
        ),
        of_head(
            "R4",
            not_repeated(results),
            "runs below the first touch of a ramp, taken from the same point without ramp",
        ),
        counted(
            "R5",
            plain().count() - distinct(plain().map(|row| model(&points[row.point]))),
            "runs with the model and unit response of another amplitude or sign",
        ),
        of_head(
            "R6",
            cut_short(results),
            "failing runs ended at their failure; the time left is estimated by surviving runs of the same point",
        ),
        counted(
            "R7",
            0,
            "both signs are simulated, since a contact depends on the sign",
        ),
        counted("R8", 0, "a search keeps no pressure fields"),
        counted(
            "R9",
            points.len() - distinct(points.iter().map(|point| format!("{:?}", point.axes))),
            "points with film and steady flight of another point",
        ),
    ]
}

/// What points with one model have in common.
fn model(point: &PointSummary) -> String {
    format!("{} {} {:?}", point.ramp, point.pulse_ms, point.axes)
}

fn distinct(keys: impl Iterator<Item = String>) -> usize {
    keys.collect::<std::collections::BTreeSet<_>>().len()
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

/// A line for each rule: what it saved, or why nothing.
pub fn lines(savings: &[Saving]) -> Vec<String> {
    let line = |saving: &Saving| {
        let Saving {
            rule,
            runs,
            head_steps,
            method,
            ..
        } = saving;
        let head = saving.seconds.map_or(String::new(), |seconds| {
            let share = 100.0 * saving.share;
            format!(": {head_steps} time steps of the head, {share:.0} % of the work, about {seconds:.0} s")
        });
        match runs {
            0 => format!("rule {rule} saved nothing: {method}"),
            runs => format!("rule {rule} saved work in {runs} {method}{head}"),
        }
    };
    savings.iter().map(line).collect()
}
