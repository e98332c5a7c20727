//! Texts of progress events, for tables and lines.

use super::event::Estimate;
use crate::store::summary::{PointSummary, Totals};
use crate::sweep::options::Ending;
use crate::sweep::spread::Spread;

/// `331.2 to 334.5 G`, `above 2000 G`, `below 20 G`.
pub(super) fn answer(summary: &PointSummary) -> String {
    bracket(summary.survived_g, summary.failed_g)
}

pub(super) fn bracket(survived_g: Option<f64>, failed_g: Option<f64>) -> String {
    match (survived_g, failed_g) {
        (Some(low), Some(high)) => format!("{} to {} G", short(low), short(high)),
        (Some(low), None) => format!("above {} G", short(low)),
        (None, Some(high)) => format!("below {} G", short(high)),
        (None, None) => "no verdict".into(),
    }
}

/// Four significant digits.
fn short(value: f64) -> String {
    let digits = 3 - value.abs().max(1.0).log10().floor() as i32;
    format!("{value:.*}", digits.max(0) as usize)
}

/// What is done of `points` and left, in words.
pub(super) fn left(estimate: &Estimate, points: usize) -> String {
    let Spread { min, max, .. } = estimate.runs_left;
    let runs = format!(
        "{} of {points} points bracketed, {} answered; {} runs done, {min:.0} to {max:.0} left",
        estimate.bracketed, estimate.answered, estimate.runs_done
    );
    match estimate.left_s {
        Some(left_s) if max > 0.0 => {
            let (least, most) = (duration(left_s.min), duration(left_s.max));
            format!("{runs}, {least} to {most}")
        }
        _ => runs,
    }
}

fn duration(seconds: f64) -> String {
    let whole = seconds.ceil().max(1.0) as u64;
    match whole {
        0..90 => format!("{whole} s"),
        90..5400 => format!("{} min", (whole + 30) / 60),
        _ => format!("{} h {:02} min", whole / 3600, whole / 60 % 60),
    }
}

/// What a stop waits for.
pub(super) fn stopping(in_flight: usize, ending: Ending) -> String {
    let waits = format!("stopping: {in_flight} simulations at work end first");
    match ending {
        Ending::Stopped { .. } => waits + "; a second signal (Ctrl-C) ends at once",
        Ending::Budget | Ending::Complete => waits,
    }
}

/// Last line. `bracketed` points lack their uncertainty alone.
pub(super) fn finished(totals: &Totals, bracketed: u64, wall_s: f64, core_use: f64) -> String {
    let mut parts = Vec::new();
    for (count, word) in [
        (totals.ok, "answered"),
        (totals.above_range, "above the range"),
        (totals.below_range, "below the range"),
        (totals.undecided, "undecided"),
        (bracketed, "bracketed without their uncertainty"),
        (totals.open - bracketed, "not finished"),
    ] {
        if count > 0 {
            parts.push(format!("{count} {word}"));
        }
    }
    format!(
        "{} points: {}; {} runs, {} without verdict; {}, cores {:.0} % busy",
        totals.points,
        parts.join(", "),
        totals.runs,
        totals.undecided_runs,
        duration(wall_s),
        100.0 * core_use
    )
}
