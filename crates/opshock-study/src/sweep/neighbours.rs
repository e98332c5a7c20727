//! The other parts of a divided sweep, as one part sees them.

use super::shard::{self, Others, Shard};
use crate::search::order::Order;
use crate::store::Record;
use std::path::Path;
use std::time::{Duration, Instant};

/// How often a shard looks at the stores of the others.
const BETWEEN_LOOKS: Duration = Duration::from_millis(250);

/// The other parts of a divided sweep.
pub(super) struct Neighbours {
    others: Others,
    /// Shard that owns each point.
    owners: Vec<usize>,
    /// Points of this part.
    owned: Vec<bool>,
    /// Points whose answers this part cannot do without.
    needed: Vec<bool>,
    asked_at: Option<Instant>,
}

impl Neighbours {
    /// Neighbours of a shard that owns the points `owned` and completes those `wanted`; not asked yet.
    pub(super) fn new(
        shard: &Shard,
        whole: &Path,
        order: &Order,
        owned: Vec<bool>,
        wanted: &[bool],
    ) -> Neighbours {
        Neighbours {
            others: Others::of(shard, whole),
            owners: shard.owners(order),
            needed: shard::needed(order, wanted),
            owned,
            asked_at: None,
        }
    }

    /// Points that are left to this part, since those that own them are not at work, and what others have
    /// finished; `None` when they were asked just now.
    pub(super) fn ask(&mut self) -> Option<(Vec<bool>, Vec<Record>)> {
        let is_recent = |at: Instant| at.elapsed() < BETWEEN_LOOKS;
        if self.asked_at.is_some_and(is_recent) {
            return None;
        }
        self.asked_at = Some(Instant::now());
        let at_work = self.others.at_work();
        let is_left = |(point, &owner): (usize, &usize)| {
            self.owned[point] || self.needed[point] && !at_work[owner]
        };
        let allowed = self.owners.iter().enumerate().map(is_left).collect();
        Some((allowed, self.others.news()))
    }
}
