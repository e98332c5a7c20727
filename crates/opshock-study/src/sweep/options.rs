//! Options of a sweep, and the reason why it ended.

use super::shard::Shard;
use super::stop::StopFlag;
use crate::store::summary::Summary;
use std::path::PathBuf;
use std::time::Duration;

/// Options of a sweep; none of them changes the answer.
#[derive(Clone, Debug)]
pub struct SweepOptions {
    /// Worker threads.
    pub threads: usize,
    /// Request to stop.
    pub stop: StopFlag,
    /// Time after which the sweep saves and ends.
    pub budget: Option<Duration>,
    /// Simulate undecided runs again.
    pub retry_undecided: bool,
    /// Let idle threads compute probes that will probably be requested.
    pub speculate: bool,
    /// Stores, of any study, whose finished simulations answer what they can.
    pub reuse: Vec<PathBuf>,
    /// Complete one part of the points, into a store of its own within the store.
    pub shard: Option<Shard>,
}

impl SweepOptions {
    /// Options for a number of threads.
    pub fn with_threads(threads: usize) -> SweepOptions {
        SweepOptions {
            threads: threads.max(1),
            stop: StopFlag::default(),
            budget: None,
            retry_undecided: false,
            speculate: true,
            reuse: Vec::new(),
            shard: None,
        }
    }
}

/// Why a sweep ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Every point has its answer.
    Complete,
    /// A stop was requested, by this signal if it was one.
    Stopped {
        /// Signal number.
        signal: Option<i32>,
    },
    /// The budget was used up.
    Budget,
}

/// Result of a sweep.
#[derive(Clone, Debug)]
pub struct SweepEnd {
    /// The table.
    pub summary: Summary,
    /// Why it ended.
    pub ending: Ending,
    /// Simulations computed by this process.
    pub computed_runs: u64,
    /// Simulations taken from other stores.
    pub reused_runs: u64,
    /// Measured time, s.
    pub wall_s: f64,
    /// Share of the threads' time spent simulating.
    pub core_use: f64,
}
