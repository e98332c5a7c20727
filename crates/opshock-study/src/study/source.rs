//! The texts a study is made of (study file, `--set` arguments, surface files, defaults), and places in them.

use std::ops::Range;
use std::sync::Arc;

/// One text and the name it goes by in messages.
#[derive(Debug, PartialEq, Eq)]
pub struct Source {
    /// Path of the file as given, or what stands in its place (`--set`, `default`).
    pub name: String,
    /// The text.
    pub text: String,
}

impl Source {
    /// A shared source.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Arc<Self> {
        Arc::new(Self {
            name: name.into(),
            text: text.into(),
        })
    }

    /// Line and column of a byte offset, both from 1; columns count characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let before = &self.text[..offset];
        let start = before.rfind('\n').map_or(0, |at| at + 1);
        (
            before.matches('\n').count() + 1,
            before[start..].chars().count() + 1,
        )
    }
}

/// Where a study's text came from; decides who wins and what is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// The table of keys.
    Default,
    /// A named preset.
    Preset,
    /// The study file.
    File,
    /// A file the study names.
    Included,
    /// The command line; the number is its position there.
    Set(usize),
}

/// A stretch of a source.
#[derive(Clone, Debug)]
pub struct Place {
    /// The text.
    pub source: Arc<Source>,
    /// Byte range in it.
    pub span: Range<usize>,
    /// What kind of text it is.
    pub origin: Origin,
}

impl Place {
    /// The text at this place.
    pub fn text(&self) -> &str {
        self.source.text.get(self.span.clone()).unwrap_or("")
    }
}
