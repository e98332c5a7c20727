//! Results of a search for matching parameter sets so far.

use super::sample::Sample;

/// Report of a wave.
#[derive(Clone, Debug, PartialEq)]
pub struct WaveReport {
    /// Name of the wave.
    pub name: String,
    /// Parameter sets tried.
    pub tried: u64,
    /// Those that are not ruled out.
    pub kept: u64,
    /// Share of each parameter's range that the sets so far leave; empty without any.
    pub left: Vec<f64>,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Everything asked for was computed.
    Complete,
    /// A stop was requested before.
    Stopped,
}

/// All results.
#[derive(Clone, Debug, PartialEq)]
pub struct Searched {
    /// Parameter sets: draws of the prior first, in their order.
    pub samples: Vec<Sample>,
    /// Draws of the prior among them.
    pub draws: usize,
    /// Measured numerical uncertainty of every observation; 0 where it is given, exact or not measured.
    pub measured_u: Vec<f64>,
    /// Typical distance of each number outside its range in the prior.
    pub(super) scales: Vec<f64>,
    /// Waves.
    pub waves: Vec<WaveReport>,
    /// Parameter sets of the refinement, over all starts.
    pub refined: u64,
    /// Groups of observations that were searched in vain.
    pub(super) contradicted: Vec<Contradicted>,
    /// Why it ended.
    pub ended: Ended,
}

impl Searched {
    /// Before any wave.
    pub(super) fn nothing(observations: usize) -> Self {
        Self {
            samples: Vec::new(),
            draws: 0,
            measured_u: vec![0.0; observations],
            scales: vec![1.0; observations],
            waves: Vec::new(),
            refined: 0,
            contradicted: Vec::new(),
            ended: Ended::Complete,
        }
    }
}

/// Observations for which searches of their own found no set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Contradicted {
    /// Their places.
    pub(super) group: Vec<usize>,
    /// Searches, each from draws of its own.
    pub(super) searches: u64,
    /// Sets they tried.
    pub(super) tried: u64,
}
