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
    /// How it was found, or why there is nothing.
    pub method: &'static str,
}

/// Savings of R1 to R9 in a search, in order; none for a sweep with all effects.
pub fn savings(results: &Results) -> Vec<Saving> {
    let plan: serde_json::Value = serde_json::from_str(&results.plan).unwrap_or_default();
    if plan["effects"] != "auto" {
        return Vec::new();
    }
    let made: u64 = results.runs.iter().map(steps).sum();
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
        seconds: (made > 0).then(|| wall_s * head_steps as f64 / made as f64),
        method,
    };
    let points = &results.summary.points;
    let plain = || results.runs.iter().filter(|row| row.levels.is_none());
    let is_bare = |row: &&RunRow| points[row.point].ramp == "none";
    let bare = plain().filter(is_bare).count();
    vec![
        counted("R1", 0, "none here: a critical shock needs the moving head"),
        counted(
            "R2",
            bare,
            "counted: runs without ramp, whose disk has no harmonics n >= 1",
        ),
        counted(
            "R3",
            plain().count() - bare,
            "counted: runs with a ramp, whose harmonics n >= 1 were inactive until the first touch",
        ),
        of_head(
            "R4",
            not_repeated(results),
            "counted: runs without ramp below the first touch of a ramp, which that ramp did not \
             repeat, and their steps",
        ),
        counted(
            "R5",
            plain().count() - distinct(plain().map(|row| model(&points[row.point]))),
            "counted: runs on a model and unit response that another amplitude or sign had built",
        ),
        of_head(
            "R6",
            cut_short(results),
            "counted: failing runs; their steps after touch estimated by the surviving runs of the \
             same point",
        ),
        counted(
            "R7",
            0,
            "none here: the sign costs nothing without ramp (R5), and a contact is run for each",
        ),
        counted("R8", 0, "none here: probes of a search keep no fields"),
        counted(
            "R9",
            points.len() - distinct(points.iter().map(|point| format!("{:?}", point.axes))),
            "counted: points that took film and steady flight over from another",
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

/// A line for each rule that saved something, and one for the others.
pub fn lines(savings: &[Saving]) -> Vec<String> {
    let line = |saving: &Saving| {
        let what = if saving.rule == "R9" { "films" } else { "runs" };
        let head = match saving.seconds {
            None => String::new(),
            Some(seconds) => format!(
                ", {} head steps, {:.0} % of the work, some {seconds:.0} s",
                saving.head_steps,
                100.0 * saving.share
            ),
        };
        format!(
            "{} saved {} {what}{head} ({})",
            saving.rule, saving.runs, saving.method
        )
    };
    let (some, none): (Vec<&Saving>, Vec<&Saving>) =
        savings.iter().partition(|saving| saving.runs > 0);
    let mut lines: Vec<String> = some.into_iter().map(line).collect();
    if !none.is_empty() {
        let nothing: Vec<String> = none
            .iter()
            .map(|saving| format!("{} ({})", saving.rule, saving.method))
            .collect();
        lines.push(format!("saved nothing: {}", nothing.join(", ")));
    }
    lines
}
