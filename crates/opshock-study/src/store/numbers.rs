//! Storage of numbers by the content of what they were computed from: a folder with a journal, for a match and for a
//! population of drives. A kill costs what was not appended; the rest is found again by its key.

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::aside;
use super::error::StoreError;
use super::journal::{self, JournalContent, JournalHeader, JournalWriter};
use super::lock::StoreLock;
use super::record::{PointDigest, Record};

/// Numbers of one key: not computed, none, or a number.
pub type Numbers = Vec<Option<Option<f64>>>;

/// Numbers by the content of what they were computed from.
pub type Known = HashMap<PointDigest, Numbers>;

/// A task's answer or why it has none, and the numbers it computed, which are kept in both cases.
pub type Answered<T, E> = (Result<T, E>, Vec<(PointDigest, Numbers)>);

/// A store of numbers, open for writing by this process alone.
pub struct NumberStore {
    /// Its folder.
    pub folder: PathBuf,
    journal: JournalWriter,
    _lock: StoreLock,
    /// What it holds, by content.
    pub known: Known,
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
        let records = append(&mut self.journal, new)?;
        self.known.extend(numbers(records));
        Ok(())
    }

    /// Answers of tasks number 0 to `n - 1`, in this order. Each of `threads` takes the lowest number that none has taken; what
    /// a task computed is kept as soon as it ends. `progress` gets the number of tasks done.
    ///
    /// Threads of their own: those of a rayon pool begin further tasks while one of them waits for a sweep.
    ///
    /// # Errors
    /// The journal cannot be written, else that of the lowest number among the tasks that were begun; none is begun after an
    /// error.
    pub fn answers<T: Send, E: Send + From<StoreError>>(
        &mut self,
        n: usize,
        threads: usize,
        answer: impl Fn(usize, &Known) -> Answered<T, E> + Sync,
        mut progress: impl FnMut(usize),
    ) -> Result<Vec<T>, E> {
        let (known, journal) = (&self.known, &mut self.journal);
        let (next, is_over) = (AtomicUsize::new(0), AtomicBool::new(false));
        let (sender, receiver) = crossbeam_channel::unbounded();
        let (mut done, mut failed, mut unwritten, mut computed) =
            (Vec::new(), Vec::new(), None, Vec::new());
        std::thread::scope(|scope| {
            for _ in 0..threads.clamp(1, n.max(1)) {
                let (sender, next, is_over, answer) = (sender.clone(), &next, &is_over, &answer);
                scope.spawn(move || {
                    while !is_over.load(Ordering::SeqCst) {
                        let task = next.fetch_add(1, Ordering::SeqCst);
                        if task >= n {
                            break;
                        }
                        let found = catch_unwind(AssertUnwindSafe(|| answer(task, known)));
                        if !matches!(found, Ok((Ok(_), _))) {
                            is_over.store(true, Ordering::SeqCst);
                        }
                        match found {
                            // The receiver goes only when all is over.
                            Ok(found) => drop(sender.send((task, found))),
                            Err(panic) => resume_unwind(panic),
                        }
                    }
                });
            }
            drop(sender);
            for (task, (found, new)) in receiver {
                match append(journal, new) {
                    Ok(records) => computed.extend(records),
                    Err(error) => {
                        is_over.store(true, Ordering::SeqCst);
                        unwritten.get_or_insert(error);
                        continue;
                    }
                }
                match found {
                    Ok(answer) => {
                        done.push((task, answer));
                        progress(done.len());
                    }
                    Err(error) => failed.push((task, error)),
                }
            }
        });
        self.known.extend(numbers(computed));
        if let Some(error) = unwritten {
            return Err(error.into());
        }
        if let Some((_, error)) = failed.into_iter().min_by_key(|(task, _)| *task) {
            return Err(error);
        }
        done.sort_by_key(|(task, _)| *task);
        Ok(done.into_iter().map(|(_, answer)| answer).collect())
    }
}

/// Writes numbers into a journal.
fn append(
    journal: &mut JournalWriter,
    new: impl IntoIterator<Item = (PointDigest, Numbers)>,
) -> Result<Vec<Record>, StoreError> {
    let new = new.into_iter();
    let records: Vec<Record> = new
        .map(|(key, numbers)| Record::Numbers { key, numbers })
        .collect();
    if !records.is_empty() {
        journal.append(&records)?;
    }
    Ok(records)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    enum Ended {
        At(usize),
        Store,
    }

    impl From<StoreError> for Ended {
        fn from(_: StoreError) -> Self {
            Ended::Store
        }
    }

    fn open(folder: &Path) -> NumberStore {
        NumberStore::open(folder, "test 1", "t", Path::new("t.toml"), "").expect("a store")
    }

    fn key(task: usize) -> PointDigest {
        PointDigest(*blake3::hash(&task.to_le_bytes()).as_bytes())
    }

    #[test]
    fn answers_keep_their_order_and_what_failing_tasks_computed() {
        let folder = tempfile::tempdir().expect("a folder");
        let numbers = |task: usize| vec![(key(task), vec![Some(Some(task as f64))])];
        for threads in [1, 4] {
            let folder = folder.path().join(threads.to_string());
            let failing = |task: usize, _: &Known| match task {
                5 | 6 => (Err(Ended::At(task)), numbers(task)),
                _ => (Ok(task), numbers(task)),
            };
            let mut most = 0;
            let found = open(&folder).answers(20, threads, failing, |done| most = done);
            assert!(matches!(found, Err(Ended::At(5))), "{found:?}");
            assert!((5..20).contains(&most), "{most}");
            // Another process goes on from there.
            let mut store = open(&folder);
            let kept = store.known.len();
            assert!((0..=5).all(|task| store.known.contains_key(&key(task))));
            let rest = |task: usize, known: &Known| match known.contains_key(&key(task)) {
                true => (Ok::<usize, Ended>(task), Vec::new()),
                false => (Ok(task), numbers(task)),
            };
            let found = store.answers(20, threads, rest, |_| {}).expect("answers");
            assert_eq!(found, (0..20).collect::<Vec<_>>());
            assert_eq!(store.known.len(), 20);
            assert!(kept < 20);
        }
    }

    #[test]
    #[should_panic(expected = "a scoped thread panicked")]
    fn a_panic_in_a_task_ends_the_others() {
        let folder = tempfile::tempdir().expect("a folder");
        let answer = |task: usize, _: &Known| {
            assert_ne!(task, 3, "task 3");
            std::thread::sleep(std::time::Duration::from_millis(1));
            (Ok::<usize, Ended>(task), Vec::new())
        };
        // Hours, if the others went on.
        let _ = open(folder.path()).answers(10_000_000, 2, answer, |_| {});
    }
}
