//! Cache of structural histories that several sliders or altitudes of one drive share.
//!
//! The motion of disk and ramp does not depend on the head. Points that differ in the head alone request the same
//! structural run at the same amplitude; the first request runs it. A run is a function of its key, so that sharing,
//! eviction and the order of threads change no number.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use opshock_solver::structure::{StructureError, StructureRun};

/// Digest of the structure's content and the bits of the signed amplitude, m/s².
pub(super) type Key = ([u8; 16], u64);

type Shared = Arc<OnceLock<Result<StructureRun, StructureError>>>;

/// Time steps kept at most: 48 bytes each, 96 MB in all.
const MOST_STEPS: usize = 2_000_000;

/// The histories kept; the least recently used are dropped first.
#[derive(Default)]
pub(super) struct StructureRunCache {
    inner: Mutex<Inner>,
}

#[derive(Default)]
struct Inner {
    places: HashMap<Key, Place>,
    steps: usize,
    clock: u64,
    counts: Counts,
}

struct Place {
    run: Shared,
    steps: usize,
    used: u64,
}

/// Requests to the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Structural runs requested.
    pub asked: u64,
    /// Answered by an earlier run.
    pub shared: u64,
}

impl StructureRunCache {
    /// The run of `key`, by `run` when it is not in the cache; `steps` is its length in time steps.
    pub fn get_or_run(
        &self,
        key: Key,
        steps: usize,
        run: impl FnOnce() -> Result<StructureRun, StructureError>,
    ) -> Shared {
        let shared = self.place(key, steps);
        // Outside the lock: others wait for this run only.
        shared.get_or_init(run);
        shared
    }

    /// Requests so far.
    pub fn counts(&self) -> Counts {
        self.lock().counts
    }

    fn place(&self, key: Key, steps: usize) -> Shared {
        let mut inner = self.lock();
        inner.clock += 1;
        inner.counts.asked += 1;
        let now = inner.clock;
        if let Some(place) = inner.places.get_mut(&key) {
            place.used = now;
            let run = Arc::clone(&place.run);
            inner.counts.shared += 1;
            return run;
        }
        while inner.steps + steps > MOST_STEPS && !inner.places.is_empty() {
            inner.forget_oldest();
        }
        let run = Shared::default();
        let place = Place {
            run: Arc::clone(&run),
            steps,
            used: now,
        };
        inner.steps += steps;
        inner.places.insert(key, place);
        run
    }

    /// A panic of another thread leaves the totals consistent.
    fn lock(&self) -> std::sync::MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inner {
    fn forget_oldest(&mut self) {
        let oldest = self.places.iter().min_by_key(|(_, place)| place.used);
        if let Some(key) = oldest.map(|(key, _)| *key)
            && let Some(place) = self.places.remove(&key)
        {
            self.steps -= place.steps;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failed(time_s: f64) -> Result<StructureRun, StructureError> {
        Err(StructureError::NotFinite { time_s })
    }

    #[test]
    fn a_run_is_made_once_and_the_cache_stays_bounded() {
        let cache = StructureRunCache::default();
        let key = |i: u8| ([i; 16], 1);
        let steps = MOST_STEPS / 2;
        cache.get_or_run(key(0), steps, || failed(0.0));
        cache.get_or_run(key(1), steps, || failed(1.0));
        let again = cache.get_or_run(key(0), steps, || failed(9.0));
        assert_eq!(again.get(), Some(&failed(0.0)));
        // The third evicts the second, the least recently used.
        cache.get_or_run(key(2), steps, || failed(2.0));
        assert_eq!(cache.lock().steps, MOST_STEPS);
        let kept = cache.get_or_run(key(0), steps, || failed(9.0));
        assert_eq!(kept.get(), Some(&failed(0.0)));
        let gone = cache.get_or_run(key(1), steps, || failed(8.0));
        assert_eq!(gone.get(), Some(&failed(8.0)));
        let counts = Counts {
            asked: 6,
            shared: 2,
        };
        assert_eq!(cache.counts(), counts);
        // A history longer than the cache is run and shared while it is in use.
        cache.get_or_run(key(3), 3 * MOST_STEPS, || failed(3.0));
        assert_eq!(cache.lock().places.len(), 1);
    }
}
