//! The study that a store belongs to, recognised by content.
//!
//! Results are shown for a study only where every setting is the one they were made with. A sweep may
//! go on in the store of an earlier form of the same study file, for simulations are found by their own
//! content; it never enters the store of another file. A name decides neither: two studies may share one.

use std::path::{Path, PathBuf};

use super::error::StoreError;
use super::journal::JournalHeader;
use super::names::RESOLVED_FILE;
use super::results::Results;
use crate::study::difference::{self, SettingDifference};
use crate::study::digest_of;

/// The study that a store is made for.
#[derive(Clone, Debug, Default)]
pub struct StudyTexts {
    /// Name of the study.
    pub name: String,
    /// Digest of every setting.
    pub digest: String,
    /// Its file, absolute and without links; `None` for a study that comes from no file.
    pub file: Option<PathBuf>,
    /// The file as given.
    pub given: String,
    /// With every default.
    pub resolved: String,
}

/// Settings that a message lists at most.
const LISTED: usize = 6;

/// What a store records of its study; empty where it records nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Owner {
    /// Name.
    pub name: String,
    /// Digest of every setting.
    pub digest: String,
    /// The study file, seen from the store's folder.
    pub file: Option<PathBuf>,
    /// The study with every default.
    pub resolved: Option<String>,
}

impl Owner {
    /// Of the store in `folder` with these files; `None` when they record nothing. The journal comes first: a sweep of
    /// a changed study writes it before new results. Then the results, and last, for journals of an earlier program and
    /// damaged ones, the study that lies beside.
    pub(super) fn of(
        folder: &Path,
        journal: Option<&JournalHeader>,
        results: Option<&Results>,
    ) -> Option<Owner> {
        if let Some(header) = journal.filter(|header| !header.digest.is_empty()) {
            return Some(Owner {
                name: header.study.clone(),
                digest: header.digest.clone(),
                file: header.file.clone(),
                resolved: Some(header.resolved.clone()),
            });
        }
        let resolved = std::fs::read_to_string(folder.join(RESOLVED_FILE)).ok();
        if let Some(Results { summary, .. }) = results {
            return Some(Owner {
                name: summary.study.clone(),
                digest: summary.digest.clone(),
                file: None,
                // A text of other settings, edited or of another store, says nothing about these results.
                resolved: resolved.filter(|text| digest_of(text) == summary.digest),
            });
        }
        let Some(resolved) = resolved else {
            return journal.map(|header| Owner {
                name: header.study.clone(),
                ..Owner::default()
            });
        };
        Some(Owner {
            name: difference::flat(&resolved)?
                .get("name")?
                .as_str()?
                .to_owned(),
            digest: digest_of(&resolved),
            file: None,
            resolved: Some(resolved),
        })
    }

    /// Refuses a sweep of a study into the store in `folder`, unless it holds this study or an
    /// earlier form of the same file.
    ///
    /// # Errors
    ///
    /// E188.
    pub fn admit(&self, folder: &Path, study: &StudyTexts) -> Result<(), StoreError> {
        let is_same_file = match (&self.file, study.file_from(folder)) {
            (Some(found), Some(wanted)) => *found == wanted,
            // A journal of an earlier program or none, or a study from no file: the name is all there is.
            _ => self.name == study.name,
        };
        if self.digest == study.digest || is_same_file {
            return Ok(());
        }
        let file = study.file.as_deref().map(|path| path.display().to_string());
        Err(self.refusal(
            folder,
            &file.unwrap_or_else(|| format!("\"{}\"", study.name)),
            &study.resolved,
            "name another store; `sweep --reuse` of this one takes what stays valid",
        ))
    }

    /// Refuses to show what is in `folder` for a study with other settings; `wanted` names its file.
    ///
    /// # Errors
    ///
    /// E188.
    pub fn belongs(
        &self,
        folder: &Path,
        wanted: &Path,
        digest: &str,
        resolved: &str,
    ) -> Result<(), StoreError> {
        if self.digest == digest {
            return Ok(());
        }
        Err(self.refusal(
            folder,
            &wanted.display().to_string(),
            resolved,
            "sweep this study, give the --set of its sweep, or name the store itself",
        ))
    }

    /// Settings of `resolved` that differ in the store; `None` where the store does not record them.
    pub fn changed(&self, resolved: &str) -> Option<Vec<SettingDifference>> {
        let before = difference::flat(self.resolved.as_deref()?)?;
        Some(difference::differing(&before, &difference::flat(resolved)?))
    }

    fn refusal(
        &self,
        folder: &Path,
        wanted: &str,
        resolved: &str,
        hint: &'static str,
    ) -> StoreError {
        let changed = self.changed(resolved).unwrap_or_default();
        let mut differ: Vec<String> = changed.iter().map(ToString::to_string).collect();
        if differ.len() > LISTED {
            let more = differ.len() - LISTED;
            differ.truncate(LISTED);
            differ.push(format!("{more} more"));
        }
        StoreError::OtherStudy {
            path: folder.to_owned(),
            found: match &self.file {
                Some(file) => file.display().to_string(),
                None => format!("\"{}\"", self.name),
            },
            wanted: wanted.to_owned(),
            differ: match differ.is_empty() {
                true => "which settings differ is not known".to_owned(),
                false => differ.join(", "),
            },
            hint,
        }
    }
}

impl StudyTexts {
    /// The study file as seen from a store's folder, which exists; `None` where no text names it.
    pub(super) fn file_from(&self, folder: &Path) -> Option<PathBuf> {
        let folder = std::fs::canonicalize(folder).ok()?;
        let file = pathdiff::diff_paths(self.file.as_ref()?, folder)?;
        file.to_str().is_some().then_some(file)
    }
}
