//! Storage of numbers by the content of what they were computed from: a folder with a journal, for a match and for a
//! population of drives. A kill costs what was not appended; the rest is found again by its key.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::aside;
use super::error::StoreError;
use super::journal::{self, JournalContent, JournalHeader, JournalWriter};
use super::lock::StoreLock;
use super::record::{PointDigest, Record};

/// Numbers of one key: not computed, none, or a number.
pub type Numbers = Vec<Option<Option<f64>>>;

/// A store of numbers, open for writing by this process alone.
pub struct NumberStore {
    /// Its folder.
    pub folder: PathBuf,
    journal: JournalWriter,
    _lock: StoreLock,
    /// What it holds, by content.
    pub known: HashMap<PointDigest, Numbers>,
    /// Messages about its state.
    pub notes: Vec<String>,
}

/// Header of the journal of a store in `folder` that belongs to a file of the `kind` (such as `match 1`).
pub fn header(folder: &Path, kind: &str, name: &str, file: &Path, text: &str) -> JournalHeader {
    let relative = || -> Option<PathBuf> {
        let own = std::fs::canonicalize(file).ok()?;
        pathdiff::diff_paths(own, std::fs::canonicalize(folder).ok()?)
    };
    JournalHeader {
        study: name.to_owned(),
        digest: kind.to_owned(),
        file: relative(),
        resolved: text.to_owned(),
    }
}

impl NumberStore {
    /// Opens or makes the store in `folder` of the file `file`, which has this name and text.
    ///
    /// # Errors
    /// E181 newer format, E183 not writable, E184 in use, E188 it belongs to another file.
    pub fn open(
        folder: &Path,
        kind: &str,
        name: &str,
        file: &Path,
        text: &str,
    ) -> Result<Self, StoreError> {
        let unwritable = |source| StoreError::Unwritable {
            path: folder.to_owned(),
            source,
        };
        std::fs::create_dir_all(folder).map_err(unwritable)?;
        let lock = StoreLock::take(folder)?;
        aside::clear(folder);
        let path = folder.join("journal");
        let content = journal::read(&path)?;
        let header = header(folder, kind, name, file, text);
        let mut notes = Vec::new();
        let mut records = Vec::new();
        if let Some(content) = content {
            if let Some(found) = &content.header
                && (found.digest != header.digest || found.file != header.file)
            {
                let other = found.file.as_ref().map(|file| file.display().to_string());
                return Err(StoreError::OtherStudy {
                    path: folder.to_owned(),
                    found: other.unwrap_or_else(|| format!("\"{}\"", found.study)),
                    wanted: file.display().to_string(),
                    differ: "the file".to_owned(),
                    hint: "name another store",
                });
            }
            notes = damage(&path, &content);
            records = content.records;
        }
        let journal = JournalWriter::create(&path, &header, &records)?;
        Ok(Self {
            folder: folder.to_owned(),
            journal,
            _lock: lock,
            known: numbers(records).collect(),
            notes,
        })
    }

    /// Takes what the store in `folder` knows, for this process alone.
    ///
    /// # Errors
    /// E181 newer format, or it cannot be read.
    pub fn reuse(&mut self, folder: &Path) -> Result<(), StoreError> {
        let path = folder.join("journal");
        let Some(content) = journal::read(&path)? else {
            return Err(StoreError::Unreadable {
                path,
                source: std::io::ErrorKind::NotFound.into(),
            });
        };
        self.notes.extend(damage(&path, &content));
        for (key, numbers) in numbers(content.records) {
            self.known.entry(key).or_insert(numbers);
        }
        Ok(())
    }

    /// Keeps numbers; they are on the disk when this returns.
    ///
    /// # Errors
    /// The journal cannot be written.
    pub fn append(
        &mut self,
        new: impl IntoIterator<Item = (PointDigest, Numbers)>,
    ) -> Result<(), StoreError> {
        let new = new.into_iter();
        let records: Vec<Record> = new
            .map(|(key, numbers)| Record::Numbers { key, numbers })
            .collect();
        self.journal.append(&records)?;
        self.known.extend(numbers(records));
        Ok(())
    }
}

/// What the records hold.
fn numbers(records: Vec<Record>) -> impl Iterator<Item = (PointDigest, Numbers)> {
    records.into_iter().filter_map(|record| match record {
        Record::Numbers { key, numbers } => Some((key, numbers)),
        _ => None,
    })
}

/// What could not be read of a journal, but for its end, as a kill leaves it.
fn damage(path: &Path, content: &JournalContent) -> Vec<String> {
    let inside = content.damage.iter().filter(|damage| !damage.at_end);
    inside
        .map(|damage| {
            format!(
                "{}: {} bytes at {} cannot be read; what they held is computed again",
                path.display(),
                damage.length,
                damage.offset
            )
        })
        .collect()
}
