//! From differences between levels of a knob to the error of the scene as it is.
//!
//! Every knob is turned coarser: the runs are cheaper than those of the search, and what is left of
//! the error is a fraction of what is seen.

use opshock_solver::scene::knob::{Knob, Levels};

use crate::search::lattice::Lattice;

/// Factor on an error whose order is the formal one.
pub(super) const NARROW: f64 = 1.25;
/// Factor on any other.
pub(super) const WIDE: f64 = 3.0;
/// Share of the accuracy asked below which a part is not looked at closer.
pub(super) const NEGLIGIBLE: f64 = 0.25;
/// An observed ratio counts as the formal one within half an order of refinement by two.
const HALF_ORDER: f64 = std::f64::consts::SQRT_2;
/// Slowest ratio that is believed.
const SLOWEST: f64 = 1.25;

/// Error of the reported amplitude, as a share, and its factor of safety.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    pub share: f64,
    pub factor: f64,
}

impl Estimate {
    /// The error with its factor of safety.
    pub(super) fn error(self) -> f64 {
        self.share * self.factor
    }

    /// Too little to matter.
    pub(super) fn is_negligible(self, accuracy: f64) -> bool {
        self.error() <= NEGLIGIBLE * accuracy
    }

    /// So much that the bar exceeds what was asked by this part alone, whatever its order.
    pub(super) fn is_excessive(self, accuracy: f64) -> bool {
        self.share * NARROW > 2.0 * accuracy
    }
}

fn is_formal(observed: f64, formal: f64) -> bool {
    observed > formal / HALF_ORDER && observed < formal * HALF_ORDER
}

/// These levels with some knobs a step coarser.
pub(super) fn coarser(levels: Levels, knobs: &[Knob]) -> Levels {
    let turn = |levels: Levels, &knob: &Knob| levels.turned(knob, -1);
    knobs.iter().fold(levels, turn)
}

/// Slowest formal ratio of some knobs.
fn slowest(knobs: &[Knob]) -> f64 {
    let ratios = knobs.iter().map(|knob| knob.formal_ratio());
    ratios.fold(f64::INFINITY, f64::min)
}

/// Error of knobs turned together by one step, from the change of the answer: no order was
/// observed. The slowest of them counts.
pub(super) fn one_step(knobs: &[Knob], change: f64) -> Estimate {
    Estimate {
        share: change.abs() / (slowest(knobs) - 1.0),
        factor: WIDE,
    }
}

/// Error from two steps: `near` is level -1 minus the scene, `far` level -2 minus level -1.
pub(super) fn two_steps(knobs: &[Knob], near: f64, far: f64) -> Estimate {
    let formal = slowest(knobs);
    let observed = far / near;
    if is_formal(observed, formal) {
        Estimate {
            share: near.abs() / (observed.min(formal) - 1.0),
            factor: NARROW,
        }
    } else if observed > formal {
        // Faster than the order: what is left is less than it says, by how much is not known.
        Estimate {
            share: near.abs() / (observed.min(4.0 * formal) - 1.0),
            factor: WIDE,
        }
    } else if observed > 1.0 {
        // Slower: more is left than it says.
        Estimate {
            share: near.abs() / (observed.max(SLOWEST) - 1.0),
            factor: WIDE,
        }
    } else {
        Estimate {
            share: near.abs().max(far.abs() / formal),
            factor: WIDE,
        }
    }
}

/// Bound from verdicts that agree with those of the reference at both ends of its bracket, `nodes`
/// wide: the answer moved by less. The narrow factor is for knobs that move it against each other.
pub(super) fn agreement(lattice: &Lattice, nodes: i32, knobs: &[Knob]) -> Estimate {
    Estimate {
        factor: NARROW,
        ..one_step(knobs, f64::from(nodes) * lattice.step())
    }
}
