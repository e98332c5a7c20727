//! From differences between levels of a knob to the error of the scene as it is.

use opshock_solver::scene::knob::Knob;

use crate::search::lattice::Lattice;

/// Factor on an error whose order is the formal one.
pub(super) const NARROW: f64 = 1.25;
/// Factor on any other.
pub(super) const WIDE: f64 = 3.0;
/// Share of the accuracy asked below which a part is not looked at twice.
pub(super) const NEGLIGIBLE: f64 = 0.1;
/// An observed ratio counts as the formal one within half an order of refinement by two.
const HALF_ORDER: f64 = std::f64::consts::SQRT_2;

/// Error of the reported amplitude from one knob, as a share, and its factor of safety.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    pub share: f64,
    pub factor: f64,
}

fn is_formal(observed: f64, formal: f64) -> bool {
    observed > formal / HALF_ORDER && observed < formal * HALF_ORDER
}

/// Error from one step away: no order was observed.
pub(super) fn one_step(knob: Knob, first: f64) -> Estimate {
    let formal = knob.formal_ratio();
    let share = match step(knob) {
        1 => first.abs() * formal / (formal - 1.0),
        _ => first.abs() / (formal - 1.0),
    };
    Estimate {
        share,
        factor: WIDE,
    }
}

/// Error from two steps away: `first` is one step minus the scene, `second` two steps minus one.
pub(super) fn two_steps(knob: Knob, first: f64, second: f64) -> Estimate {
    match step(knob) {
        1 => two_finer(first, second, knob.formal_ratio()),
        _ => two_coarser(first, second, knob.formal_ratio()),
    }
}

/// Way in which a knob is turned: finer, or coarser where finer is dear.
pub(super) fn step(knob: Knob) -> i8 {
    match knob {
        Knob::FilmGrid | Knob::DiskModes | Knob::StructureStep => -1,
        Knob::SuspensionModes | Knob::HeadTolerance | Knob::CouplingTolerance => 1,
    }
}

/// Error from two steps finer: `first` is level 1 minus the scene, `second` level 2 minus level 1.
fn two_finer(first: f64, second: f64, formal: f64) -> Estimate {
    if is_formal(first / second, formal) {
        Estimate {
            share: first.abs() + second.abs() * formal / (formal - 1.0),
            factor: NARROW,
        }
    } else {
        Estimate {
            share: first.abs().max(second.abs()).max((first + second).abs()),
            factor: WIDE,
        }
    }
}

/// Error from two steps coarser: `near` is level -1 minus the scene, `far` level -2 minus level -1.
fn two_coarser(near: f64, far: f64, formal: f64) -> Estimate {
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
    } else {
        Estimate {
            share: near.abs().max(far.abs() / formal),
            factor: WIDE,
        }
    }
}

/// Bound from verdicts that agree with those of the reference at both ends of its bracket, one
/// node wide: nothing is observed, but nothing is larger either.
pub(super) fn agreement(lattice: &Lattice, knob: Knob) -> Estimate {
    Estimate {
        factor: 1.0,
        ..one_step(knob, lattice.step())
    }
}
