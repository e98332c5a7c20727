//! Writes the output of a command: results to stdout, messages to stderr.

use super::failure::Failure;
use anyhow::Context as _;
use serde::Serialize;
use std::io::Write as _;

/// Output of a command.
#[derive(Clone, Copy, Debug)]
pub struct Console {
    /// Results as JSON.
    pub json: bool,
    /// No messages but errors.
    pub quiet: bool,
}

impl Console {
    /// Prints a result.
    ///
    /// # Errors
    ///
    /// [`Failure::ClosedPipe`] when nobody reads any more.
    pub fn result(&self, text: &str) -> Result<(), Failure> {
        let mut out = std::io::stdout().lock();
        out.write_all(text.as_bytes())
            .and_then(|()| out.flush())
            .context("cannot write to standard output")?;
        Ok(())
    }

    /// Prints a result as indented JSON.
    ///
    /// # Errors
    ///
    /// As [`Console::result`].
    pub fn result_json(&self, value: &impl Serialize) -> Result<(), Failure> {
        let text =
            serde_json::to_string_pretty(value).context("cannot write the result as JSON")?;
        self.result(&(text + "\n"))
    }

    /// Prints a result as a line of JSON.
    ///
    /// # Errors
    ///
    /// As [`Console::result`].
    pub fn result_json_line(&self, value: &impl Serialize) -> Result<(), Failure> {
        let text = serde_json::to_string(value).context("cannot write the result as JSON")?;
        self.result(&(text + "\n"))
    }

    /// Prints a message on stderr, unless quiet.
    pub fn note(&self, text: &str) {
        if !self.quiet {
            // A message that nobody can read is no reason to stop.
            let _ = writeln!(std::io::stderr(), "{text}");
        }
    }

    /// Prints what stopped the command.
    pub fn fail(&self, failure: &Failure) {
        let text = if self.json {
            format!("{:#}\n", failure.json())
        } else {
            failure.text()
        };
        if !matches!(failure, Failure::ClosedPipe) {
            let _ = std::io::stderr().write_all(text.as_bytes());
        }
    }
}
