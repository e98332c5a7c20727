//! Simulates the pairs of a study: every tolerance at its two values, for every point.

use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::discretisation::{Discretisation, Levels};
use rayon::prelude::*;

use super::pair::{Bracket, End, FINENESS, Pair, Shaken, find};
use crate::population::{Interrupted, Tolerances};
use crate::provenance::{PHYSICS_HEAD, PHYSICS_STRUCTURE};
use crate::search::{AmplitudeGrid, Probe, Verdict};
use crate::store::summary::Status;
use crate::store::{NumberStore, Numbers, PointDigest, StoreError};
use crate::study::{Point, Study};
use crate::sweep::{
    Ending, Physics, ProgressKind, Simulator as _, StopFlag, SweepInput, SweepOptions, sweep,
};

/// Cumulative probabilities of the two values: one standard deviation of a normal distribution either way.
pub const ENDS: [f64; 2] = [0.158_655_253_931_457, 0.841_344_746_068_543];

/// Pairs to be simulated.
pub struct Worth<'a> {
    nominal: &'a Study,
    /// By tolerance, at both values.
    ends: &'a [[Study; 2]],
    physics: Vec<[Physics; 2]>,
}

/// Amplitudes from which critical shocks are sought, G: by tolerance, value, and point in the order of tables. A point without one
/// has no pair.
pub type Starts = Vec<[Vec<Option<f64>>; 2]>;

/// Opens or makes the store of pairs in `folder`.
///
/// # Errors
/// As [`NumberStore::open`].
pub fn open_store(folder: &Path, tolerances: &Tolerances) -> Result<NumberStore, StoreError> {
    let (name, path, text) = (&tolerances.name, &tolerances.path, &tolerances.text);
    NumberStore::open(folder, "worth 1", name, path, text)
}

/// The amplitude grid of all pairs.
pub(super) fn grid() -> AmplitudeGrid {
    AmplitudeGrid::for_tolerance(FINENESS).expect("a tolerance of a grid")
}

impl<'a> Worth<'a> {
    /// Of a study, and of its studies at both values of every tolerance ([`Tolerances::studies_at`]); what they have in common
    /// is built once.
    pub fn new(nominal: &'a Study, ends: &'a [[Study; 2]]) -> Self {
        let own = Physics::of(nominal);
        let of_study = |study: &Study| Physics::of(study).sharing(&own);
        let physics = ends.iter().map(|ends| ends.each_ref().map(of_study));
        Self {
            nominal,
            ends,
            physics: physics.collect(),
        }
    }

    /// Critical shocks of every study, with the scan for earlier failures of any sweep; each in a store of its own in `folder`.
    ///
    /// # Errors
    /// A stop, or a store that cannot be written. What was finished is kept.
    pub fn starts(
        &self,
        folder: &Path,
        options: &SweepOptions,
        progress: ProgressKind,
    ) -> Result<Starts, Interrupted> {
        let one = |tolerance: usize, end: usize| {
            let study = &self.ends[tolerance][end];
            // The command has checked the amplitudes of the study itself.
            let input = SweepInput::of(study).map_err(|_| Interrupted::Stopped)?;
            let name = format!("{}-{}", tolerance + 1, ["low", "high"][end]);
            let physics = &self.physics[tolerance][end];
            let progress = progress.start(&name);
            let swept = sweep(
                &input,
                physics,
                &folder.join(&name),
                options,
                progress.as_ref(),
            );
            let swept = swept.map_err(Interrupted::Store)?;
            if swept.ending != Ending::Complete {
                return Err(Interrupted::Stopped);
            }
            let rows = swept.summary.points.into_iter();
            Ok(rows
                .map(|row| row.survived_g.filter(|_| row.status == Status::Ok))
                .collect())
        };
        (0..self.ends.len())
            .map(|tolerance| Ok([one(tolerance, 0)?, one(tolerance, 1)?]))
            .collect()
    }

