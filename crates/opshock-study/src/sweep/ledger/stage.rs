//! How far the error bar of a point has got, and its runs as probes.

use crate::search::evidence::NodeVerdict;
use crate::search::{Asked, Probe, ProbeResult, Purpose, Verdict, bar};

/// Error bar of a point as far as it has got.
pub(super) enum BarStage {
    /// The point's search is not final.
    Waiting,
    /// None is wanted, or there is no bracket.
    Without,
    /// The answer, and with it the bar, is that of the same point without ramp.
    Taken {
        /// That point.
        companion: usize,
    },
    /// Begun.
    Begun {
        input: Box<bar::BarInput>,
        log: Vec<bar::Ask>,
        progress: bar::Progress<bar::Answer>,
    },
}

/// A run of an error bar as a probe.
pub(super) fn bar_probe(ask: bar::Ask) -> Probe {
    Probe {
        is_fine: true,
        levels: ask.levels,
        retry: ask.retry,
        ..Probe::at(ask.index)
    }
}

pub(super) fn bar_asked(ask: bar::Ask) -> Asked {
    Asked {
        probe: bar_probe(ask),
        purpose: Purpose::ErrorBar,
    }
}

/// A run as an error bar sees it.
pub(super) fn seen(result: &ProbeResult) -> bar::Seen {
    bar::Seen {
        verdict: match result.verdict {
            Verdict::Survives => NodeVerdict::Survives,
            Verdict::Fails { .. } => NodeVerdict::Fails,
            Verdict::Undecided { .. } => NodeVerdict::Undecided,
        },
        h_min_m: result.h_min_m,
        t_min_s: result.t_min_s,
    }
}
