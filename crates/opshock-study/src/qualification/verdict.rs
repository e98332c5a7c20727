//! Verdicts of points, requirements and specifications from critical shocks and their uncertainty intervals.

use serde::Serialize;

use crate::search::Flag;
use crate::search::decisive::FAR;
use crate::store::summary::{PointSummary, Status, Summary};

/// Whether something that is required holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It does not, whatever the numerical uncertainty.
    Fails,
    /// The numerical uncertainty leaves it open, or there is no answer.
    Undecided,
    /// It does, whatever the numerical uncertainty.
    Passes,
}

impl Verdict {
    /// As people read it.
    pub const fn as_str(self) -> &'static str {
        match self {
            Verdict::Fails => "fails",
            Verdict::Undecided => "undecided",
            Verdict::Passes => "passes",
        }
    }

    /// Of several things that must all hold: one that fails is enough.
    pub fn of_all(verdicts: impl IntoIterator<Item = Verdict>) -> Verdict {
        verdicts.into_iter().min().unwrap_or(Verdict::Undecided)
    }
}

/// Why a point is undecided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Open {
    /// The uncertainty interval holds the required amplitude.
    Interval,
    /// A contribution to the uncertainty interval is missing.
    Contribution,
    /// The largest survivor fails, or has no verdict, in a simulated time twice as long.
    Window,
    /// An amplitude without verdict lies below the largest survivor, or next to it.
    Amplitude,
    /// It has a bracket alone.
    NoInterval,
    /// The search found no critical shock, or has not ended.
    NoAnswer,
}

impl Open {
    /// In a sentence.
    pub const fn words(self) -> &'static str {
        match self {
            Open::Interval => "its uncertainty interval contains the required amplitude",
            Open::Contribution => "a contribution to its uncertainty interval is missing",
            Open::Window => {
                "its largest survivor does not survive a simulated time (pulse.window_ms) twice as long"
            }
            Open::Amplitude => "a shock near or below its critical shock has no verdict",
            Open::NoInterval => "it has no uncertainty interval",
            Open::NoAnswer => "the search found no critical shock",
        }
    }
}

/// Verdict on a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointVerdict {
    /// The verdict.
    pub verdict: Verdict,
    /// Why it is undecided.
    pub open: Option<Open>,
    /// Where the critical shock may lie, G: its uncertainty interval; a bound where the search ended at an end of its
    /// range, with 0 or infinity as the other end.
    pub interval_g: Option<[f64; 2]>,
    /// Reserve: from the required amplitude to the reported critical shock, or to the bound, a share of the former.
    pub reserve: Option<f64>,
}

impl PointVerdict {
    /// Of a row against the amplitude that it must survive.
    pub fn of(row: &PointSummary, required_g: f64) -> PointVerdict {
        // So far below the amplitude a bracket is enough.
        let far_below = row.failed_g.filter(|failed_g| FAR * failed_g <= required_g);
        let bound_g = far_below.map(|failed_g| [0.0, failed_g]);
        let interval_g = row.interval_g().or(bound_g);
        let has = |flag| row.flags.contains(&flag);
        let (verdict, open) = match interval_g {
            None if row.status == Status::Ok => (Verdict::Undecided, Some(Open::NoInterval)),
            None => (Verdict::Undecided, Some(Open::NoAnswer)),
            Some(_) if row.uncertainty_g.is_some() && !row.has_whole_interval() => {
                (Verdict::Undecided, Some(Open::Contribution))
            }
            // The lower end survives, the upper end fails.
            Some([low_g, _]) if low_g >= required_g => {
                if has(Flag::Window) || has(Flag::WindowUndecided) {
                    (Verdict::Undecided, Some(Open::Window))
                } else if has(Flag::UndecidedAmplitude) {
                    (Verdict::Undecided, Some(Open::Amplitude))
                } else {
                    (Verdict::Passes, None)
                }
            }
            Some([_, high_g]) if high_g <= required_g => (Verdict::Fails, None),
            Some(_) => (Verdict::Undecided, Some(Open::Interval)),
        };
        PointVerdict {
            verdict,
            open,
            interval_g,
            reserve: row.known_g().map(|known_g| known_g / required_g - 1.0),
        }
    }
}

/// Verdict on a requirement.
#[derive(Clone, Debug, PartialEq)]
pub struct RequirementVerdict {
    /// That of all points together.
    pub verdict: Verdict,
    /// Of every row of the table.
    pub points: Vec<PointVerdict>,
    /// Row that decides: of those with the worst verdict the one whose interval begins lowest; `None` where no row of that
    /// verdict has an interval.
    pub worst: Option<usize>,
}

impl RequirementVerdict {
    /// Of a table against the amplitude that every point must survive.
    pub fn of(summary: &Summary, required_g: f64) -> RequirementVerdict {
        let rows = summary.points.iter();
        let points: Vec<PointVerdict> = rows.map(|row| PointVerdict::of(row, required_g)).collect();
        let verdict = Verdict::of_all(points.iter().map(|point| point.verdict));
        let deciding = points.iter().enumerate();
        let deciding = deciding.filter(|(_, point)| point.verdict == verdict);
        let lowest = deciding.filter_map(|(place, point)| Some((place, point.interval_g?[0])));
        RequirementVerdict {
            verdict,
            worst: lowest
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .map(|(place, _)| place),
            points,
        }
    }
}
