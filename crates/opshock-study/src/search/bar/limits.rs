//! How closely further parts of a bar are looked at.

use super::judge;
use super::parts::Bar;
use super::walk::Walk;

/// Part of what a bar holds already to which brackets of further parts are narrowed.
const GRAIN: f64 = 1.0 / 16.0;
/// The same where the bar exceeds what was asked whatever they say.
const COARSE_GRAIN: f64 = 1.0 / 8.0;

/// Narrowest bracket of turned knobs, nodes.
const FINEST: i32 = 2;

/// How closely knobs are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// Nodes to which brackets are narrowed.
    pub(super) grain: i32,
    /// Error that needs no closer look, a share.
    pub(super) little: f64,
    /// What may still be added before the bar exceeds what was asked, a share; negative beyond.
    pub(super) room: f64,
}

impl Limits {
    /// For a bar that holds `sum` already, of which `spare` can be halved away.
    pub(super) fn of(walk: &Walk<'_>, sum: &Bar, spare: f64) -> Limits {
        let (half, accuracy) = (sum.half_length(), walk.input.accuracy);
        let room = accuracy - half + spare;
        let grain = if room > 0.0 { GRAIN } else { COARSE_GRAIN };
        Limits {
            grain: walk.nodes(grain * 2.0 * half).max(FINEST),
            little: judge::NEGLIGIBLE * accuracy.max(half),
            room,
        }
    }

    /// A closer look that is dear may bring the bar below what was asked.
    pub(super) fn is_worth(self, error: f64) -> bool {
        error > self.little && error > self.room && self.room > 0.0
    }
}
