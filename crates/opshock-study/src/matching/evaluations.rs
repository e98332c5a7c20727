//! Evaluates parameter sets and keeps their numbers by content.
//!
//! The key of a set of numbers is the content of the simulated study with every file that it names, the quantities read
//! and the physics versions. So ranges of observations may change and nothing is simulated again.

use std::collections::HashMap;
use std::path::Path;

use rayon::prelude::*;

use super::file::MatchProblem;
use super::observation::{Known, Quantity, ShockChoice, Stage};
use super::outputs::{self, Printed};
use crate::provenance::{PHYSICS_HEAD, PHYSICS_STRUCTURE};
use crate::store::{NumberStore, PointDigest, StoreError};
use crate::study::{Study, StudyErrors};

/// An evaluation: stage, parameter set, and whether every discretisation parameter is refined.
pub(super) type Asked<'a> = (Stage, &'a [f64], bool);

/// Numbers known so far, and where new ones are kept.
pub struct Evaluations<'a> {
    problem: &'a MatchProblem,
    printed: &'a dyn Printed,
    store: Option<NumberStore>,
    known: HashMap<PointDigest, Vec<Known>>,
    /// Numbers computed by this process.
    pub computed: u64,
    stop: &'a (dyn Fn() -> bool + Sync),
    /// Called with how many of how many parameter sets a stage has.
    progress: &'a dyn Fn(Stage, usize, usize),
}

/// Why there is no answer yet.
#[derive(Debug)]
pub(super) enum Interrupted {
    /// A stop was requested.
    Stopped,
    /// The store could not be written.
    Store(StoreError),
}

impl MatchProblem {
    /// Opens or makes the store of the match in `folder`.
    ///
    /// # Errors
    /// As [`NumberStore::open`].
    pub fn open_store(&self, folder: &Path) -> Result<NumberStore, StoreError> {
        NumberStore::open(folder, "match 1", &self.name, &self.path, &self.text)
    }
}

impl<'a> Evaluations<'a> {
    /// With a store, or kept in memory alone; `stop` is called between simulations, `progress` as they finish.
    pub fn new(
        problem: &'a MatchProblem,
        printed: &'a dyn Printed,
        mut store: Option<NumberStore>,
        stop: &'a (dyn Fn() -> bool + Sync),
        progress: &'a dyn Fn(Stage, usize, usize),
    ) -> Self {
        let known = store.as_mut().map(|store| std::mem::take(&mut store.known));
        let known = known.unwrap_or_default().into_iter();
        let known =
            known.map(|(key, numbers)| (key, numbers.into_iter().map(Known::from).collect()));
        Self {
            problem,
            printed,
            store,
            known: known.collect(),
            computed: 0,
            stop,
            progress,
        }
    }

