//! From differences between levels of a knob to the error of the scene as it is.
//!
//! Every knob is turned a step coarser first: the runs are cheaper than those of the search. Where
//! that moves the answer by what counts, one step finer tells more: knobs that are loose, as those of
//! a cheap scene are, gain more by a step than their order says, so that coarser runs make a large
//! error of a small one.

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
/// Share of what held films say that the slope of the margin, which is measured over some per cent, and the
/// continuation of the grid may be off by.
const CONTINUED: f64 = 0.1;
/// Slowest ratio that is believed.
const SLOWEST: f64 = 1.25;

/// Error of the reported amplitude: what was seen of it, and what is thought to be left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    /// Change of the answer by a finer scene, downwards and upwards, shares: certain, so they carry no factor.
    pub known: [f64; 2],
    /// Error beyond that, either way, a share.
    pub share: f64,
    /// Factor of safety on it.
    pub factor: f64,
}

impl Estimate {
    /// How far below and above the answer the truth may lie, with the factor of safety.
    pub(super) fn errors(self) -> [f64; 2] {
        self.known.map(|known| known + self.share * self.factor)
    }

    /// The larger of the two.
    pub(super) fn error(self) -> f64 {
        let [below, above] = self.errors();
        below.max(above)
    }

    /// Half of what it adds to a bar.
    pub(super) fn half_length(self) -> f64 {
        let [below, above] = self.errors();
        0.5 * (below + above)
    }

    /// A finer scene was asked and gave no answer: whatever order coarser ones show counts for nothing.
    #[must_use]
    pub(super) fn unconfirmed(self) -> Estimate {
        Estimate {
            factor: WIDE,
            ..self
        }
    }

    /// The change that was seen may lie either way.
    #[must_use]
    pub(super) fn either_way(self) -> Estimate {
        let [below, above] = self.known;
        Estimate {
            known: [below.max(above); 2],
            ..self
        }
    }

    /// Too little to matter.
    pub(super) fn is_negligible(self, accuracy: f64) -> bool {
        self.error() <= NEGLIGIBLE * accuracy
    }

    /// An error of which nothing was seen for certain.
    pub(super) fn unseen(share: f64, factor: f64) -> Estimate {
        Estimate {
            known: [0.0; 2],
            share,
            factor,
        }
    }
}

/// A change `fine` of the scene's answer over a finer one's, downwards and upwards from the scene's.
fn seen(fine: f64) -> [f64; 2] {
    [fine.max(0.0), (-fine).max(0.0)]
}

fn is_formal(observed: f64, formal: f64) -> bool {
    observed > formal / HALF_ORDER && observed < formal * HALF_ORDER
}

/// These levels with some knobs a step coarser.
pub(super) fn coarser(levels: Levels, knobs: &[Knob]) -> Levels {
    let turn = |levels: Levels, &knob: &Knob| levels.turned(knob, -1);
    knobs.iter().fold(levels, turn)
}

/// These levels with some knobs a step finer.
pub(super) fn finer(levels: Levels, knobs: &[Knob]) -> Levels {
    let turn = |levels: Levels, &knob: &Knob| levels.turned(knob, 1);
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
    Estimate::unseen(change.abs() / (slowest(knobs) - 1.0), WIDE)
}

/// Error from two steps coarser: `near` is level -1 minus the scene, `far` level -2 minus level -1.
/// Without order the larger of what either says at the formal one.
pub(super) fn two_coarser(knobs: &[Knob], near: f64, far: f64) -> Estimate {
    let formal = slowest(knobs);
    let observed = far / near;
    if is_formal(observed, formal) {
        return Estimate::unseen(near.abs() / (observed.min(formal) - 1.0), NARROW);
    }
    let (one, two) = (near.abs(), (near + far).abs());
    let share = (one / (formal - 1.0)).max(two / (formal * formal - 1.0));
    Estimate::unseen(share, WIDE)
}

/// Error from a step coarser and a step finer: `near` is level -1 minus the scene, `fine` the scene
/// minus level +1. The latter is seen; what level +1 still lacks follows from the order. An order
/// above the formal one is not believed to last, and one below it leaves more than the formal one.
pub(super) fn with_finer(knobs: &[Knob], near: f64, fine: f64) -> Estimate {
    let formal = slowest(knobs);
    let observed = near / fine;
    let (share, factor) = if observed > formal / HALF_ORDER {
        (fine.abs() / (observed.min(formal) - 1.0), NARROW)
    } else {
        let left = fine.abs().max(near.abs() / formal) / (formal - 1.0);
        let slow = match observed > 1.0 {
            true => fine.abs() / (observed.max(SLOWEST) - 1.0),
            false => 0.0,
        };
        (left.max(slow * NARROW / WIDE), WIDE)
    };
    Estimate {
        known: seen(fine),
        share,
        factor,
    }
}

/// Error from a film held still: `fine` is the scene minus the film continued to infinitely many cells, and
/// what held films said of half the cells is `missed` off what half the cells answered. Films with errors e and
/// 2 e differ by e, so that as much may be missed of the error itself; [`CONTINUED`] of it at least.
pub(super) fn held(fine: f64, missed: f64) -> Estimate {
    Estimate {
        known: seen(fine),
        share: missed.abs() + CONTINUED * fine.abs(),
        factor: NARROW,
    }
}

/// Error from one step finer alone: what it moved is certain, and no order was observed.
pub(super) fn finer_alone(knobs: &[Knob], fine: f64) -> Estimate {
    Estimate {
        known: seen(fine),
        share: fine.abs() / (slowest(knobs) - 1.0),
        factor: WIDE,
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
