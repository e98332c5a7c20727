//! How a search is made.

use super::lattice::{Lattice, LatticeError, NodeRange};

/// How thoroughly lower failures are looked for below the bracket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Certify {
    /// Not at all: failure is taken to be monotone.
    Off,
    /// Nodes at most `max_gap` apart, shifted from width to width so that neighbouring widths
    /// fill each other's gaps.
    Staggered,
    /// Every node.
    Full,
}

/// Settings of every point's search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchSettings {
    /// Lattice of the tolerance.
    pub lattice: Lattice,
    /// Nodes searched.
    pub range: NodeRange,
    /// Scan below the bracket.
    pub certify: Certify,
    /// Largest step between scanned nodes, in nodes.
    pub scan_gap: i32,
    /// Rerun the highest survivor in a doubled window.
    pub window_check: bool,
    /// Nodes without verdict after which a point is given up.
    pub max_undecided: usize,
}

/// Four undecided nodes are twenty runs with their retries.
const MAX_UNDECIDED: usize = 4;

impl SearchSettings {
    /// Settings from a study's numbers: amplitudes in G, tolerance and gap as shares.
    ///
    /// # Errors
    ///
    /// [`LatticeError`].
    pub fn new(
        (min_g, max_g): (f64, f64),
        tolerance: f64,
        certify: Certify,
        max_gap: f64,
        window_check: bool,
    ) -> Result<SearchSettings, LatticeError> {
        let lattice = Lattice::for_tolerance(tolerance)?;
        Ok(SearchSettings {
            lattice,
            range: lattice.range(min_g, max_g)?,
            certify,
            scan_gap: lattice.nodes_within(max_gap.max(0.0)),
            window_check,
            max_undecided: MAX_UNDECIDED,
        })
    }
}
