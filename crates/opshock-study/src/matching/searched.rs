//! What a search has found so far.

use super::sample::Sample;

/// What a wave did.
#[derive(Clone, Debug, PartialEq)]
pub struct WaveReport {
    /// What was done.
    pub name: String,
    /// Parameter sets tried.
    pub tried: u64,
    /// Those that are not ruled out.
    pub kept: u64,
    /// What the sets kept so far leave of each parameter's range, a share; empty without any.
    pub left: Vec<f64>,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Everything asked for was computed.
    Complete,
    /// A stop was asked for before.
    Stopped,
}

/// All that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Searched {
    /// Parameter sets: draws of the prior first, in their order.
    pub samples: Vec<Sample>,
    /// Draws of the prior among them.
    pub draws: usize,
    /// Measured numerical uncertainty of every observation; 0 where it is given, exact or not measured.
    pub measured_u: Vec<f64>,
    /// Distances of each number outside its range that are usual in the prior.
    pub(super) scales: Vec<f64>,
    /// What was done.
    pub waves: Vec<WaveReport>,
    /// Parameter sets of the refinement, over all starts.
    pub refined: u64,
    /// Groups of observations that were searched in vain.
    pub(super) contradicted: Vec<Contradicted>,
    /// Why it ended.
    pub ended: Ended,
}

impl Searched {
    /// Before anything was done.
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

/// Observations that searches of their own did not find a set for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Contradicted {
    /// Their places.
    pub(super) group: Vec<usize>,
    /// Searches, each from draws of its own.
    pub(super) searches: u64,
    /// Sets they tried.
    pub(super) tried: u64,
}
