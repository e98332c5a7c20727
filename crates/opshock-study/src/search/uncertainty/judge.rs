//! Error estimates from the differences between refinement levels of a discretisation parameter.
//!
//! Every parameter is coarsened by one step first: the runs are cheaper than those of the search. Where that changes
//! the answer noticeably, one step finer says more: coarse parameters, as those of a cheap scene, gain more by a step
//! than their formal order, so that coarser runs make a large error look small.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use crate::search::amplitude_grid::AmplitudeGrid;

/// Safety factor on an error whose order is the formal one.
pub(super) const FACTOR_FORMAL_ORDER: f64 = 1.25;
/// Factor on any other.
pub(super) const FACTOR_NO_ORDER: f64 = 3.0;
/// Share of the target below which a contribution is not evaluated more closely.
pub(super) const NEGLIGIBLE: f64 = 0.25;
/// An observed ratio is taken for the formal one within half an order of refinement by two.
const HALF_ORDER: f64 = std::f64::consts::SQRT_2;
/// Relative error of the estimate from quasi-static films: of the slope of the clearance, which is measured over some
/// per cent, and of the extrapolation of the grid.
const CONTINUED: f64 = 0.1;
/// Slowest ratio that is believed.
const SLOWEST: f64 = 1.25;

/// Error of the reported amplitude: the change observed and the remainder estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    /// Change of the answer on a finer scene, downwards and upwards, shares: certain, so without factor.
    pub known: [f64; 2],
    /// Error beyond that, either way, a share.
    pub share: f64,
    /// Safety factor on it.
    pub factor: f64,
}

impl Estimate {
    /// How far below and above the answer the truth may lie, with the safety factor.
    pub(super) fn errors(self) -> [f64; 2] {
        self.known.map(|known| known + self.share * self.factor)
    }

    /// The larger of the two.
    pub(super) fn error(self) -> f64 {
        let [below, above] = self.errors();
        below.max(above)
    }

    /// Half of what it adds to an interval.
    pub(super) fn half_length(self) -> f64 {
        let [below, above] = self.errors();
        0.5 * (below + above)
    }

    /// A finer scene was simulated and gave no answer: an order shown by coarser ones is disregarded.
    #[must_use]
    pub(super) fn unconfirmed(self) -> Estimate {
        Estimate {
            factor: FACTOR_NO_ORDER,
            ..self
        }
    }

    /// The change that was observed may lie either way.
    #[must_use]
    pub(super) fn either_way(self) -> Estimate {
        let [below, above] = self.known;
        Estimate {
            known: [below.max(above); 2],
            ..self
        }
    }

    /// Too little to matter.
    pub(super) fn is_negligible(self, target: f64) -> bool {
        self.error() <= NEGLIGIBLE * target
    }

    /// An error without any certain change.
    pub(super) fn unseen(share: f64, factor: f64) -> Estimate {
        Estimate {
            known: [0.0; 2],
            share,
            factor,
        }
    }
}

/// The change `fine` of the scene's answer relative to a finer one's, downwards and upwards from the scene's.
fn seen(fine: f64) -> [f64; 2] {
    [fine.max(0.0), (-fine).max(0.0)]
}

fn is_formal(observed: f64, formal: f64) -> bool {
    observed > formal / HALF_ORDER && observed < formal * HALF_ORDER
}

/// These levels with some discretisation parameters coarsened by one step.
pub(super) fn coarser(levels: Levels, discretisations: &[Discretisation]) -> Levels {
    let turn =
        |levels: Levels, &discretisation: &Discretisation| levels.changed(discretisation, -1);
    discretisations.iter().fold(levels, turn)
}

/// These levels with some discretisation parameters refined by one step.
pub(super) fn finer(levels: Levels, discretisations: &[Discretisation]) -> Levels {
    let turn = |levels: Levels, &discretisation: &Discretisation| levels.changed(discretisation, 1);
    discretisations.iter().fold(levels, turn)
}

