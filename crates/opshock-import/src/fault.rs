//! Faults of an imported file, each with its place and code.

use std::fmt;

/// Most faults listed for one file; a damaged matrix would fill the screen.
pub const MAX_LISTED: usize = 50;

/// A fault with its place.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fault {
    /// Stable code: E160 to E179; W208, W206 for a warning, N207 for a note.
    pub code: &'static str,
    /// File as named by the user.
    pub file: String,
    /// Line from 1; 0 when the fault belongs to the file as a whole.
    pub line: usize,
    /// Column from 1, in characters; 0 when unknown.
    pub column: usize,
    /// What the value is: a row and column, a freedom, a name of the format; empty if nothing.
    pub what: String,
    /// Value found, as written.
    pub value: String,
    /// Valid values.
    pub allowed: String,
    /// Suggested remedy.
    pub hint: String,
    /// Description of the fault, a fragment.
    pub message: String,
}

impl Fault {
    /// A fault of a whole file.
    pub fn of(code: &'static str, file: &str, message: impl Into<String>) -> Self {
        Self {
            code,
            file: file.to_owned(),
            message: message.into(),
            ..Self::default()
        }
    }

    /// At a line.
    #[must_use]
    pub fn line(mut self, line: usize) -> Self {
        self.line = line;
        self
    }

    /// At a line and a column.
    #[must_use]
    pub fn at(mut self, (line, column): (usize, usize)) -> Self {
        (self.line, self.column) = (line, column);
        self
    }

    /// Of a named quantity.
    #[must_use]
    pub fn what(mut self, what: impl Into<String>) -> Self {
        self.what = what.into();
        self
    }

    /// With the value found, cut at 80 characters and without control characters.
    #[must_use]
    pub fn value(mut self, value: impl AsRef<str>) -> Self {
        let printable = |c: char| if c.is_control() { '\u{fffd}' } else { c };
        let mut characters = value.as_ref().chars().map(printable);
        self.value = characters.by_ref().take(80).collect();
        if characters.next().is_some() {
            self.value.push_str("...");
        }
        self
    }

    /// With the valid values.
    #[must_use]
    pub fn allowed(mut self, allowed: impl Into<String>) -> Self {
        self.allowed = allowed.into();
        self
    }

    /// With a suggested remedy.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = hint.into();
        self
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
            if self.column > 0 {
                write!(f, ":{}", self.column)?;
            }
        }
        write!(f, ": {}", self.code)?;
        if !self.what.is_empty() {
            write!(f, " {}", self.what)?;
        }
        if !self.value.is_empty() {
            write!(f, " = {}", self.value)?;
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

impl std::error::Error for Fault {}

/// Faults of a file: at least one, at most [`MAX_LISTED`], in the order in which they were found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// The faults listed.
    pub listed: Vec<Fault>,
    /// Number of further faults.
    pub unlisted: usize,
}

impl Faults {
    /// Adds one.
    pub fn push(&mut self, fault: Fault) {
        if self.listed.len() < MAX_LISTED {
            self.listed.push(fault);
        } else {
            self.unlisted += 1;
        }
    }

    /// Adds those of another file or check.
    pub fn append(&mut self, other: Faults) {
        self.unlisted += other.unlisted;
        other.listed.into_iter().for_each(|fault| self.push(fault));
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.listed.is_empty()
    }

    /// `value` when there are none.
    ///
    /// # Errors
    /// Itself.
    pub fn or<T>(self, value: T) -> Result<T, Faults> {
        if self.is_empty() {
            Ok(value)
        } else {
            Err(self)
        }
    }
}

impl From<Fault> for Faults {
    fn from(fault: Fault) -> Self {
        Self {
            listed: vec![fault],
            unlisted: 0,
        }
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, fault) in self.listed.iter().enumerate() {
            write!(f, "{}{fault}", if k > 0 { "\n" } else { "" })?;
        }
        if self.unlisted > 0 {
            write!(f, "\nand {} more", self.unlisted)?;
        }
        Ok(())
    }
}

impl std::error::Error for Faults {}
