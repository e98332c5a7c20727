//! Text files as lines of words with their places, and numbers in other programs' notations.

use crate::fault::{Fault, Faults};
use std::path::Path;

/// Largest file read, bytes.
pub const MAX_BYTES: u64 = 1 << 30;

/// A file as text, with the name that messages use.
#[derive(Clone, Debug)]
pub struct Source {
    /// Name as the user gave it.
    pub name: String,
    text: String,
}

impl Source {
    /// Text of a file's bytes: UTF-8 if valid, else Latin-1, which these older formats use.
    ///
    /// # Errors
    /// E160 for an empty file and for bytes that are no text.
    pub fn of(name: &str, bytes: Vec<u8>) -> Result<Self, Faults> {
        if bytes.iter().all(u8::is_ascii_whitespace) {
            let size = format!("{} bytes", bytes.len());
            return Err(Fault::of("E160", name, "the file is empty")
                .value(size)
                .into());
        }
        if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
            return Err(Fault::of("E160", name, "the file is UTF-16")
                .allowed("plain text")
                .hint("save it as UTF-8 or Latin-1")
                .into());
        }
        if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
            return Err(
                Fault::of("E160", name, format!("the file is binary: byte {at} is 0"))
                    .allowed("plain text")
                    .into(),
            );
        }
        let text = String::from_utf8(bytes).unwrap_or_else(|wrong| {
            wrong
                .as_bytes()
                .iter()
                .map(|byte| char::from(*byte))
                .collect()
        });
        Ok(Self {
            name: name.to_owned(),
            text: text.trim_start_matches('\u{feff}').to_owned(),
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// E160 when it is missing, not readable, larger than [`MAX_BYTES`], or as [`Source::of`].
    pub fn read(path: &Path) -> Result<Self, Faults> {
        let name = path.display().to_string();
        let unread = |error: std::io::Error| {
            Faults::from(Fault::of(
                "E160",
                &name,
                format!("cannot be read: {}", reason(&error)),
            ))
        };
        let about = std::fs::metadata(path).map_err(unread)?;
        if about.is_dir() {
            return Err(Fault::of("E160", &name, "is a folder")
                .allowed("a file")
                .into());
        }
        if about.len() > MAX_BYTES {
            return Err(Fault::of("E160", &name, "the file is too large")
                .value(format!("{} bytes", about.len()))
                .allowed(format!("at most {MAX_BYTES} bytes"))
                .into());
        }
        Self::of(&name, std::fs::read(path).map_err(unread)?)
    }

    /// Lines with their numbers from 1.
    pub fn lines(&self) -> impl Iterator<Item = Line<'_>> {
        (1..)
            .zip(self.text.lines())
            .map(|(number, text)| Line { number, text })
    }

    /// Its text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Its bytes.
    pub fn n_bytes(&self) -> usize {
        self.text.len()
    }
}

/// The operating system's reason without its error number.
fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error")
        .next()
        .unwrap_or_default()
        .to_lowercase()
}

/// A line.
#[derive(Clone, Copy, Debug)]
pub struct Line<'a> {
    /// Number from 1.
    pub number: usize,
    /// Text without its end.
    pub text: &'a str,
}

impl<'a> Line<'a> {
    /// Its words, separated by white space.
    pub fn words(self) -> impl Iterator<Item = Word<'a>> {
        let mut rest = self.text;
        let mut column = 1;
        std::iter::from_fn(move || {
            let start = rest.find(|c: char| !c.is_whitespace())?;
            column += rest[..start].chars().count();
            rest = &rest[start..];
            let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
            let word = Word {
                text: &rest[..end],
                line: self.number,
                column,
            };
            column += rest[..end].chars().count();
            rest = &rest[end..];
            Some(word)
        })
    }
}

/// A word with its place.
#[derive(Clone, Copy, Debug)]
pub struct Word<'a> {
    /// Text.
    pub text: &'a str,
    /// Line from 1.
    pub line: usize,
    /// Column from 1, in characters.
    pub column: usize,
}

impl Word<'_> {
    /// Place for a fault.
    pub fn place(&self) -> (usize, usize) {
        (self.line, self.column)
    }

    /// A real number, with the exponents D and d of Fortran too.
    pub fn real(&self) -> Result<f64, NotANumber> {
        let text = self.text;
        if text.len() > 1 && text.contains(',') {
            return Err(NotANumber::Comma);
        }
        let value = match text.parse::<f64>() {
            Ok(value) => value,
            Err(_) => {
                let fortran = text.replace(['D', 'd'], "e");
                fortran.parse::<f64>().map_err(|_| NotANumber::Word)?
            }
        };
        if value.is_nan() || value.abs() >= 1e300 {
            return Err(NotANumber::NotFinite);
        }
        Ok(value)
    }

    /// A whole number from 0.
    pub fn count(&self) -> Option<usize> {
        self.text.parse().ok()
    }

    /// A whole number.
    pub fn integer(&self) -> Option<i64> {
        self.text.parse().ok()
    }
}

/// Why a word is no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotANumber {
    /// It has a comma.
    Comma,
    /// NaN, infinite, or 1e300 and more.
    NotFinite,
    /// It is another word.
    Word,
}
