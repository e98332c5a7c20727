//! The folder of a store: opens it for a sweep, or reads it.
//!
//! `study.toml` as given, `study.resolved.toml` with every default, `journal`, `results.h5`,
//! `histories/`, `lock`.

use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::aside;
use super::error::StoreError;
use super::journal::{self, JournalHeader, JournalWriter};
use super::lock::StoreLock;
use super::machine;
use super::names::{HISTORIES, JOURNAL_FILE, RESOLVED_FILE, RESULTS_FILE};
use super::owner::{Owner, StudyTexts};
use super::record::{PointDigest, Record, RunKey, RunRecord, StoredTouch};
use super::results::{self, Results, Session};
use crate::search::Verdict;

/// Finished simulations by content.
#[derive(Clone, Debug, Default)]
pub struct Loaded {
    /// Simulations.
    pub runs: HashMap<RunKey, RunRecord>,
    /// First touches.
    pub touches: HashMap<PointDigest, StoredTouch>,
    /// The study they were made for; `None` where nothing is stored.
    pub owner: Option<Owner>,
    /// Messages about the state of the store: code and sentence.
    pub notes: Vec<(&'static str, String)>,
}

impl Loaded {
    /// Adds records; the first of a kind stays, but a verdict replaces none.
    pub fn add(&mut self, records: Vec<Record>) {
        let undecided = |run: &RunRecord| matches!(run.result.verdict, Verdict::Undecided { .. });
        for record in records {
            match record {
                Record::Run(run) => {
                    let known = self.runs.get(&run.key);
                    if known.is_none_or(|known| undecided(known) && !undecided(&run)) {
                        self.runs.insert(run.key, run);
                    }
                }
                Record::Touch(touch) => {
                    self.touches.entry(touch.point).or_insert(touch.touch);
                }
                // Numbers are those of a match, whose store this is not.
                Record::Session(_) | Record::Numbers { .. } => {}
            }
        }
    }
}

/// A store open for writing by this process alone.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    journal: JournalWriter,
    _lock: StoreLock,
}

impl Store {
    /// Opens or makes the store in `folder` and reads what is finished.
    ///
    /// Before anything else it writes and syncs a probe file, so that a sweep never computes what it could not store. A
    /// torn journal is cut; one with damage in the middle is kept as `journal.damaged` and written anew from its whole
    /// records; a missing one is written from `results.h5`; damaged results are replaced when the journal is sound.
    ///
    /// # Errors
    ///
    /// E188 other study, E181 another format, E182 damaged, E183 not writable, E184 in use.
    pub fn open(
        folder: &Path,
        study: &StudyTexts,
        session: &Session,
    ) -> Result<(Store, Loaded), StoreError> {
        let unwritable = |source| StoreError::Unwritable {
            path: folder.to_owned(),
            source,
        };
        std::fs::create_dir_all(folder).map_err(unwritable)?;
        probe(folder).map_err(unwritable)?;
        let lock = StoreLock::take(folder)?;
        aside::clear(folder);
        aside::clear(&folder.join(HISTORIES));

        let journal_path = folder.join(JOURNAL_FILE);
        let content = journal::read(&journal_path)?;
        let mut loaded = Loaded::default();
        let sound_journal = content
            .as_ref()
            .is_some_and(|content| content.header.is_some());
        let stored = match results::read(&folder.join(RESULTS_FILE)) {
            Ok(stored) => stored,
            Err(error @ StoreError::Damaged { .. }) if sound_journal => {
                let message = format!("{error}; it is written anew from the journal");
                loaded.notes.push(("results_damaged", message));
                None
            }
            Err(error) => return Err(error),
        };
        let found = content.as_ref().and_then(|found| found.header.as_ref());
        let owner = Owner::of(folder, found, stored.as_ref());
        if let Some(owner) = &owner {
            owner.admit(folder, study)?;
            loaded.notes.extend(changes(owner, &study.resolved));
        }

        let from_results = stored.as_ref().map_or(Vec::new(), Results::records);
        let records = match content {
            None => from_results.clone(),
            Some(content) => {
                let intact =
                    content.header.is_some() && content.damage.iter().all(|damage| damage.at_end);
                for damage in &content.damage {
                    loaded
                        .notes
                        .push(("journal_damage", reported(damage, intact)));
                }
                let mut records = content.records;
                if !intact {
                    let kept = folder.join("journal.damaged");
                    let bytes = std::fs::read(&journal_path).map_err(unwritable)?;
                    aside::write(&kept, &bytes)?;
                    records.extend(from_results.iter().cloned());
                }
                records
            }
        };
        let header = JournalHeader {
            study: study.name.clone(),
            digest: study.digest.clone(),
            file: study.file_from(folder),
            resolved: study.resolved.clone(),
        };
        let session = serde_json::to_string(session).expect("a session serialises");
        let session = [Record::Session(session)];
        let all = [records.as_slice(), &session].concat();
        let journal = JournalWriter::create(&journal_path, &header, &all)?;
        loaded.add(records);
        loaded.add(from_results);
        keep_text(folder, "study.toml", &study.given)?;
        keep_text(folder, RESOLVED_FILE, &study.resolved)?;
        std::fs::create_dir_all(folder.join(HISTORIES)).map_err(unwritable)?;
        let store = Store {
            folder: folder.to_owned(),
            journal,
            _lock: lock,
        };
        Ok((store, loaded))
    }

