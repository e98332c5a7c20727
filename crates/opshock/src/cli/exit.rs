//! The program's exit codes, which scripts may rely on.

use std::process::ExitCode;

/// How the program ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Complete.
    Complete,
    /// A fault of the program or the machine.
    Internal,
    /// The command line is wrong.
    Usage,
    /// The study is not valid.
    Study,
    /// Complete, but some points are open: not bracketed or undecided.
    Open,
    /// Ended by a budget before it was complete.
    Budget,
    /// The store is damaged, locked, or of a newer format.
    Store,
    /// Differences or checks beyond their limits.
    Difference,
    /// What was required does not hold.
    Failed,
    /// Ended by a signal, by its number.
    Signal(u8),
}

impl Exit {
    /// The code.
    pub fn code(self) -> u8 {
        match self {
            Exit::Complete => 0,
            Exit::Internal => 1,
            Exit::Usage => 2,
            Exit::Study => 3,
            Exit::Open => 4,
            Exit::Budget => 5,
            Exit::Store => 6,
            Exit::Difference => 7,
            Exit::Failed => 8,
            Exit::Signal(number) => 128 + number,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit.code())
    }
}
