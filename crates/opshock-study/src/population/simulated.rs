//! Simulates the drives of a population: the verdict on each of their points, kept in the store by content.
//!
//! A point's answer depends on its scene, the settings of the search and the required amplitude alone, so that the
//! number of threads, the order and a kill change nothing, and shards of a population merge into the whole.

use std::cell::LazyCell;
use std::path::{Path, PathBuf};

use opshock_solver::quantity::m_per_s2_from_g;

use super::answer::DriveAnswer;
use super::level::{DecidedBy, Level, LevelAnswer, Levels, amplitude_g, judge};
use super::nominal::Nominal;
use super::tolerances::Tolerances;
use crate::provenance::{PHYSICS_HEAD, PHYSICS_STRUCTURE};
use crate::qualification::{PointVerdict, Requirement, Spec, Verdict};
use crate::search::{Probe, Verdict as Outcome};
use crate::store::{Known, NumberStore, Numbers, PointDigest, StoreError};
use crate::study::{Point, SetArg, Study, StudyErrors};
use crate::sweep::{
    Ending, Physics, Silent, Simulator as _, SweepInput, SweepOptions, Until, sweep,
};

/// A population to be simulated.
#[derive(Clone, Copy)]
pub struct Population<'a> {
    /// What is drawn.
    pub tolerances: &'a Tolerances,
    /// Specification file.
    pub spec: &'a Path,
    /// Study file.
    pub study: &'a Path,
    /// The requirements without tolerances.
    pub nominal: &'a [Nominal<'a>],
}

/// One of so many parts of a population: drives `number - 1`, `number - 1 + of`, and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Number, from 1.
    pub number: u64,
    /// Parts in all.
    pub of: u64,
}

/// Why there is no answer.
#[derive(Debug)]
pub enum Interrupted {
    /// A stop was requested, or the time is over.
    Stopped,
    /// The store could not be written.
    Store(StoreError),
    /// The study refuses a drive, by number from 1 and values.
    Refused(u64, String, StudyErrors),
}

impl From<StoreError> for Interrupted {
    fn from(error: StoreError) -> Self {
        Self::Store(error)
    }
}

/// Stores of populations, with their format.
pub const STORE: &str = "population 1";

/// A drive as it is simulated: its requirements, each with a study.
struct Drive {
    index: u64,
    requirements: Vec<Requirement>,
}

impl Population<'_> {
    fn drive(&self, index: u64) -> Result<Drive, Interrupted> {
        let drawn = self.tolerances.draw(index);
        let sets: Vec<SetArg> = self.tolerances.arguments(&drawn);
        match Spec::requirements_from_path(self.spec, self.study, &sets) {
            Ok(requirements) => Ok(Drive {
                index,
                requirements,
            }),
            Err(errors) => {
                let values = self.tolerances.values(&drawn).into_iter();
                let values: Vec<String> = values
                    .map(|(key, text)| format!("{key}={}", text.unwrap_or_else(|| "absent".into())))
                    .collect();
                Err(Interrupted::Refused(index + 1, values.join(" "), errors))
            }
        }
    }

    fn is_bracketed(&self, index: u64) -> bool {
        index < self.tolerances.fragility_drives
    }

    /// Answers of the drives of `part`, or of all, in their order: those that the store lacks are simulated by `threads`.
    /// `progress` gets how many of how many are there.
    ///
    /// # Errors
    /// A stop, a drive that the study refuses, a store that cannot be written. What was finished is kept.
    pub fn simulate(
        &self,
        store: &mut NumberStore,
        part: Part,
        threads: usize,
        until: &Until,
        mut progress: impl FnMut(usize, usize),
    ) -> Result<Vec<DriveAnswer>, Interrupted> {
        let indices: Vec<u64> = (part.number - 1..self.tolerances.drives)
            .step_by(part.of as usize)
            .collect();
        let folder = store.folder.join("intervals");
        let answer = |task: usize, known: &Known| {
            let mut new = Vec::new();
            let answer = self.answer(indices[task], known, &folder, until, &mut new);
            (answer, new)
        };
        let answers = store.answers(indices.len(), threads, answer, |done| {
            progress(done, indices.len());
        })?;
        // All of their verdicts are kept.
        let _ = std::fs::remove_dir_all(&folder);
        Ok(answers)
    }

    /// Answers of a drive; `new` gets those that are.
    fn answer(
        &self,
        index: u64,
        known: &Known,
        folder: &Path,
        until: &Until,
        new: &mut Vec<(PointDigest, Numbers)>,
    ) -> Result<DriveAnswer, Interrupted> {
        let drive = self.drive(index)?;
        let is_bracketed = self.is_bracketed(drive.index);
        let mut requirements = Vec::new();
        for (requirement, nominal) in drive.requirements.iter().zip(self.nominal) {
            let order = requirement.study.table_order();
            let physics = LazyCell::new(|| nominal.shared_by(&requirement.study));
            let mut points = Vec::new();
            for (place, &point) in order.iter().enumerate() {
                let key = key(requirement, &requirement.study.points[point], is_bracketed);
                if let Some(answer) = known.get(&key).and_then(decode) {
                    points.push(answer);
                    continue;
                }
                let mut simulated = Simulated {
                    requirement,
                    point: &requirement.study.points[point],
                    place,
                    physics: &physics,
                    nominal,
                    // Drives of equal content must not wait for one another.
                    folder: folder.join(format!("{}-{}", index + 1, &key.hex()[..16])),
                    until,
                };
                let answer = judge(&mut simulated, is_bracketed)?;
                new.push((key, encode(&answer)));
                points.push(answer);
            }
            requirements.push(points);
        }
        Ok(DriveAnswer {
            index,
            requirements,
        })
    }
}