    /// Folder of the store.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Appends finished simulations; they are stored once this returns.
    ///
    /// # Errors
    ///
    /// The disk refused; nothing of this call is stored.
    pub fn append(&mut self, records: &[Record]) -> Result<(), StoreError> {
        self.journal.append(records)
    }

    /// Replaces `results.h5`.
    ///
    /// # Errors
    ///
    /// The disk refused; the former file is in place.
    pub fn checkpoint(&self, results: &Results) -> Result<PathBuf, StoreError> {
        let path = self.folder.join(RESULTS_FILE);
        results::write(&path, results, &self.folder)?;
        Ok(path)
    }
}

/// Reads what is finished, without lock and without changing anything.
///
/// # Errors
///
/// Newer or unreadable files; damaged results when there is no sound journal; E187 when nothing is
/// stored.
pub fn load(folder: &Path) -> Result<(Loaded, Option<Results>), StoreError> {
    let content = journal::read(&folder.join(JOURNAL_FILE))?;
    let mut loaded = Loaded::default();
    let stored = match results::read(&folder.join(RESULTS_FILE)) {
        Ok(stored) => stored,
        Err(error @ StoreError::Damaged { .. }) if content.is_some() => {
            loaded.notes.push(("results_damaged", error.to_string()));
            None
        }
        Err(error) => return Err(error),
    };
    if content.is_none() && stored.is_none() {
        return Err(StoreError::Empty {
            path: folder.to_owned(),
        });
    }
    let header = content.as_ref().and_then(|found| found.header.as_ref());
    loaded.owner = Owner::of(folder, header, stored.as_ref());
    if let Some(content) = content {
        loaded.add(content.records);
    }
    loaded.add(stored.as_ref().map_or(Vec::new(), Results::records));
    Ok((loaded, stored))
}

fn reported(damage: &journal::Damage, intact: bool) -> String {
    let journal::Damage { offset, length, .. } = damage;
    if intact {
        format!("journal: {length} bytes at {offset} held no whole record and were cut off")
    } else {
        format!(
            "journal: {length} bytes at {offset} are damaged; what they held is simulated again, \
             the file is kept as journal.damaged"
        )
    }
}

/// What the study changed since the store was used last.
fn changes(owner: &Owner, resolved: &str) -> Option<(&'static str, String)> {
    let changed = owner.changed(resolved)?;
    let reported: Vec<String> = changed.iter().map(ToString::to_string).collect();
    (!reported.is_empty()).then(|| {
        let message = format!(
            "the study has changed since the last sweep into this store: {}; simulations that \
             stay valid are used again",
            reported.join(", ")
        );
        ("study_changed", message)
    })
}

/// Writes and syncs a small file, and removes it.
fn probe(folder: &Path) -> std::io::Result<()> {
    let mut file = tempfile::Builder::new()
        .prefix(".probe-")
        .tempfile_in(folder)?;
    file.write_all(&[0; 4096])?;
    file.as_file().sync_all()
}

fn keep_text(folder: &Path, name: &str, text: &str) -> Result<(), StoreError> {
    let path = folder.join(name);
    match std::fs::read_to_string(&path) {
        Ok(same) if same == text => Ok(()),
        _ => aside::write(&path, text.as_bytes()),
    }
}

/// Program, host and process of a session.
pub fn session(threads: usize) -> Session {
    Session {
        program_version: crate::provenance::VERSION.to_owned(),
        commit: crate::provenance::COMMIT.to_owned(),
        physics_structure: crate::provenance::PHYSICS_STRUCTURE,
        physics_head: crate::provenance::PHYSICS_HEAD,
        host: machine::host(),
        process: std::process::id(),
        threads,
        started_unix_s: machine::unix_now_s(),
    }
}
