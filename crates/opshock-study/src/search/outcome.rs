//! How the search of a point ended, and the flags of its row in the table.

use serde::Serialize;

use super::probe::UndecidedCause;

/// How the search of a point ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Bracketed.
    Ok,
    /// No failure up to the highest amplitude of the range: `survived_g` is that bound.
    AboveRange,
    /// Fails at the lowest amplitude of the range already: `failed_g` is that bound.
    BelowRange,
    /// Runs without a verdict left no bracket.
    Undecided,
    /// The search has not ended.
    Open,
}

impl Status {
    /// All of them.
    pub const ALL: [Status; 5] = [
        Status::Ok,
        Status::AboveRange,
        Status::BelowRange,
        Status::Undecided,
        Status::Open,
    ];

    /// Name in output files.
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
        Self::ALL.into_iter().find(|status| status.as_str() == text)
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
    /// A grid point without verdict widens the bracket or leaves a gap in the scan.
    UndecidedAmplitude,
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
    /// A contribution to the uncertainty interval shows no formal order and carries the safety factor 3.
    #[serde(rename = "safety_factor_3")]
    SafetyFactor3,
    /// A contribution to the uncertainty interval could not be estimated and is missing from it.
    ContributionMissing,
    /// The half-width of the uncertainty interval is more than the target uncertainty.
    TargetNotMet,
    /// `TargetNotMet`, and no refinement is left: all parameters or `max_refinements` are exhausted, or the refined scene has
    /// no verdict.
    RefinementLimit,
    /// The answer is that of parameters refined beyond the study's, named in `levels`.
    Refined,
    /// The clearance called failure is below twice the minimum film height: the film's pressure there is that of a limited height.
    BelowContinuum,
}

impl Flag {
    /// All flags, in the order of the table's rows.
    pub const ALL: [Flag; 18] = [
        Flag::NonMonotone,
        Flag::Window,
        Flag::WindowUndecided,
        Flag::Retry,
        Flag::UndecidedAmplitude,
        Flag::NotConverged,
        Flag::StepLimit,
        Flag::NotFinite,
        Flag::Panicked,
        Flag::NotBuilt,
        Flag::NoTouch,
        Flag::OnsetUnknown,
        Flag::SafetyFactor3,
        Flag::ContributionMissing,
        Flag::TargetNotMet,
        Flag::RefinementLimit,
        Flag::Refined,
        Flag::BelowContinuum,
    ];

    /// Name in output files.
    pub fn as_str(self) -> &'static str {
        match self {
            Flag::NonMonotone => "non_monotone",
            Flag::Window => "window",
            Flag::WindowUndecided => "window_undecided",
            Flag::Retry => "retry",
            Flag::UndecidedAmplitude => "undecided_amplitude",
            Flag::NotConverged => "not_converged",
            Flag::StepLimit => "step_limit",
            Flag::NotFinite => "not_finite",
            Flag::Panicked => "panicked",
            Flag::NotBuilt => "not_built",
            Flag::NoTouch => "no_touch",
            Flag::OnsetUnknown => "onset_unknown",
            Flag::SafetyFactor3 => "safety_factor_3",
            Flag::ContributionMissing => "contribution_missing",
            Flag::TargetNotMet => "target_not_met",
            Flag::RefinementLimit => "refinement_limit",
            Flag::Refined => "refined",
            Flag::BelowContinuum => "below_continuum",
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
        for status in Status::ALL {
            assert_eq!(Status::parse(status.as_str()), Some(status));
        }
    }
}
