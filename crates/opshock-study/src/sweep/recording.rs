//! Records the histories that a sweep keeps, on all its threads, and acknowledges a stop meanwhile.

use std::path::Path;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Instant;

use crossbeam_channel::RecvTimeoutError;

use super::guard;
use super::histories::{self, Wanted};
use super::input::SweepInput;
use super::options::Ending;
use super::progress::Event;
use super::registry::Registry;
use super::simulator::Simulator;
use super::stop::TICK;
use crate::store::StoreError;

/// What recording came to.
#[derive(Debug, Default)]
pub(super) struct Recorded {
    /// A sentence about each file that was damaged, and each run that failed.
    pub(super) warnings: Vec<String>,
    /// Why it did not finish.
    pub(super) stopped: Option<Ending>,
    /// Seconds of all runs.
    pub(super) busy_s: f64,
}

/// Where a sweep records its histories.
pub(super) struct Recording<'a> {
    pub(super) input: &'a SweepInput,
    pub(super) simulator: &'a dyn Simulator,
    pub(super) pool: &'a rayon::ThreadPool,
    pub(super) folder: &'a Path,
    /// Why nothing new may begin.
    pub(super) stopped: &'a (dyn Fn() -> Option<Ending> + Sync),
    /// Takes the acknowledgement.
    pub(super) report: &'a (dyn Fn(Event) + Sync),
}

impl Recording<'_> {
    /// Repeats kept runs with recording.
    ///
    /// # Errors
    ///
    /// E183: a history cannot be written.
    pub(super) fn of_final_points(&self, registry: &Registry<'_>) -> Result<Recorded, StoreError> {
        let wanted = histories::wanted(self.input, registry);
        let (busy_ms, at_work) = (AtomicU64::new(0), AtomicUsize::new(0));
        // Warnings; the reason where a run was omitted.
        let record = |one: &Wanted| {
            let kept = one.is_kept(self.input, self.folder);
            if kept == Ok(true) {
                return Ok(Ok(None));
            }
            if let Some(ending) = (self.stopped)() {
                return Ok(Err(ending));
            }
            let began = Instant::now();
            at_work.fetch_add(1, Ordering::Relaxed);
            let panicked = guard::record(self.input, self.simulator, one, self.folder);
            at_work.fetch_sub(1, Ordering::Relaxed);
            busy_ms.fetch_add(began.elapsed().as_millis() as u64, Ordering::Relaxed);
            Ok(Ok(panicked?.or(kept.err())))
        };
        let (over, is_over) = crossbeam_channel::bounded::<()>(0);
        let all = std::thread::scope(|scope| {
            scope.spawn(|| {
                while is_over.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                    if let Some(ending) = (self.stopped)() {
                        let in_flight = at_work.load(Ordering::Relaxed);
                        return (self.report)(Event::Stopping { in_flight, ending });
                    }
                }
            });
            let all = self.pool.install(|| {
                use rayon::prelude::*;
                let all = wanted.par_iter().map(record);
                all.collect::<Result<Vec<_>, StoreError>>()
            });
            drop(over);
            all
        })?;
        let mut recorded = Recorded {
            busy_s: busy_ms.into_inner() as f64 * 1e-3,
            ..Recorded::default()
        };
        for one in all {
            match one {
                Ok(warning) => recorded.warnings.extend(warning),
                Err(ending) => recorded.stopped = Some(ending),
            }
        }
        Ok(recorded)
    }
}
