//! Events that a sweep reports, and the trait of their receiver.

use std::path::PathBuf;

use crate::search::Sign;
use crate::store::summary::{PointSummary, Totals};
use crate::sweep::options::Ending;
use crate::sweep::spread::Spread;

/// Name of a point, as messages show it.
#[derive(Clone, Debug, PartialEq)]
pub struct PointLabel {
    /// Name of the ramp model.
    pub ramp: String,
    /// Pulse width, ms.
    pub pulse_ms: f64,
    /// Sign.
    pub sign: Sign,
    /// Further axes as `name=value`.
    pub axes: Vec<String>,
}

impl std::fmt::Display for PointLabel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} {} ms {}",
            self.ramp,
            self.pulse_ms,
            self.sign.as_str()
        )?;
        for axis in &self.axes {
            write!(f, " {axis}")?;
        }
        Ok(())
    }
}

/// What is left, with its range.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Points whose bracket is known.
    pub bracketed: u64,
    /// Points whose answer is known.
    pub answered: u64,
    /// Simulations finished, stored ones included.
    pub runs_done: u64,
    /// Simulations left.
    pub runs_left: Spread,
    /// Seconds of all simulations left, one after another; `None` until two runs of a ramp model were measured.
    pub core_s: Option<Spread>,
    /// Seconds left with the threads of the sweep; `None` until then. Both ranges are narrowed to a factor 1.98 of the total.
    pub left_s: Option<Spread>,
}

/// One thing that happened.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A stop was requested, or the time is over: simulations at work end first.
    Stopping {
        /// Simulations at work.
        in_flight: usize,
        /// What stops the sweep.
        ending: Ending,
    },
    /// The sweep begins.
    Started {
        /// Name of the study.
        study: String,
        /// Points of the study, in its order.
        points: Vec<PointLabel>,
        /// Worker threads.
        threads: usize,
        /// Simulations found in the store.
        stored_runs: u64,
    },
    /// A point requests its first probe.
    PointStarted {
        /// Place in the study.
        point: usize,
    },
    /// A simulation finished (or was found in the store).
    ProbeDone {
        /// Place in the study.
        point: usize,
        /// Amplitude, G, without sign.
        amplitude_g: f64,
        /// `survives`, `fails`, `undecided`.
        verdict: &'static str,
        /// `bracketing`, `bisect`, `scan`, `follow_up`, `window`, `uncertainty`.
        purpose: &'static str,
        /// Label of the retry, empty for a plain run.
        retry: &'static str,
        /// Measured time, s; `None` when it came from the store.
        wall_s: Option<f64>,
    },
    /// Evidence of a point now.
    Bracket {
        /// Place in the study.
        point: usize,
        /// Highest survivor below the lowest failure, G.
        survived_g: Option<f64>,
        /// Lowest failure, G.
        failed_g: Option<f64>,
        /// Canonical simulations so far.
        runs: u64,
    },
    /// A point has its answer.
    PointDone {
        /// Place in the study.
        point: usize,
        /// Its row.
        summary: PointSummary,
        /// The store had it before the sweep began.
        is_stored: bool,
    },
    /// What is left.
    Estimated(Estimate),
    /// `results.h5` was replaced.
    Checkpoint {
        /// The file.
        path: PathBuf,
        /// Canonical simulations in it.
        runs: u64,
    },
    /// A message for the user.
    Warning {
        /// Stable word, such as `lucky`.
        code: &'static str,
        /// A sentence.
        message: String,
    },
    /// The sweep ended.
    Finished {
        /// Totals.
        totals: Totals,
        /// Points that lack their uncertainty alone.
        bracketed: u64,
        /// Measured time, s.
        wall_s: f64,
        /// Share of the threads' time spent simulating.
        core_use: f64,
    },
}

/// Receives events, in order, from one thread.
pub trait Progress: Send + Sync {
    /// Takes an event.
    fn event(&self, event: &Event);
}
