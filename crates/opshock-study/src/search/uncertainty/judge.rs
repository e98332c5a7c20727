//! Error estimates from the differences between refinement levels of a discretisation parameter.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::change::Change;

/// Safety factor on an error whose order is the formal one, and on a bound by equal brackets.
pub(super) const FACTOR_FORMAL_ORDER: f64 = 1.25;
/// Factor on any other.
pub(super) const FACTOR_NO_ORDER: f64 = 3.0;
/// Share of the target below which a contribution is not evaluated more closely.
pub(super) const NEGLIGIBLE: f64 = 0.25;
/// An observed ratio is taken for the formal one, or a larger one, down to half an order of refinement by two.
const HALF_ORDER: f64 = std::f64::consts::SQRT_2;
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

    /// A finer scene was simulated and gave no answer: an order shown by coarser ones is disregarded.
    #[must_use]
    pub(super) fn unconfirmed(self) -> Estimate {
        Estimate {
            factor: FACTOR_NO_ORDER,
            ..self
        }
    }

    /// An error without any certain change.
    fn unseen(share: f64, factor: f64) -> Estimate {
        Estimate {
            known: [0.0; 2],
            share,
            factor,
        }
    }
}

/// These levels with some discretisation parameters refined by so many steps each.
pub(super) fn refined(levels: Levels, discretisations: &[Discretisation], steps: i8) -> Levels {
    let turn =
        |levels: Levels, &discretisation: &Discretisation| levels.changed(discretisation, steps);
    discretisations.iter().fold(levels, turn)
}

/// Slowest formal ratio of some discretisation parameters.
fn slowest(discretisations: &[Discretisation]) -> f64 {
    let ratios = discretisations
        .iter()
        .map(|discretisation| discretisation.formal_ratio());
    ratios.fold(f64::INFINITY, f64::min)
}

/// Error of discretisation parameters changed together, from the change of the answer one step coarser. No order was
/// observed; the slowest formal one is used. Equal brackets bound the change; their factor covers parameters of a group
/// whose effects on the answer cancel.
pub(super) fn one_step(discretisations: &[Discretisation], near: Change) -> Estimate {
    let factor = match near.is_equal {
        true => FACTOR_FORMAL_ORDER,
        false => FACTOR_NO_ORDER,
    };
    Estimate::unseen(near.size() / (slowest(discretisations) - 1.0), factor)
}

/// Error from two steps coarser: `near` and `far` are the changes one and two steps coarser. The larger of both estimates at
/// the formal order, that of `near` at a slower one observed.
pub(super) fn two_coarser(
    discretisations: &[Discretisation],
    near: Change,
    far: Change,
) -> Estimate {
    let formal = slowest(discretisations);
    let observed = (far.share - near.share) / near.share;
    let two = far.size() / (formal * formal - 1.0);
    if !near.is_equal && observed > formal / HALF_ORDER {
        let one = near.size() / (observed.min(formal) - 1.0);
        return Estimate::unseen(one.max(two), FACTOR_FORMAL_ORDER);
    }
    let one = one_step(discretisations, near);
    Estimate {
        share: one.share.max(two),
        ..one
    }
}

/// Error from the finest answer, which lies `finest` from the scene's and `finer` from that a step coarser, and where it has
/// an answer from the one before that, `near` from the latter. What the finest one changes is observed, up to the
/// brackets it was observed with; what it still lacks follows from the order. An order above the formal one is not assumed
/// to last, and one below it leaves more than the formal one.
pub(super) fn with_finer(
    discretisations: &[Discretisation],
    near: Option<Change>,
    finer: Change,
    finest: Change,
) -> Estimate {
    let formal = slowest(discretisations);
    let size = finer.size();
    let known = match finest.is_equal {
        true => [finest.size(); 2],
        false => [-finest.share, finest.share].map(|share| match share > 0.0 {
            true => finest.size(),
            false => 0.0,
        }),
    };
    let (share, factor) = match near.map(|near| (near.size(), -near.share / finer.share)) {
        None => (size / (formal - 1.0), FACTOR_NO_ORDER),
        Some((_, observed)) if finer.is_equal || observed > formal / HALF_ORDER => {
            let observed = if finer.is_equal { formal } else { observed };
            (size / (observed.min(formal) - 1.0), FACTOR_FORMAL_ORDER)
        }
        Some((near, observed)) => {
            let left = size.max(near / formal) / (formal - 1.0);
            let slow = match observed > 1.0 {
                true => size / (observed.max(SLOWEST) - 1.0),
                false => 0.0,
            };
            let share = left.max(slow * FACTOR_FORMAL_ORDER / FACTOR_NO_ORDER);
            (share, FACTOR_NO_ORDER)
        }
    };
    Estimate {
        known,
        share,
        factor,
    }
}
