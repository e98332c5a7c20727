//! A fault of a study: what is wrong, where, and what would be valid.
//!
//! A message has a stable code, file, line and column, the key, the value found, what is allowed
//! and a hint. E... are errors, W... warnings (they stop batch runs unless accepted by code),
//! N... notes. It can be shown as one line, with the source around it, and as JSON.

use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;

use super::source::{Origin, Place, Source};

/// Most faults listed at once.
pub const MAX_LISTED: usize = 50;

/// How bad a fault is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The study cannot run.
    Error,
    /// Doubtful: a batch run needs it accepted by code.
    Warning,
    /// Worth knowing.
    Note,
}

/// One fault of a study.
#[derive(Clone, Debug)]
pub struct StudyError {
    /// Stable code.
    pub code: &'static str,
    /// File as named by the user, or `--set`.
    pub file: String,
    /// Line from 1; 0 when the fault belongs to the file as a whole.
    pub line: usize,
    /// Column from 1, in characters; 0 when unknown.
    pub column: usize,
    /// Dotted path of the key; empty when no key is at fault.
    pub key: String,
    /// Value found, as written.
    pub value: String,
    /// What is wrong.
    pub message: String,
    /// What would be valid.
    pub allowed: String,
    /// What to do.
    pub hint: String,
    /// Source and byte range, when there is one.
    place: Option<(Arc<Source>, Range<usize>)>,
    /// Order among sources: the study file, then its files, then the command line.
    rank: (Option<Origin>, usize),
}

impl StudyError {
    /// A fault of a whole file.
    pub fn in_file(code: &'static str, file: &str, message: impl Into<String>) -> Self {
        Self {
            code,
            file: file.to_string(),
            line: 0,
            column: 0,
            key: String::new(),
            value: String::new(),
            message: message.into(),
            allowed: String::new(),
            hint: String::new(),
            place: None,
            rank: (None, 0),
        }
    }

    /// A fault at a place of a text.
    pub fn at(code: &'static str, place: &Place, key: &str, message: impl Into<String>) -> Self {
        let (line, column) = place.source.line_column(place.span.start);
        Self {
            line,
            column,
            key: key.to_string(),
            place: Some((place.source.clone(), place.span.clone())),
            rank: (Some(place.origin), place.span.start),
            ..Self::in_file(code, &place.source.name, message)
        }
    }

    /// With the value found; long ones are cut.
    pub fn value(mut self, value: impl AsRef<str>) -> Self {
        let value = value.as_ref();
        self.value = if value.chars().count() > 80 {
            value.chars().take(77).chain("...".chars()).collect()
        } else {
            value.to_string()
        };
        self
    }

    /// With what would be valid.
    pub fn allowed(mut self, allowed: impl Into<String>) -> Self {
        self.allowed = allowed.into();
        self
    }

    /// With what to do.
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = hint.into();
        self
    }

    /// Severity, from the code.
    pub fn severity(&self) -> Severity {
        match self.code.as_bytes().first() {
            Some(b'W') => Severity::Warning,
            Some(b'N') => Severity::Note,
            _ => Severity::Error,
        }
    }

    /// Sorting key: by text, by place in it, by code.
    pub fn order(&self) -> (Option<Origin>, &str, usize, &'static str, &str) {
        (self.rank.0, &self.file, self.rank.1, self.code, &self.key)
    }

    /// JSON object `{code, file, line, column, key, value, allowed, hint, message}`.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({
            "code": self.code,
            "file": self.file,
            "line": self.line,
            "column": self.column,
            "key": self.key,
            "value": self.value,
            "allowed": self.allowed,
            "hint": self.hint,
            "message": self.message,
        })
    }
}

impl std::fmt::Display for StudyError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.file)?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
            if self.column > 0 {
                write!(f, ":{}", self.column)?;
            }
        }
        write!(f, ": {}", self.code)?;
        if !self.key.is_empty() {
            write!(f, " {}", self.key)?;
        }
        if !self.value.is_empty() {
            write!(f, " = {}", self.value.replace('\n', " "))?;
        }
        write!(f, ": {}", self.message)?;
        if !self.allowed.is_empty() {
            write!(f, "; allowed: {}", self.allowed)?;
        }
        if !self.hint.is_empty() {
            write!(f, "; hint: {}", self.hint)?;
        }
        Ok(())
    }
}

impl std::error::Error for StudyError {}

/// A fault of another program's file.
impl From<opshock_import::Fault> for StudyError {
    fn from(fault: opshock_import::Fault) -> Self {
        let mut error = Self::in_file(fault.code, &fault.file, fault.message)
            .value(&fault.value)
            .allowed(fault.allowed)
            .hint(fault.hint);
        (error.line, error.column) = (fault.line, fault.column);
        error.key = fault.what;
        error
    }
}

