//! Reads the words of a `.msh` file by section; faults where they differ in number or kind from the declared ones.

use crate::fault::{Fault, Faults};
use crate::text::{Line, NotANumber, Word};
use std::iter::Peekable;

/// Reads words that stand between two marks.
pub(super) struct Reader<'a, L: Iterator<Item = Line<'a>>> {
    pub(super) file: &'a str,
    lines: Peekable<L>,
    words: std::vec::IntoIter<Word<'a>>,
    /// Line read last.
    last: usize,
}

fn is_mark(line: &Line<'_>) -> bool {
    line.text.trim_start().starts_with('$')
}

impl<'a, L: Iterator<Item = Line<'a>>> Reader<'a, L> {
    /// Before the first line.
    pub(super) fn new(file: &'a str, lines: L) -> Self {
        Self {
            file,
            lines: lines.peekable(),
            words: Vec::new().into_iter(),
            last: 0,
        }
    }

    fn line(&mut self) -> Option<Line<'a>> {
        let line = self.lines.next()?;
        self.last = line.number;
        Some(line)
    }

    /// The mark that opens the next section.
    pub(super) fn next_section(&mut self) -> Option<Line<'a>> {
        self.words = Vec::new().into_iter();
        loop {
            let line = self.line()?;
            if is_mark(&line) {
                return Some(line);
            }
        }
    }

    /// Skips the lines before the next mark.
    pub(super) fn skip(&mut self) {
        self.words = Vec::new().into_iter();
        while self.lines.peek().is_some_and(|line| !is_mark(line)) {
            self.line();
        }
    }

    /// The mark that closes a section, with nothing before it.
    pub(super) fn end(&mut self, name: &str, opened: usize) -> Result<(), Faults> {
        let mark = format!("$End{name}");
        let mut next = self.words.next();
        let word = loop {
            if let Some(word) = next {
                break word;
            }
            let Some(line) = self.line() else {
                let fault = Fault::of("E160", self.file, "the file is cut short");
                return Err(fault.line(opened).what(name).allowed(mark).into());
            };
            if line.text.trim() == mark {
                return Ok(());
            }
            next = line.words().next();
        };
        let fault = Fault::of("E177", self.file, "more words than declared");
        Err(fault
            .at(word.place())
            .what(name)
            .value(word.text)
            .allowed(mark)
            .into())
    }

    /// The next word of the section.
    pub(super) fn word(&mut self, what: &str) -> Result<Word<'a>, Faults> {
        loop {
            if let Some(word) = self.words.next() {
                return Ok(word);
            }
            let (code, message) = match self.lines.peek() {
                Some(line) if !is_mark(line) => {
                    let words: Vec<Word<'a>> = line.words().collect();
                    self.words = words.into_iter();
                    self.line();
                    continue;
                }
                Some(_) => ("E177", "fewer words than declared"),
                None => ("E160", "the file is cut short"),
            };
            let fault = Fault::of(code, self.file, message);
            return Err(fault.line(self.last).what(what).allowed("a number").into());
        }
    }

    /// What is left of the line of the word read last, with single blanks.
    pub(super) fn rest_of_line(&mut self) -> String {
        let words: Vec<&str> = self.words.by_ref().map(|word| word.text).collect();
        words.join(" ")
    }

    pub(super) fn count(&mut self, what: &str) -> Result<usize, Faults> {
        let word = self.word(what)?;
        word.count().ok_or_else(|| {
            let fault = Fault::of("E177", self.file, "not a whole number from 0");
            fault.at(word.place()).what(what).value(word.text).into()
        })
    }

    /// Number of an entity or group; a negative sign, which reverses orientation, is dropped.
    pub(super) fn signed(&mut self, what: &str) -> Result<usize, Faults> {
        let word = self.word(what)?;
        let number = word
            .integer()
            .and_then(|n| usize::try_from(n.unsigned_abs()).ok());
        number.ok_or_else(|| {
            let fault = Fault::of("E177", self.file, "not a whole number");
            fault.at(word.place()).what(what).value(word.text).into()
        })
    }

    pub(super) fn real(&mut self, what: &str) -> Result<f64, Faults> {
        let word = self.word(what)?;
        word.real().map_err(|wrong| {
            let message = match wrong {
                NotANumber::Comma => "a comma in a number",
                NotANumber::NotFinite => "the value is not finite, or 1e300 and more",
                NotANumber::Word => "the value is no number",
            };
            let fault = Fault::of("E177", self.file, message);
            fault
                .at(word.place())
                .what(what)
                .value(word.text)
                .allowed("a number with a decimal point")
                .into()
        })
    }

    /// The line of the word read last.
    pub(super) fn at(&self) -> usize {
        self.last
    }

    pub(super) fn as_declared(
        &self,
        what: &str,
        declared: usize,
        there: usize,
    ) -> Result<(), Faults> {
        if declared == there {
            return Ok(());
        }
        let fault = Fault::of("E177", self.file, "not the declared number");
        Err(fault
            .line(self.at())
            .what(what)
            .value(there.to_string())
            .allowed(declared.to_string())
            .into())
    }
}
