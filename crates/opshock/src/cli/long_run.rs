//! A command that runs for long: nothing new begins after a signal or at the end of its budget, and from time to time a line
//! says how far it is.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use anyhow::Context as _;
use opshock_study::sweep::stop::TICK;
use opshock_study::sweep::{StopFlag, Until};
use std::cell::Cell;
use std::time::{Duration, Instant};

/// Time between two lines of progress.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// A command that runs for long.
pub struct LongRun<'a> {
    /// When nothing new begins.
    pub until: Until,
    began: Instant,
    last_line: Cell<Instant>,
    console: &'a Console,
}

impl<'a> LongRun<'a> {
    /// Begins now, and listens to signals.
    pub fn begin(budget: Option<Duration>, console: &'a Console) -> Result<Self, Failure> {
        let stop = StopFlag::default();
        stop.listen().context("cannot listen to signals")?;
        let began = Instant::now();
        Ok(Self {
            until: Until::after(budget, stop),
            began,
            last_line: Cell::new(began),
            console,
        })
    }

    /// From now on says at once that a signal has been heard: what is at work may take seconds. A sweep does so by itself.
    pub fn acknowledge_signals(&self) {
        let (stop, console) = (self.until.stop.clone(), *self.console);
        std::thread::spawn(move || {
            while !stop.is_asked() {
                std::thread::sleep(TICK);
            }
            console.note(
                "stopping: simulations at work end first; a second signal (Ctrl-C) ends at once",
            );
        });
    }

    /// Whole seconds since it began.
    pub fn seconds(&self) -> u64 {
        self.began.elapsed().as_secs()
    }

    /// Prints a line, if the last one is some seconds ago.
    pub fn tell_progress(&self, words: impl FnOnce() -> String) {
        if self.last_line.get().elapsed() >= BETWEEN_LINES {
            self.last_line.set(Instant::now());
            self.console.note(&words());
        }
    }

    /// Says that it ended before its answer, and how to go on.
    pub fn ended_early(&self) -> Exit {
        self.console.note(
            "saved, without an answer, and nothing written into --out; run the same command again to go on",
        );
        self.stopped()
    }

    /// Exit code of a command that a signal or its budget ended.
    pub fn stopped(&self) -> Exit {
        let signal = self.until.stop.signal();
        let signal = signal.and_then(|number| u8::try_from(number).ok());
        signal.map_or(Exit::Budget, Exit::Signal)
    }
}
