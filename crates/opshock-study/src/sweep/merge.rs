//! Merges stores: every finished simulation of several stores in one, and the table from them.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::input::SweepInput;
use super::replay::replay;
use crate::search::ProbeResult;
use crate::store::{
    Loaded, Record, Results, RunKey, Session, Store, StoreError, StoredTouch, TouchRecord,
};

/// Result of a merge.
#[derive(Debug)]
pub struct Merged {
    /// Table and simulations.
    pub results: Results,
    /// Simulations added, per store.
    pub taken: Vec<u64>,
    /// Simulations whose numbers differ between two stores while their verdicts agree: a C library or processor gave
    /// other last digits. The first store's are kept.
    pub rounding: u64,
    /// Histories that were not taken because they are damaged.
    pub left: Vec<StoreError>,
}

/// Two stores that cannot be united.
#[derive(Clone, Debug, PartialEq)]
pub struct Disagreement {
    /// Amplitude, m/s2, with its sign.
    pub amplitude_m_per_s2: f64,
    /// A store and its verdict.
    pub first: (PathBuf, &'static str),
    /// The other.
    pub second: (PathBuf, &'static str),
}

impl std::fmt::Display for Disagreement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let ((a, at_a), (b, at_b)) = (&self.first, &self.second);
        write!(
            f,
            "the same simulation at {:.6} m/s2 {at_a} in {} and {at_b} in {}",
            self.amplitude_m_per_s2,
            a.display(),
            b.display()
        )
    }
}

/// Outcome of [`merge`].
#[derive(Debug)]
pub enum MergeEnd {
    /// United.
    Merged(Box<Merged>),
    /// Verdicts of the same simulation differ; nothing was written.
    Disagree(Vec<Disagreement>),
}

/// Merges the stores `from` into the one in `folder`, which is made when it is missing, with their histories. The
/// result does not depend on which machine simulated what.
///
/// # Errors
///
/// [`StoreError`]: a store cannot be read, or the one in `folder` cannot be written.
pub fn merge(
    input: &SweepInput,
    folder: &Path,
    from: &[PathBuf],
    session: &Session,
) -> Result<MergeEnd, StoreError> {
    let mut sources = Vec::new();
    for path in from {
        sources.push((path.clone(), crate::store::load(path)?.0));
    }
    let (disagreements, rounding) = compare(&sources);
    if !disagreements.is_empty() {
        return Ok(MergeEnd::Disagree(disagreements));
    }
    let (mut store, mut loaded) = Store::open(folder, &input.texts, session)?;
    let own = [(folder.to_owned(), loaded.clone())];
    let with_own: Vec<(PathBuf, Loaded)> = own.into_iter().chain(sources.iter().cloned()).collect();
    let (disagreements, _) = compare(&with_own);
    if !disagreements.is_empty() {
        return Ok(MergeEnd::Disagree(disagreements));
    }
    let mut taken = Vec::new();
    for (_, source) in &sources {
        let new = missing(&loaded, source);
        let is_run = |record: &&Record| matches!(record, Record::Run(_));
        taken.push(new.iter().filter(is_run).count() as u64);
        store.append(&new)?;
        loaded.add(new);
    }
    let results = replay(input, loaded, session);
    let left = take_histories(&results, from, folder)?;
    store.checkpoint(&results)?;
    Ok(MergeEnd::Merged(Box::new(Merged {
        results,
        taken,
        rounding,
        left,
    })))
}

/// Records of `source` that `loaded` does not have, in a reproducible order.
fn missing(loaded: &Loaded, source: &Loaded) -> Vec<Record> {
    let mut touches: Vec<_> = source
        .touches
        .iter()
        .filter(|(point, _)| !loaded.touches.contains_key(*point))
        .map(|(&point, &touch): (_, &StoredTouch)| TouchRecord { point, touch })
        .collect();
    touches.sort_by_key(|touch| touch.point);
    let undecided = |result: &ProbeResult| result.verdict.as_str() == "undecided";
    let mut runs: Vec<_> = source
        .runs
        .values()
        .filter(|run| {
            let known = loaded.runs.get(&run.key);
            known.is_none_or(|known| undecided(&known.result) && !undecided(&run.result))
        })
        .cloned()
        .collect();
    runs.sort_by_key(|run| run.key);
    let touches = touches.into_iter().map(Record::Touch);
    touches.chain(runs.into_iter().map(Record::Run)).collect()
}

/// Verdicts that differ between stores, and the number of simulations that differ in less.
fn compare(sources: &[(PathBuf, Loaded)]) -> (Vec<Disagreement>, u64) {
    let mut first: HashMap<RunKey, (&Path, &ProbeResult)> = HashMap::new();
    let mut found = Vec::new();
    let mut rounding = 0;
    for (path, loaded) in sources {
        for (key, run) in &loaded.runs {
            let Some(&(before, result)) = first.get(key) else {
                first.insert(*key, (path, &run.result));
                continue;
            };
            let words = [result.verdict.as_str(), run.result.verdict.as_str()];
            // A verdict replaces an undecided run: that is no contradiction.
            if words[0] != words[1] && !words.contains(&"undecided") {
                let at = Disagreement {
                    amplitude_m_per_s2: f64::from_bits(key.amplitude_bits),
                    first: (before.to_owned(), words[0]),
                    second: (path.clone(), words[1]),
                };
                found.push((*key, at));
            } else if *result != run.result {
                rounding += 1;
            }
        }
    }
    found.sort_by_key(|(key, _)| *key);
    (found.into_iter().map(|(_, at)| at).collect(), rounding)
}

/// Takes recorded histories that `to` does not have; returns the faults of those that were not taken.
fn take_histories(
    results: &Results,
    from: &[PathBuf],
    to: &Path,
) -> Result<Vec<StoreError>, StoreError> {
    let mut left = Vec::new();
    for run in results.kept_runs() {
        if matches!(run.read(to), Ok(Some(_))) {
            continue;
        }
        for store in from {
            match run.copy(store, to) {
                Ok(false) => {}
                Ok(true) => break,
                Err(error @ StoreError::Unwritable { .. }) => return Err(error),
                Err(error) => left.push(error),
            }
        }
    }
    Ok(left)
}
