//! Sentences for the status and the flags of a point.

use crate::store::summary::{Flag, PointSummary, Status};

/// `NoTouch` says where an answer comes from and takes nothing from it.
pub(super) fn is_reservation(flag: &Flag) -> bool {
    *flag != Flag::NoTouch
}

/// What a reader must know of a point, in sentences.
pub(super) fn said_of(point: &PointSummary) -> Vec<&'static str> {
    let mut said: Vec<&str> = match point.status {
        Status::Ok => Vec::new(),
        Status::AboveRange => vec!["no failure up to the end of the searched range"],
        Status::BelowRange => vec!["fails at the start of the searched range already"],
        Status::Undecided => vec!["runs without verdict left no bracket"],
        Status::Open => vec!["the search, or that of its uncertainty, has not ended"],
    };
    let flags = point.flags.iter().filter(|flag| is_reservation(flag));
    said.extend(flags.map(|flag| sentence(*flag)));
    said
}

fn sentence(flag: Flag) -> &'static str {
    match flag {
        Flag::NonMonotone => {
            "failure is not monotone in amplitude: a survivor lies above a failure"
        }
        Flag::Window => "the highest survivor fails in a window twice as long",
        Flag::WindowUndecided => "the window twice as long has no verdict",
        Flag::Retry => "a verdict needed smaller steps or another method",
        Flag::UndecidedAmplitude => "an amplitude without verdict widens the bracket",
        Flag::NotConverged => "a run did not converge",
        Flag::StepLimit => "a run reached its step limit",
        Flag::NotFinite => "a run met a number that is not finite",
        Flag::Panicked => "a run broke down",
        Flag::NotBuilt => "a scene could not be built",
        Flag::NoTouch => "the disk does not reach the ramp",
        Flag::OnsetUnknown => "the amplitude of first touch is not known",
        Flag::SafetyFactor3 => {
            "a contribution shows no formal order: its safety factor is 3 instead of 1.25"
        }
        Flag::ContributionMissing => "a contribution to the uncertainty could not be estimated",
        Flag::TargetNotMet => "the half-width of the interval is more than the target uncertainty",
        Flag::RefinementLimit => {
            "no refinement is left: max_refinements or every parameter is exhausted, or the refined scene has no verdict"
        }
        Flag::Refined => "answered with refined discretisation parameters",
    }
}
