//! The other parts of a sweep divided into shards, as one part sees them.

use super::shard::{self, Others, Shard};
use crate::search::order::Order;
use crate::store::Record;
use std::path::Path;
use std::time::{Duration, Instant};

/// Time between two readings of the other shards' stores.
const BETWEEN_LOOKS: Duration = Duration::from_millis(250);

/// The other parts of a divided sweep.
pub(super) struct Neighbours {
    others: Others,
    /// Shard that owns each point.
    owners: Vec<usize>,
    /// Points of this part.
    owned: Vec<bool>,
    /// Points whose answers this part needs.
    needed: Vec<bool>,
    asked_at: Option<Instant>,
}

impl Neighbours {
    /// Neighbours of a shard that owns the points `owned` and completes those `wanted`; not read yet. Where points decide
    /// which intervals are made, it needs the answers of all.
    pub(super) fn new(
        shard: &Shard,
        whole: &Path,
        order: &Order,
        owned: Vec<bool>,
        (wanted, decides): (&[bool], bool),
    ) -> Neighbours {
        Neighbours {
            others: Others::of(shard, whole),
            owners: shard.owners(order),
            needed: match decides {
                true => vec![true; wanted.len()],
                false => shard::needed(order, wanted),
            },
            owned,
            asked_at: None,
        }
    }

    /// Points that are left to this part, since their owners are not at work, and the results of others; `None` when
    /// they were read just now.
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
