//! Progress reports of a running sweep. Everything reported as done is on the disk already.

mod bars;
mod event;
mod lines;
mod text;

use std::io::{IsTerminal, Write as _};

pub use bars::Bars;
pub use event::{Estimate, Event, PointLabel, Progress};
pub use lines::Lines;

/// Reports nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn event(&self, _event: &Event) {}
}

/// Prints warnings on standard error, nothing else.
#[derive(Clone, Copy, Debug, Default)]
pub struct WarningsAlone;

impl Progress for WarningsAlone {
    fn event(&self, event: &Event) {
        if let Event::Warning { code, message } = event {
            // A closed standard error is no reason to stop.
            let _ = writeln!(std::io::stderr(), "warning {code}: {message}");
        }
    }
}

/// How a sweep reports its progress on standard error.
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
    /// The progress of this kind; prints at once what begins, before anything is read or computed.
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