/// Slowest formal ratio of some discretisation parameters.
fn slowest(discretisations: &[Discretisation]) -> f64 {
    let ratios = discretisations
        .iter()
        .map(|discretisation| discretisation.formal_ratio());
    ratios.fold(f64::INFINITY, f64::min)
}

/// Error of discretisation parameters changed together by one step, from the change of the answer. No order was
/// observed; the slowest formal one is used.
pub(super) fn one_step(discretisations: &[Discretisation], change: f64) -> Estimate {
    Estimate::unseen(
        change.abs() / (slowest(discretisations) - 1.0),
        FACTOR_NO_ORDER,
    )
}

/// Error from two steps coarser: `near` is level -1 minus the scene, `far` level -2 minus level -1. Without an order,
/// the larger of both estimates at the formal one.
pub(super) fn two_coarser(discretisations: &[Discretisation], near: f64, far: f64) -> Estimate {
    let formal = slowest(discretisations);
    let observed = far / near;
    if is_formal(observed, formal) {
        return Estimate::unseen(
            near.abs() / (observed.min(formal) - 1.0),
            FACTOR_FORMAL_ORDER,
        );
    }
    let (one, two) = (near.abs(), (near + far).abs());
    let share = (one / (formal - 1.0)).max(two / (formal * formal - 1.0));
    Estimate::unseen(share, FACTOR_NO_ORDER)
}

/// Error from a step coarser and a step finer: `near` is level -1 minus the scene, `fine` the scene minus level +1. The
/// latter is observed; what level +1 still lacks follows from the order. An order above the formal one is not assumed
/// to last, and one below it leaves more than the formal one.
pub(super) fn with_finer(discretisations: &[Discretisation], near: f64, fine: f64) -> Estimate {
    let formal = slowest(discretisations);
    let observed = near / fine;
    let (share, factor) = if observed > formal / HALF_ORDER {
        (
            fine.abs() / (observed.min(formal) - 1.0),
            FACTOR_FORMAL_ORDER,
        )
    } else {
        let left = fine.abs().max(near.abs() / formal) / (formal - 1.0);
        let slow = match observed > 1.0 {
            true => fine.abs() / (observed.max(SLOWEST) - 1.0),
            false => 0.0,
        };
        (
            left.max(slow * FACTOR_FORMAL_ORDER / FACTOR_NO_ORDER),
            FACTOR_NO_ORDER,
        )
    };
    Estimate {
        known: seen(fine),
        share,
        factor,
    }
}

/// Error from a quasi-static film: `fine` is the scene minus the film extrapolated to infinitely many cells, and
/// `missed` the error of the quasi-static prediction for half or a quarter of the cells. Films with errors e and 2 e
/// differ by e, so the error itself may be wrong by as much; [`CONTINUED`] of it is added.
pub(super) fn held(fine: f64, missed: f64) -> Estimate {
    Estimate {
        known: seen(fine),
        share: missed.abs() + CONTINUED * fine.abs(),
        factor: FACTOR_FORMAL_ORDER,
    }
}

/// Error from one step finer alone: the change is certain, and no order was observed.
pub(super) fn finer_alone(discretisations: &[Discretisation], fine: f64) -> Estimate {
    Estimate {
        known: seen(fine),
        share: fine.abs() / (slowest(discretisations) - 1.0),
        factor: FACTOR_NO_ORDER,
    }
}

/// Bound from verdicts that agree with the reference's at both ends of its bracket of `nodes` steps: the answer moved
/// by less. The factor [`FACTOR_FORMAL_ORDER`] covers parameters of a group whose effects on the answer cancel.
pub(super) fn agreement(
    grid: &AmplitudeGrid,
    nodes: i32,
    discretisations: &[Discretisation],
) -> Estimate {
    Estimate {
        factor: FACTOR_FORMAL_ORDER,
        ..one_step(discretisations, f64::from(nodes) * grid.step())
    }
}
