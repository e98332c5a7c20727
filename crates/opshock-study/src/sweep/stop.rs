//! Stopping a sweep: the first signal asks it to save and end, the second ends it at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Time between two looks for a request.
pub const TICK: Duration = Duration::from_millis(50);

/// Request to stop a sweep. Clones share the same request.
#[derive(Clone, Debug, Default)]
pub struct StopFlag {
    asked: Arc<AtomicBool>,
    signal: Arc<AtomicUsize>,
}

impl StopFlag {
    /// Requests the stop.
    pub fn ask(&self) {
        self.asked.store(true, Ordering::SeqCst);
    }

    /// A stop was requested.
    pub fn is_asked(&self) -> bool {
        self.asked.load(Ordering::SeqCst)
    }

    /// Signal that requested it, if one did.
    pub fn signal(&self) -> Option<i32> {
        match self.signal.load(Ordering::SeqCst) {
            0 => None,
            number => i32::try_from(number).ok(),
        }
    }

    /// Lets SIGINT, SIGTERM and SIGHUP request a stop; a second one ends the process at once with 128 + its number. A
    /// signal that the process was started to ignore (`nohup`) stays ignored.
    ///
    /// # Errors
    ///
    /// The system refused the handlers.
    pub fn listen(&self) -> std::io::Result<()> {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        let ignored = ignored_signals();
        for signal in [SIGINT, SIGTERM, SIGHUP] {
            if ignored >> (signal - 1) & 1 == 1 {
                continue;
            }
            // Order matters: the flag is still down when the first signal passes the first handler.
            signal_hook::flag::register_conditional_shutdown(
                signal,
                128 + signal,
                Arc::clone(&self.asked),
            )?;
            signal_hook::flag::register_usize(signal, Arc::clone(&self.signal), signal as usize)?;
            signal_hook::flag::register(signal, Arc::clone(&self.asked))?;
        }
        Ok(())
    }
}

/// When nothing new begins: after a request to stop, or when the time is over.
#[derive(Clone, Debug, Default)]
pub struct Until {
    /// The request.
    pub stop: StopFlag,
    /// When the time is over, if it ever is.
    pub end: Option<Instant>,
}

impl Until {
    /// From now on, for a time.
    pub fn after(budget: Option<Duration>, stop: StopFlag) -> Self {
        // A time beyond what the clock can represent is no bound.
        let end = budget.and_then(|budget| Instant::now().checked_add(budget));
        Self { stop, end }
    }

    /// Nothing new begins.
    pub fn is_over(&self) -> bool {
        self.stop.is_asked() || self.left().is_some_and(|left| left.is_zero())
    }

    /// Time left.
    pub fn left(&self) -> Option<Duration> {
        let left = |end: Instant| end.saturating_duration_since(Instant::now());
        self.end.map(left)
    }
}

/// Signals ignored by this process, bit 0 for number 1; none where the system does not report it.
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("SigIgn:"))
        .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .unwrap_or(0)
}
