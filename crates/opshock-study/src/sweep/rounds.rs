//! Added widths after a sweep: the next round of a study that refines its widths, by one process or by shards.
//!
//! The widths of a round follow from all answers of the rounds before. So a shard that has answered its own points
//! waits for the shards at work, reads the results of all, and goes on with its part of the next round: every shard
//! finds the same widths. Of the study's own widths a shard answers its part alone, however long the others are away.
//! Added widths are answered by any shard at work, so that the shard that ends last completes them.

use std::path::Path;
use std::time::{Duration, Instant};

use super::added_points::{next_round, refined};
use super::input::SweepInput;
use super::options::{Ending, SweepOptions};
use super::replay::replay;
use super::shard::{Others, Shard, stores};
use crate::search::AmplitudeGridError;
use crate::store::summary::Status;
use crate::store::{self, Loaded, Record, StoreError, Summary, TouchRecord, folder};
use crate::study::Study;

/// Time between two looks of a waiting shard at the others.
const BETWEEN_LOOKS: Duration = Duration::from_millis(250);
/// Looks without a shard at work after which none is expected: between two rounds a shard is not at
/// work for an instant.
const LOOKS: u32 = 4;

/// What follows.
#[derive(Clone, Debug)]
pub enum Next {
    /// The study with the widths of another round.
    Round(Box<Study>),
    /// Nothing: no width is missing.
    Done,
    /// The points of shards that are not at work are open, and with them the next round.
    Left {
        /// Open points.
        points: usize,
    },
    /// A stop was requested, or the budget used up, while waiting for other shards.
    Stopped(Ending),
}

/// Why the next round is not known.
#[derive(Debug, thiserror::Error)]
pub enum RoundError {
    /// The amplitude range has no point of the amplitude grid.
    #[error(transparent)]
    AmplitudeGrid(#[from] AmplitudeGridError),
    /// A store cannot be read.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Everything finished in the store of a whole sweep and in the shards within it; nothing where
/// there is no store.
///
/// # Errors
///
/// [`StoreError`]: a store is damaged or of another format.
pub fn finished(whole: &Path) -> Result<Loaded, StoreError> {
    let mut all = Loaded::default();
    let shards = stores(whole)?;
    for path in std::iter::once(whole.to_owned()).chain(shards) {
        take(&path, &mut all)?;
    }
    Ok(all)
}

/// Adds what is finished in one store, if there is one.
fn take(store: &Path, all: &mut Loaded) -> Result<(), StoreError> {
    let loaded = match store::load(store) {
        Ok((loaded, _)) => loaded,
        Err(StoreError::Empty { .. }) => return Ok(()),
        Err(error) => return Err(error),
    };
    let touches = loaded.touches.into_iter();
    let touches = touches.map(|(point, touch)| Record::Touch(TouchRecord { point, touch }));
    let runs = loaded.runs.into_values().map(Record::Run);
    all.add(touches.chain(runs).collect());
    Ok(())
}

/// The study with every width that the results in `whole` require, where it refines its widths: the start of a sweep.
/// Results of shards are used by a shard alone; a sweep of the whole uses those that were merged.
///
/// # Errors
///
/// [`RoundError`].
pub fn first(study: &Study, whole: &Path, shard: Option<&Shard>) -> Result<Study, RoundError> {
    if study.search.added_points.is_none() {
        return Ok(study.clone());
    }
    let mut known = Loaded::default();
    match shard {
        Some(_) => known = finished(whole)?,
        None => take(whole, &mut known)?,
    }
    Ok(refined(study, &known)?)
}

/// The next step after a complete sweep of `study` into `whole` that ended with `summary`. A shard waits for the others
/// as long as one is at work; its budget runs from `began`.
///
/// # Errors
///
/// [`RoundError`].
pub fn next(
    study: &Study,
    whole: &Path,
    options: &SweepOptions,
    summary: &Summary,
    began: Instant,
) -> Result<Next, RoundError> {
    if study.search.added_points.is_none() {
        return Ok(Next::Done);
    }
    let Some(shard) = &options.shard else {
        let next = next_round(study, summary);
        return Ok(next.map_or(Next::Done, |next| Next::Round(Box::new(next))));
    };
    let input = SweepInput::of(study)?;
    let others = Others::of(shard, whole);
    let mut idle_looks = 0;
    loop {
        // Asked before reading: results that a shard finishes in between are not missed.
        let is_alone = !others.any_at_work();
        let results = replay(&input, finished(whole)?, &folder::session(1));
        let rows = &results.summary.points;
        let points = rows.iter().filter(|row| row.status == Status::Open).count();
        if points == 0 {
            let next = next_round(study, &results.summary);
            return Ok(next.map_or(Next::Done, |next| Next::Round(Box::new(next))));
        }
        idle_looks = if is_alone { idle_looks + 1 } else { 0 };
        if idle_looks == LOOKS {
            return Ok(Next::Left { points });
        }
        std::thread::sleep(BETWEEN_LOOKS);
        if options.stop.is_asked() {
            let signal = options.stop.signal();
            return Ok(Next::Stopped(Ending::Stopped { signal }));
        }
        if options
            .budget
            .is_some_and(|budget| began.elapsed() >= budget)
        {
            return Ok(Next::Stopped(Ending::Budget));
        }
    }
}