impl miette::Diagnostic for StudyError {
    fn code<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        Some(Box::new(self.code))
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.severity() {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
            Severity::Note => miette::Severity::Advice,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        let mut text = String::new();
        if !self.allowed.is_empty() {
            let _ = write!(text, "allowed: {}", self.allowed);
        }
        if !self.hint.is_empty() {
            let _ = write!(
                text,
                "{}{}",
                if text.is_empty() { "" } else { "\n" },
                self.hint
            );
        }
        (!text.is_empty()).then(|| Box::new(text) as _)
    }
}

/// A diagnostic together with its named source, as miette wants it for rendering.
#[derive(Debug)]
struct Shown<'a> {
    fault: &'a StudyError,
    source: Option<miette::NamedSource<String>>,
}

impl std::fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.fault.key.is_empty(), &self.source) {
            (_, None) => write!(f, "{}: {}", self.fault.file, self.fault.message),
            (true, Some(_)) => write!(f, "{}", self.fault.message),
            (false, Some(_)) => write!(f, "{}: {}", self.fault.key, self.fault.message),
        }
    }
}

impl std::error::Error for Shown<'_> {}

impl miette::Diagnostic for Shown<'_> {
    fn code<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        miette::Diagnostic::code(self.fault)
    }

    fn severity(&self) -> Option<miette::Severity> {
        miette::Diagnostic::severity(self.fault)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        miette::Diagnostic::help(self.fault)
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        self.source
            .as_ref()
            .map(|source| source as &dyn miette::SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = miette::LabeledSpan> + '_>> {
        let (_, span) = self.fault.place.as_ref()?;
        let label = miette::LabeledSpan::new_with_span(None, span.clone());
        Some(Box::new(std::iter::once(label)))
    }
}

/// Every fault found in a study, sorted by place.
#[derive(Clone, Debug)]
pub struct StudyErrors {
    /// The faults listed, at most [`MAX_LISTED`].
    pub errors: Vec<StudyError>,
    /// How many more were found. Once some thousand are known, no further combination of axes is checked.
    pub unlisted: usize,
}

impl StudyErrors {
    /// Sorts by place, removes repetitions, keeps the first [`MAX_LISTED`].
    pub fn new(mut errors: Vec<StudyError>) -> Self {
        tidy(&mut errors);
        let unlisted = errors.len().saturating_sub(MAX_LISTED);
        errors.truncate(MAX_LISTED);
        Self { errors, unlisted }
    }

    /// JSON `{"errors": [...]}`.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({
            "errors": self.errors.iter().map(StudyError::to_json).collect::<Vec<_>>(),
            "unlisted": self.unlisted,
        })
    }

    /// The faults with the text around them, for a terminal. `width` is in characters.
    pub fn to_terminal(&self, width: usize, colour: bool) -> String {
        let mut text = to_terminal(&self.errors, width, colour);
        if self.unlisted > 0 {
            let _ = writeln!(text, "and {} more", self.unlisted);
        }
        text
    }
}

/// Sorts by place and removes repetitions.
pub fn tidy(faults: &mut Vec<StudyError>) {
    faults.sort_by(|a, b| a.order().cmp(&b.order()));
    faults.dedup_by(|a, b| a.order() == b.order() && a.value == b.value && a.message == b.message);
}

/// Faults with the text around them, for a terminal. `width` is in characters.
pub fn to_terminal(faults: &[StudyError], width: usize, colour: bool) -> String {
    let theme = if colour {
        miette::GraphicalTheme::unicode()
    } else {
        miette::GraphicalTheme::unicode_nocolor()
    };
    let handler = miette::GraphicalReportHandler::new_themed(theme)
        .with_width(width.max(40))
        .with_links(false)
        .with_context_lines(1);
    let mut text = String::new();
    for fault in faults {
        let source = fault
            .place
            .as_ref()
            .map(|(source, _)| miette::NamedSource::new(&source.name, source.text.clone()));
        let shown = Shown { fault, source };
        if handler.render_report(&mut text, &shown).is_err() {
            let _ = writeln!(text, "{fault}");
        }
    }
    text
}

impl std::fmt::Display for StudyErrors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (position, error) in self.errors.iter().enumerate() {
            if position > 0 {
                f.write_str("\n")?;
            }
            write!(f, "{error}")?;
        }
        if self.unlisted > 0 {
            write!(f, "\nand {} more", self.unlisted)?;
        }
        Ok(())
    }
}

impl std::error::Error for StudyErrors {}

impl From<StudyError> for StudyErrors {
    fn from(error: StudyError) -> Self {
        Self::new(vec![error])
    }
}