/// A point that is simulated.
struct Simulated<'a> {
    requirement: &'a Requirement,
    point: &'a Point,
    place: usize,
    physics: &'a Physics,
    nominal: &'a Nominal<'a>,
    /// Folder of the store of its uncertainty interval.
    folder: PathBuf,
    until: &'a Until,
}

impl Levels for Simulated<'_> {
    type Interrupted = Interrupted;

    fn shock(&mut self, step: i32, refined: i8) -> Result<Level, Interrupted> {
        if self.until.is_over() {
            return Err(Interrupted::Stopped);
        }
        let amplitude_g = amplitude_g(self.requirement.required_g(), step);
        let amplitude = self.point.sign.factor() * m_per_s2_from_g(amplitude_g);
        if refined > 0 {
            self.physics.take_films(self.nominal.finer());
        }
        let probe = Probe {
            levels: self.point.levels(refined),
            ..Probe::at(step)
        };
        let run = || self.physics.simulate(self.place, probe, amplitude);
        let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(run));
        Ok(match result {
            Ok(result) => match result.verdict {
                Outcome::Survives => Level::Survives(result.h_min_m),
                Outcome::Fails { .. } => Level::Fails,
                Outcome::Undecided { .. } => Level::Undecided,
            },
            Err(_) => Level::Undecided,
        })
    }

    fn failure_m(&self) -> f64 {
        self.point.scene.fail_below_m
    }

    fn interval(&mut self) -> Result<Verdict, Interrupted> {
        let mut study: Study = self.requirement.study.clone();
        study.points = vec![self.point.clone()];
        let Ok(input) = SweepInput::of(&study) else {
            return Ok(Verdict::Undecided);
        };
        let options = SweepOptions {
            stop: self.until.stop.clone(),
            budget: self.until.left(),
            ..SweepOptions::with_threads(1)
        };
        let physics = self.nominal.shared_by(&study);
        let end = sweep(&input, &physics, &self.folder, &options, &Silent)?;
        if end.ending != Ending::Complete {
            return Err(Interrupted::Stopped);
        }
        let verdict = |row| PointVerdict::of(row, self.requirement.required_g()).verdict;
        Ok(end
            .summary
            .points
            .first()
            .map_or(Verdict::Undecided, verdict))
    }
}

/// Content of everything that a point's answer depends on.
fn key(requirement: &Requirement, point: &Point, is_bracketed: bool) -> PointDigest {
    let mut hasher = blake3::Hasher::new();
    hasher.update(b"opshock population 2");
    let versions = format!("{PHYSICS_STRUCTURE} {PHYSICS_HEAD} {is_bracketed}");
    hasher.update(versions.as_bytes());
    hasher.update(&requirement.study.digest);
    hasher.update(&point.id.0);
    hasher.update(&requirement.required_g().to_bits().to_le_bytes());
    PointDigest(*hasher.finalize().as_bytes())
}

fn encode(answer: &LevelAnswer) -> Numbers {
    let verdict = match answer.verdict {
        Verdict::Fails => 0.0,
        Verdict::Undecided => 1.0,
        Verdict::Passes => 2.0,
    };
    vec![
        Some(Some(verdict)),
        Some(Some(match answer.by {
            DecidedBy::Shocks => 0.0,
            DecidedBy::Interval => 1.0,
            DecidedBy::FinerShock => 2.0,
        })),
        Some(answer.survives.map(f64::from)),
        Some(answer.fails.map(f64::from)),
        Some(answer.clearance_m),
    ]
}

fn decode(numbers: &Numbers) -> Option<LevelAnswer> {
    let [
        Some(Some(verdict)),
        Some(Some(by)),
        Some(survives),
        Some(fails),
        Some(clearance_m),
    ] = numbers[..]
    else {
        return None;
    };
    let verdicts = [Verdict::Fails, Verdict::Undecided, Verdict::Passes];
    let decided = [
        DecidedBy::Shocks,
        DecidedBy::Interval,
        DecidedBy::FinerShock,
    ];
    Some(LevelAnswer {
        verdict: *verdicts.get(verdict as usize)?,
        by: *decided.get(by as usize)?,
        survives: survives.map(|step| step as i32),
        fails: fails.map(|step| step as i32),
        clearance_m,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_answers_come_back_as_they_were() {
        for verdict in [Verdict::Fails, Verdict::Undecided, Verdict::Passes] {
            for (survives, fails) in [(None, Some(-16)), (Some(3), Some(4)), (Some(2), None)] {
                let answer = LevelAnswer {
                    verdict,
                    by: match fails {
                        None => DecidedBy::Interval,
                        Some(4) => DecidedBy::FinerShock,
                        _ => DecidedBy::Shocks,
                    },
                    survives,
                    fails,
                    clearance_m: survives.map(|step| 1e-9 / f64::from(step)),
                };
                assert_eq!(decode(&encode(&answer)), Some(answer));
            }
        }
        assert_eq!(decode(&vec![Some(Some(1.0))]), None);
    }
}
