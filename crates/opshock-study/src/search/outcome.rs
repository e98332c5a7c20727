//! How the search of a point ended, and what a reader of its row must know.

use serde::Serialize;

use super::probe::UndecidedCause;

/// How the search of a point ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Bracketed.
    Ok,
    /// No failure up to the highest amplitude of the range: `a_crit_g` is that bound.
    AboveRange,
    /// Fails at the lowest amplitude of the range already: `a_fail_g` is that bound.
    BelowRange,
    /// Runs without a verdict left no bracket.
    Undecided,
    /// The search has not ended.
    Open,
}

impl Status {
    /// Word in products.
    pub fn as_str(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::AboveRange => "above_range",
            Status::BelowRange => "below_range",
            Status::Undecided => "undecided",
            Status::Open => "open",
        }
    }

    /// Reads the word back.
    pub fn parse(text: &str) -> Option<Status> {
        [
            Status::Ok,
            Status::AboveRange,
            Status::BelowRange,
            Status::Undecided,
            Status::Open,
        ]
        .into_iter()
        .find(|status| status.as_str() == text)
    }
}

/// Something a reader of the row must know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Flag {
    /// A survivor lies above a failure; see `brackets_g`.
    NonMonotone,
    /// The highest survivor fails in a doubled window.
    Window,
    /// The doubled window has no verdict.
    WindowUndecided,
    /// A verdict needed another step, coupling or contact method.
    Retry,
    /// A node without verdict widens the bracket or leaves a gap in the scan.
    UndecidedNode,
    /// A run without verdict did not converge.
    NotConverged,
    /// A run without verdict reached the step limit.
    StepLimit,
    /// A run without verdict met a number that is not finite.
    NotFinite,
    /// A run panicked.
    Panicked,
    /// A scene could not be built.
    NotBuilt,
    /// The answer is the no-ramp answer: the disk does not reach the ramp.
    NoTouch,
    /// The amplitude of first touch is not known, so nothing is taken from the no-ramp answer.
    OnsetUnknown,
    /// A part of the error bar does not show its knob's formal order and carries the wide factor.
    BarWide,
    /// A part of the error bar could not be estimated and is not in it.
    BarPartial,
    /// Half the error bar is more than the accuracy asked for.
    BarExceeds,
    /// So it is on the finest rung that the point may climb to.
    BarFloor,
    /// The answer is that of finer knobs than the study's, named in `levels`.
    Climbed,
}

impl Flag {
    const ALL: [Flag; 17] = [
        Flag::NonMonotone,
        Flag::Window,
        Flag::WindowUndecided,
        Flag::Retry,
        Flag::UndecidedNode,
        Flag::NotConverged,
        Flag::StepLimit,
        Flag::NotFinite,
        Flag::Panicked,
        Flag::NotBuilt,
        Flag::NoTouch,
        Flag::OnsetUnknown,
        Flag::BarWide,
        Flag::BarPartial,
        Flag::BarExceeds,
        Flag::BarFloor,
        Flag::Climbed,
    ];

    /// Word in products.
    pub fn as_str(self) -> &'static str {
        match self {
            Flag::NonMonotone => "non_monotone",
            Flag::Window => "window",
            Flag::WindowUndecided => "window_undecided",
            Flag::Retry => "retry",
            Flag::UndecidedNode => "undecided_node",
            Flag::NotConverged => "not_converged",
            Flag::StepLimit => "step_limit",
            Flag::NotFinite => "not_finite",
            Flag::Panicked => "panicked",
            Flag::NotBuilt => "not_built",
            Flag::NoTouch => "no_touch",
            Flag::OnsetUnknown => "onset_unknown",
            Flag::BarWide => "bar_wide",
            Flag::BarPartial => "bar_partial",
            Flag::BarExceeds => "bar_exceeds",
            Flag::BarFloor => "bar_floor",
            Flag::Climbed => "climbed",
        }
    }

    /// Reads the word back.
    pub fn parse(text: &str) -> Option<Flag> {
        Self::ALL.into_iter().find(|flag| flag.as_str() == text)
    }
}

impl From<UndecidedCause> for Flag {
    fn from(cause: UndecidedCause) -> Flag {
        match cause {
            UndecidedCause::NotConverged => Flag::NotConverged,
            UndecidedCause::StepLimit => Flag::StepLimit,
            UndecidedCause::NotFinite => Flag::NotFinite,
            UndecidedCause::Panicked => Flag::Panicked,
            UndecidedCause::NotBuilt => Flag::NotBuilt,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_reads_back() {
        for flag in Flag::ALL {
            assert_eq!(Flag::parse(flag.as_str()), Some(flag));
            assert_eq!(
                serde_json::to_string(&flag).expect("word"),
                format!("\"{}\"", flag.as_str())
            );
        }
        for status in ["ok", "above_range", "below_range", "undecided", "open"] {
            assert_eq!(Status::parse(status).expect("known").as_str(), status);
        }
    }
}
