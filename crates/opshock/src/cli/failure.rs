//! The errors that stop a command, their messages and their exit codes.

use super::exit::Exit;
use super::terminal::{stderr_colour, stderr_width};
use opshock_study::report::ReportError;
use opshock_study::store::StoreError;
use opshock_study::study::{SetSyntaxError, StudyErrors};
use serde::Serialize;
use std::fmt::Write as _;

/// A command could not do what it was asked.
#[derive(Debug)]
pub enum Failure {
    /// The command line is wrong.
    Usage(Vec<Fault>),
    /// The study is not valid.
    Study(StudyErrors),
    /// The store cannot be used.
    Store(StoreError),
    /// The machine refused: a file, a thread.
    Internal(anyhow::Error),
    /// The reader of the output went away: no message can be printed.
    ClosedPipe,
}

/// One fault as `--json` prints it; what does not exist is `null`.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Fault {
    /// Stable code.
    pub code: String,
    /// File.
    pub file: Option<String>,
    /// Line from 1.
    pub line: Option<usize>,
    /// Key or option.
    pub key: Option<String>,
    /// Value found.
    pub value: Option<String>,
    /// What would be valid.
    pub allowed: Option<String>,
    /// What to do.
    pub hint: Option<String>,
    /// A sentence.
    pub message: String,
}

impl Fault {
    /// A fault with its sentence.
    pub fn new(code: &str, message: impl Into<String>) -> Self {
        Self {
            code: code.into(),
            message: message.into(),
            ..Self::default()
        }
    }
}

impl Failure {
    /// Exit code.
    pub fn exit(&self) -> Exit {
        match self {
            Failure::Usage(_) => Exit::Usage,
            Failure::Study(_) => Exit::Study,
            Failure::Store(_) => Exit::Store,
            Failure::Internal(_) => Exit::Internal,
            Failure::ClosedPipe => Exit::Complete,
        }
    }

    /// Text for a person, with its line ends.
    pub fn text(&self) -> String {
        match self {
            Failure::Usage(faults) => {
                let mut text = String::new();
                for fault in faults {
                    let _ = writeln!(text, "error: {}", fault.message);
                    if let Some(allowed) = &fault.allowed {
                        let _ = writeln!(text, "  allowed: {allowed}");
                    }
                    if let Some(hint) = &fault.hint {
                        let _ = writeln!(text, "  {hint}");
                    }
                }
                text
            }
            // With the lines of the study on a terminal, one line each for what reads on.
            Failure::Study(errors) => match stderr_width() {
                Some(width) => errors.to_terminal(width, stderr_colour()),
                None => format!("{errors}\n"),
            },
            Failure::Store(error) => with_causes(error),
            Failure::Internal(error) => with_causes(error.as_ref()),
            Failure::ClosedPipe => String::new(),
        }
    }

    /// `{"errors": [...]}`.
    pub fn json(&self) -> serde_json::Value {
        let errors = match self {
            Failure::Usage(faults) => faults.clone(),
            Failure::Study(errors) => return errors.to_json(),
            Failure::Store(error) => vec![Fault::new(error.code(), one_line(error))],
            Failure::Internal(error) => vec![Fault::new("internal", format!("{error:#}"))],
            Failure::ClosedPipe => Vec::new(),
        };
        serde_json::json!({ "errors": errors })
    }
}

fn with_causes(error: &(dyn std::error::Error + 'static)) -> String {
    let mut text = format!("error: {error}\n");
    let mut cause = error.source();
    while let Some(reason) = cause {
        let _ = writeln!(text, "  because: {reason}");
        cause = reason.source();
    }
    text
}

fn one_line(error: &(dyn std::error::Error + 'static)) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(reason) = cause {
        let _ = write!(text, ": {reason}");
        cause = reason.source();
    }
    text
}

impl From<StudyErrors> for Failure {
    fn from(errors: StudyErrors) -> Self {
        Failure::Study(errors)
    }
}

impl From<StoreError> for Failure {
    fn from(error: StoreError) -> Self {
        Failure::Store(error)
    }
}

impl From<ReportError> for Failure {
    fn from(error: ReportError) -> Self {
        match error {
            ReportError::Write(error) => Failure::Store(error),
            ReportError::Chart(_) => Failure::Internal(error.into()),
        }
    }
}

impl From<SetSyntaxError> for Failure {
    fn from(error: SetSyntaxError) -> Self {
        Failure::Usage(vec![Fault {
            key: Some(error.option.into()),
            value: Some(error.argument.clone()),
            allowed: Some(error.form.into()),
            ..Fault::new("usage", error.to_string())
        }])
    }
}

impl From<anyhow::Error> for Failure {
    fn from(error: anyhow::Error) -> Self {
        let closed = error
            .chain()
            .filter_map(|cause| cause.downcast_ref::<std::io::Error>())
            .any(|cause| cause.kind() == std::io::ErrorKind::BrokenPipe);
        if closed {
            Failure::ClosedPipe
        } else {
            Failure::Internal(error)
        }
    }
}