    /// The pairs by tolerance and point; those that the store lacks are simulated by the threads of `pool`.
    /// `progress` is told how many of how many are there.
    ///
    /// # Errors
    /// A stop, or a store that cannot be written. What was finished is kept.
    pub fn simulate(
        &self,
        starts: &Starts,
        store: &mut NumberStore,
        pool: &rayon::ThreadPool,
        stop: &StopFlag,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Vec<Vec<Pair>>, Interrupted> {
        let n_points = self.nominal.points.len();
        let tasks: Vec<(usize, usize)> = (0..self.ends.len())
            .flat_map(|tolerance| (0..n_points).map(move |point| (tolerance, point)))
            .collect();
        let known = &store.known.clone();
        let is_over = &AtomicBool::new(false);
        let (sender, receiver) = crossbeam_channel::unbounded();
        let (mut pairs, mut failure) = (HashMap::new(), None);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                let one = |sender: &mut crossbeam_channel::Sender<_>, task: &(usize, usize)| {
                    if !is_over.load(Ordering::Relaxed) && !stop.is_asked() {
                        let found = self.pair(*task, &starts[task.0], known, stop);
                        // The receiver goes only when all is over.
                        let _ = sender.send((*task, found));
                    }
                };
                pool.install(|| tasks.par_iter().with_max_len(1).for_each_with(sender, one));
            });
            for (task, found) in receiver {
                match found.and_then(|(pair, new)| {
                    store.append(new).map_err(Interrupted::Store)?;
                    Ok(pair)
                }) {
                    Ok(pair) => {
                        pairs.insert(task, pair);
                        progress(pairs.len() as u64, tasks.len() as u64);
                    }
                    Err(why) => {
                        is_over.store(true, Ordering::Relaxed);
                        failure.get_or_insert(why);
                    }
                }
            }
        });
        if let Some(why) = failure {
            return Err(why);
        }
        let row = |tolerance| {
            let points = (0..n_points).map(|point| pairs.get(&(tolerance, point)).copied());
            points.collect::<Option<Vec<Pair>>>()
        };
        let rows = (0..self.ends.len()).map(row).collect::<Option<_>>();
        rows.ok_or(Interrupted::Stopped)
    }

    /// A pair, and its record if it is new.
    fn pair(
        &self,
        (tolerance, place): (usize, usize),
        starts: &[Vec<Option<f64>>; 2],
        known: &HashMap<PointDigest, Numbers>,
        stop: &StopFlag,
    ) -> Result<(Pair, Option<(PointDigest, Numbers)>), Interrupted> {
        let [Some(low_g), Some(high_g)] = starts.each_ref().map(|of_points| of_points[place])
        else {
            return Ok((Pair::default(), None));
        };
        let points = self.ends[tolerance].each_ref().map(|study| {
            let order = study.table_order();
            &study.points[order[place]]
        });
        let starts = [low_g, high_g].map(|start_g| grid().nearest(start_g));
        let key = key(self.nominal, points, starts);
        if let Some(pair) = known.get(&key).and_then(decode) {
            return Ok((pair, None));
        }
        let mut simulated = Simulated {
            physics: &self.physics[tolerance],
            place,
            sign: points[0].sign.factor(),
            has_mesh: points[0].remeshed.is_some(),
            stop,
        };
        let pair = find(&mut simulated, starts)?;
        Ok((pair, Some((key, encode(&pair)))))
    }
}

/// A pair that is simulated.
struct Simulated<'a> {
    physics: &'a [Physics; 2],
    place: usize,
    sign: f64,
    has_mesh: bool,
    stop: &'a StopFlag,
}

impl Shaken for Simulated<'_> {
    type Interrupted = Interrupted;

    fn survives(
        &mut self,
        end: End,
        is_coarser: bool,
        step: i32,
    ) -> Result<Option<bool>, Interrupted> {
        if self.stop.is_asked() {
            return Err(Interrupted::Stopped);
        }
        let mesh = Some(Discretisation::RampMesh).filter(|_| self.has_mesh);
        let mut levels = Levels::NONE;
        if is_coarser {
            for one in Discretisation::ALL.into_iter().chain(mesh) {
                levels = levels.changed(one, -1);
            }
        }
        let probe = Probe {
            levels,
            ..Probe::at(step)
        };
        let amplitude = self.sign * m_per_s2_from_g(grid().amplitude_g(step));
        let physics = &self.physics[usize::from(end == End::High)];
        let run = || physics.simulate(self.place, probe, amplitude);
        let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(run));
        Ok(result.ok().and_then(|result| match result.verdict {
            Verdict::Survives => Some(true),
            Verdict::Fails { .. } => Some(false),
            Verdict::Undecided { .. } => None,
        }))
    }
}

/// Content of everything that a pair depends on.
fn key(nominal: &Study, points: [&Point; 2], starts: [i32; 2]) -> PointDigest {
    let mut hasher = blake3::Hasher::new();
    let versions = format!("opshock worth 1 {PHYSICS_STRUCTURE} {PHYSICS_HEAD} {starts:?}");
    hasher.update(versions.as_bytes());
    // Effects and outputs of the study.
    hasher.update(&nominal.digest);
    points.iter().for_each(|point| {
        hasher.update(&point.id.0);
    });
    PointDigest(*hasher.finalize().as_bytes())
}

fn encode(pair: &Pair) -> Numbers {
    let all = [pair.low, pair.high, pair.coarser_low, pair.coarser_high];
    let steps = all.iter().flat_map(|bracket| {
        let steps = bracket.map(|bracket| [bracket.survives, bracket.fails].map(f64::from));
        [steps.map(|steps| steps[0]), steps.map(|steps| steps[1])]
    });
    steps.map(Some).collect()
}

fn decode(numbers: &Numbers) -> Option<Pair> {
    let steps: Option<Vec<Option<f64>>> = numbers.iter().copied().collect();
    let steps = steps.filter(|steps| steps.len() == 8)?;
    let bracket = |place: usize| {
        let [survives, fails] = [steps[2 * place]?, steps[2 * place + 1]?].map(|step| step as i32);
        Some(Bracket { survives, fails })
    };
    Some(Pair {
        low: bracket(0),
        high: bracket(1),
        coarser_low: bracket(2),
        coarser_high: bracket(3),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_pairs_come_back_as_they_were() {
        let bracket = |survives| {
            Some(Bracket {
                survives,
                fails: survives + 1,
            })
        };
        for coarser_high in [None, bracket(-7)] {
            let pair = Pair {
                low: bracket(3),
                high: bracket(80),
                coarser_low: bracket(0),
                coarser_high,
            };
            assert_eq!(decode(&encode(&pair)), Some(pair));
        }
    }
}
