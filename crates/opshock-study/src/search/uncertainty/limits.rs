//! Limits on how closely further contributions of an interval are evaluated, from what it contains already.

use super::contributions::Uncertainty;
use super::judge;
use super::walk::Walk;

/// Share of the interval so far to which brackets of further contributions are narrowed.
const GRAIN: f64 = 1.0 / 16.0;
/// The same where the interval exceeds the target whatever they contribute.
const COARSE_GRAIN: f64 = 1.0 / 8.0;

/// Narrowest bracket of changed scenes, grid steps.
const FINEST: i32 = 2;

/// How closely discretisation parameters are evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// Grid steps to which brackets are narrowed.
    pub(super) grain: i32,
    /// Error that needs no closer evaluation, a share.
    pub(super) little: f64,
    /// What may still be added before the interval exceeds the target, a share; negative beyond.
    pub(super) room: f64,
}

impl Limits {
    /// For an interval that has `sum` already, of which `spare` can be halved away.
    pub(super) fn of(walk: &Walk<'_>, sum: &Uncertainty, spare: f64) -> Limits {
        let (half, target) = (sum.half_length(), walk.input.target);
        let room = target - half + spare;
        let grain = if room > 0.0 { GRAIN } else { COARSE_GRAIN };
        Limits {
            grain: walk.nodes(grain * 2.0 * half).max(FINEST),
            little: judge::NEGLIGIBLE * target.max(half),
            room,
        }
    }

    /// A closer, expensive evaluation may bring the interval below the target.
    pub(super) fn is_worth(self, error: f64) -> bool {
        error > self.little && error > self.room && self.room > 0.0
    }
}
