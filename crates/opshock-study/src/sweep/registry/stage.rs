//! State of a point's uncertainty interval, and its runs as probes.

use crate::search::evidence::AmplitudeVerdict;
use crate::search::{Asked, Probe, ProbeResult, Purpose, Verdict, uncertainty};

/// How far the uncertainty of a point is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sweep) enum Depth {
    /// It has its bracket alone.
    Bracket,
    /// An interval with so many refinements at most.
    Refined(u8),
}

impl Depth {
    /// One step further.
    pub(in crate::sweep) fn next(self) -> Depth {
        match self {
            Depth::Bracket => Depth::Refined(0),
            Depth::Refined(refinements) => Depth::Refined(refinements + 1),
        }
    }

    /// Largest number of refinements; `None` without an interval.
    pub(in crate::sweep) fn refinements(self) -> Option<u8> {
        match self {
            Depth::Bracket => None,
            Depth::Refined(refinements) => Some(refinements),
        }
    }
}

/// Uncertainty interval of a point as far as it has got.
pub(super) enum UncertaintyStage {
    /// The point's search is not final.
    Waiting,
    /// None is wanted, or there is no bracket.
    Without,
    /// The answer, and with it the interval, is that of the same point without ramp.
    Taken {
        /// That point.
        companion: usize,
    },
    /// Begun.
    Begun {
        input: Box<uncertainty::UncertaintyInput>,
        log: Vec<uncertainty::Ask>,
        progress: uncertainty::Progress<uncertainty::Answer>,
    },
}

/// A run of an uncertainty interval as a probe.
pub(in crate::sweep) fn uncertainty_probe(ask: uncertainty::Ask) -> Probe {
    Probe {
        is_fine: true,
        levels: ask.levels,
        retry: ask.retry,
        ..Probe::at(ask.index)
    }
}

pub(in crate::sweep) fn uncertainty_asked(ask: uncertainty::Ask) -> Asked {
    Asked {
        probe: uncertainty_probe(ask),
        purpose: Purpose::Uncertainty,
    }
}

/// A run as an uncertainty interval sees it where clearances below `fail_below_m` are called failure.
pub(in crate::sweep) fn seen(result: &ProbeResult, fail_below_m: f64) -> uncertainty::Seen {
    uncertainty::Seen {
        verdict: match result.verdict {
            Verdict::Survives => AmplitudeVerdict::Survives,
            Verdict::Fails { .. } => AmplitudeVerdict::Fails,
            Verdict::Undecided { .. } => AmplitudeVerdict::Undecided,
        },
        h_min_m: result.h_min_m.map(|h_min_m| h_min_m - fail_below_m),
        t_min_s: result.t_min_s,
    }
}
