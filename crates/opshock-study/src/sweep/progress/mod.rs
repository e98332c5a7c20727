//! What a sweep tells while it runs. Everything reported as done is on the disk already.

mod bars;
mod lines;

use std::io::{IsTerminal, Write as _};
use std::path::PathBuf;

use crate::search::Sign;
use crate::store::summary::{PointSummary, Totals};

pub use bars::Bars;
pub use lines::Lines;

/// Name of a point for people.
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

/// What is left, from the expected remaining probes of each run class.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Simulations finished, stored ones included.
    pub runs_done: u64,
    /// Simulations expected to remain.
    pub runs_left: f64,
    /// Standard deviation of that number.
    pub runs_left_sd: f64,
    /// Time left at the measured pace, s; `None` until a run was measured.
    pub eta_s: Option<f64>,
}

/// One thing that happened.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
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
    /// A point asks for its first probe.
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
        /// `hunt`, `bisect`, `scan`, `follow_up`, `window`.
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
        a_crit_g: Option<f64>,
        /// Lowest failure, G.
        a_fail_g: Option<f64>,
        /// Canonical simulations so far.
        runs: u64,
    },
    /// A point has its answer.
    PointDone {
        /// Place in the study.
        point: usize,
        /// Its row.
        summary: PointSummary,
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
    /// Something a person should know.
    Warning {
        /// Stable word, such as `lucky`.
        code: &'static str,
        /// A sentence.
        message: String,
    },
    /// The sweep ended.
    Finished {
        /// Counts.
        totals: Totals,
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

/// Says nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn event(&self, _event: &Event) {}
}

/// Tells warnings on standard error, nothing else.
#[derive(Clone, Copy, Debug, Default)]
pub struct WarningsAlone;

impl Progress for WarningsAlone {
    fn event(&self, event: &Event) {
        if let Event::Warning { code, message } = event {
            // Nobody to tell is no reason to stop.
            let _ = writeln!(std::io::stderr(), "warning {code}: {message}");
        }
    }
}

/// How a sweep tells of its progress on standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProgressKind {
    /// A live table on a terminal, else lines.
    #[default]
    Auto,
    /// A live table of brackets.
    Bar,
    /// A line per answered point, and one every ten seconds.
    Lines,
    /// Warnings alone.
    Warnings,
    /// Nothing.
    None,
}

impl ProgressKind {
    /// The progress of this kind; says at once what begins, before anything is read or computed.
    pub fn start(self, study: &str) -> Box<dyn Progress> {
        match self {
            ProgressKind::None => Box::new(Silent),
            ProgressKind::Warnings => Box::new(WarningsAlone),
            ProgressKind::Lines => Box::new(Lines::start(std::io::stderr(), study)),
            ProgressKind::Bar => Box::new(Bars::start(study)),
            ProgressKind::Auto if std::io::stderr().is_terminal() => Box::new(Bars::start(study)),
            ProgressKind::Auto => Box::new(Lines::start(std::io::stderr(), study)),
        }
    }
}

/// `331.2 to 334.5 G`, `above 2000 G`, `below 20 G`.
fn answer(summary: &PointSummary) -> String {
    bracket(summary.a_crit_g, summary.a_fail_g)
}

fn bracket(a_crit_g: Option<f64>, a_fail_g: Option<f64>) -> String {
    match (a_crit_g, a_fail_g) {
        (Some(low), Some(high)) => format!("{} to {} G", short(low), short(high)),
        (Some(low), None) => format!("above {} G", short(low)),
        (None, Some(high)) => format!("below {} G", short(high)),
        (None, None) => "no verdict".into(),
    }
}

/// Four figures.
fn short(value: f64) -> String {
    let digits = 3 - value.abs().max(1.0).log10().floor() as i32;
    format!("{value:.*}", digits.max(0) as usize)
}

/// What is left, in words.
fn left(estimate: &Estimate) -> String {
    let runs = format!(
        "{} runs done, {:.0} \u{b1} {:.0} left",
        estimate.runs_done, estimate.runs_left, estimate.runs_left_sd
    );
    match estimate.eta_s {
        Some(eta_s) if estimate.runs_left > 0.0 => format!("{runs}, about {}", duration(eta_s)),
        _ => runs,
    }
}

fn duration(seconds: f64) -> String {
    let whole = seconds.ceil().max(1.0) as u64;
    match whole {
        0..90 => format!("{whole} s"),
        90..5400 => format!("{} min", (whole + 30) / 60),
        _ => format!("{} h {:02} min", whole / 3600, whole / 60 % 60),
    }
}

/// Last line.
fn finished(totals: &Totals, wall_s: f64, core_use: f64) -> String {
    let mut parts = Vec::new();
    for (count, word) in [
        (totals.ok, "bracketed"),
        (totals.above_range, "above the range"),
        (totals.below_range, "below the range"),
        (totals.undecided, "undecided"),
        (totals.open, "open"),
    ] {
        if count > 0 {
            parts.push(format!("{count} {word}"));
        }
    }
    format!(
        "{} points: {}; {} runs, {} without verdict; {}, cores {:.0} % busy",
        totals.points,
        parts.join(", "),
        totals.runs,
        totals.undecided_runs,
        duration(wall_s),
        100.0 * core_use
    )
}
