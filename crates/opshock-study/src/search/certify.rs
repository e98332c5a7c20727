//! Looking for failures below the bracket.
//!
//! Ramp contact makes failure depend on phases, so a shock may fail below amplitudes that it
//! survives. The scan walks down from the highest survivor in steps of at most `scan_gap` nodes.
//! It ends
//!
//! * at the amplitude of first touch, below which the no-ramp answer holds and needs no run, or
//! * where nothing is known from elsewhere, at the low end of the range; then the gap is kept down to
//!   0.71 of the bracket and doubled at every step below that. Windows of failure come with ramp
//!   contact: without a ramp the gap is quadrupled at every step below the first. The row says how
//!   coarse the scan was (`largest_gap_pct`).
//!
//! Scanned nodes are those congruent to a phase modulo the gap; the phases of neighbouring widths
//! differ by the golden ratio of the gap, so that a window of failure that spans several widths
//! meets a finer grid than any one width has. Nodes known from the hunt are used, not repeated.

use super::evidence::{Evidence, NodeVerdict};

/// A step counts as done that is missed by rounding alone.
const ROUNDING: f64 = 1e-9;
/// No range holds more nodes than this.
const WIDEST: i32 = 1 << 28;

/// Scan of one point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scan {
    /// Largest step, nodes.
    pub gap: i32,
    /// Residue of the scanned nodes modulo the gap.
    pub phase: i32,
    /// Nodes over which the gap is kept when nothing bounds the scan from below, and the factor by
    /// which every step below grows; `None` keeps the gap everywhere.
    pub keep: Option<(i32, i32)>,
    /// Lowest node that may be tested.
    pub floor: i32,
}

impl Scan {
    /// Residue of a width's nodes: multiples of the golden ratio fall as far apart as can be.
    pub(super) fn phase_of(width_rank: usize, gap: i32) -> i32 {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let share = ((width_rank + 1) as f64 * GOLDEN).fract();
        (share * f64::from(gap)) as i32
    }

    /// Next node to test going down from `top` (a survivor, or a failure without survivor below).
    pub(super) fn next(&self, evidence: &Evidence, top: i32) -> Option<i32> {
        // Of a scan of every node all that is done at once.
        let mut at = match self.gap {
            1 => evidence.unbroken_below(top, self.floor),
            _ => top,
        };
        loop {
            let gap = self.gap_at(top - at);
            // The node below the floor is answered without a run. A node without verdict bridges
            // nothing: below one that ends the scan the floor itself is tested.
            if at - gap < self.floor {
                let is_sound = evidence.get(at) != Some(NodeVerdict::Undecided) || at == top;
                let is_left = at > self.floor && evidence.get(self.floor).is_none();
                return (!is_sound && is_left).then_some(self.floor);
            }
            match highest_use(evidence, at - gap, at) {
                Some(known) => at = known,
                None => return Some(self.node_below(at, gap)),
            }
        }
    }

    fn gap_at(&self, depth: i32) -> i32 {
        match self.keep {
            // The steps below `keep` are a geometric series; the depth says which comes next.
            Some((keep, growth)) if depth >= keep => {
                let first = f64::from(self.gap * growth);
                let grown = f64::from(depth - keep) * f64::from(growth - 1) / first + 1.0;
                let steps = grown.log(f64::from(growth)) + ROUNDING;
                let share = f64::from(growth).powi(steps as i32);
                (first * share).min(f64::from(WIDEST)) as i32
            }
            _ => self.gap,
        }
    }

    /// The scanned node within `gap` below `at`.
    fn node_below(&self, at: i32, gap: i32) -> i32 {
        if gap == self.gap {
            at - 1 - (at - 1 - self.phase).rem_euclid(self.gap)
        } else {
            at - gap
        }
    }
}

/// Lowest known survivor in `low..at`; an undecided node only when there is no survivor.
fn highest_use(evidence: &Evidence, low: i32, at: i32) -> Option<i32> {
    let known = |verdict| evidence.lowest_with(verdict, low..at);
    known(NodeVerdict::Survives).or_else(|| known(NodeVerdict::Undecided))
}