    /// Numbers of every observation for each request, in their order; unknown ones are computed by the threads of the
    /// pool this runs in. After an interruption, those that are known, and why.
    pub(super) fn of(
        &mut self,
        asked: &[Asked<'_>],
    ) -> (Vec<Option<Vec<Known>>>, Result<(), Interrupted>) {
        let read = asked.par_iter().map(|one| read(self.problem, one).0);
        let keys: Vec<PointDigest> = read.collect();
        let mut missing: Vec<usize> = Vec::new();
        for (place, key) in keys.iter().enumerate() {
            if !self.known.contains_key(key)
                && !missing.iter().rev().take(1).any(|last| keys[*last] == *key)
            {
                missing.push(place);
            }
        }
        let computed = self.compute(asked, &missing);
        let numbers = keys.iter().map(|key| self.known.get(key).cloned());
        (numbers.collect(), computed)
    }

    fn compute(&mut self, asked: &[Asked<'_>], missing: &[usize]) -> Result<(), Interrupted> {
        // Number of sets kept with one sync: a kill loses no more.
        let batch = 16 * rayon::current_num_threads();
        let mut so_far = 0;
        for part in missing.chunks(batch) {
            let (problem, printed, stop) = (self.problem, self.printed, self.stop);
            let numbers: Vec<Option<Computed>> = part
                .par_iter()
                .map(|place| (!stop()).then(|| compute(problem, printed, &asked[*place])))
                .collect();
            let done: Vec<Computed> = numbers.into_iter().flatten().collect();
            if let Some(store) = &mut self.store {
                let lasting = done.iter().filter(|one| one.is_lasting);
                let new = lasting.map(|one| {
                    let numbers = one.numbers.iter().map(|known| (*known).into());
                    (one.key, numbers.collect())
                });
                store.append(new).map_err(Interrupted::Store)?;
            }
            self.computed += done.len() as u64;
            let is_whole = done.len() == part.len();
            self.known
                .extend(done.into_iter().map(|one| (one.key, one.numbers)));
            so_far += part.len();
            if let Some((stage, ..)) = asked.first() {
                (self.progress)(*stage, so_far, missing.len());
            }
            if !is_whole {
                return Err(Interrupted::Stopped);
            }
        }
        Ok(())
    }
}

/// Numbers of one parameter set.
struct Computed {
    key: PointDigest,
    numbers: Vec<Known>,
    /// Results of a study file that cannot be read, or of a panic, are computed again by the next run.
    is_lasting: bool,
}

/// The study of a parameter set, and the key of its numbers.
fn read(
    problem: &MatchProblem,
    (stage, unit, is_refined): &Asked<'_>,
) -> (PointDigest, Result<Study, StudyErrors>) {
    let study = problem.study_of(*stage, unit);
    let mut hasher = blake3::Hasher::new();
    let mut add = |text: &str| {
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    };
    add("opshock match 2");
    let levels = match is_refined {
        true => "every level finer",
        false => "false",
    };
    add(&format!(
        "{PHYSICS_STRUCTURE} {PHYSICS_HEAD} {} {levels}",
        stage.as_str()
    ));
    match &study {
        Ok(study) => add(&study.digest_hex()),
        Err(refused) => add(&refused.to_string()),
    }
    for one in problem.observations.iter() {
        match one.stage == *stage {
            true => add(&words(&one.quantity)),
            false => add(""),
        }
    }
    (PointDigest(*hasher.finalize().as_bytes()), study)
}

/// A set that the study refuses has no numbers, nor one whose simulation panics.
fn compute(problem: &MatchProblem, printed: &dyn Printed, asked: &Asked<'_>) -> Computed {
    let (key, study) = read(problem, asked);
    let (stage, _, is_refined) = *asked;
    let numbers = study.ok().and_then(|study| {
        let call = || outputs::numbers(problem, printed, &study, stage, is_refined);
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(call)).ok()
    });
    Computed {
        key,
        is_lasting: numbers.is_some(),
        numbers: numbers.unwrap_or_else(|| outputs::missing(problem, stage)),
    }
}

/// Text that identifies a quantity.
fn words(quantity: &Quantity) -> String {
    let shock = |shock: &ShockChoice| format!("{shock:?}");
    match quantity {
        Quantity::Run {
            shock: of,
            path,
            equals,
        } => format!("run {} {path:?} {equals:?}", shock(of)),
        Quantity::History {
            shock: of,
            column,
            measured,
            measure,
        } => {
            let bits: Vec<u64> = measured
                .iter()
                .flat_map(|(t, v)| [t.to_bits(), v.to_bits()])
                .collect();
            format!("history {} {column} {measure:?} {bits:x?}", shock(of))
        }
        Quantity::Modes(path) => format!("modes {path:?}"),
        Quantity::Steady(path) => format!("steady {path:?}"),
        Quantity::Critical(of) => format!("critical {}", shock(of)),
        Quantity::Statement { id, .. } => format!("statement {id}"),
        Quantity::Combined(..) => "combined".to_owned(),
    }
}

/// As the journal keeps it: not computed, no number, or a number.
impl From<Known> for Option<Option<f64>> {
    fn from(known: Known) -> Self {
        match known {
            Known::NotAsked => None,
            Known::Missing => Some(None),
            Known::Is(value) => Some(Some(value)),
        }
    }
}

impl From<Option<Option<f64>>> for Known {
    fn from(kept: Option<Option<f64>>) -> Self {
        match kept {
            None => Known::NotAsked,
            Some(None) => Known::Missing,
            Some(Some(value)) => Known::Is(value),
        }
    }
}
