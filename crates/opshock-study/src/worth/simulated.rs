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
use crate::store::{NumberStore, Numbers, PointDigest, StoreError};
use crate::study::{Point, Study};
use crate::sweep::{Physics, Simulator as _, StopFlag};

/// Cumulative probabilities of the two values: one standard deviation of a normal distribution either way.
pub const ENDS: [f64; 2] = [0.158_655_253_931_457, 0.841_344_746_068_543];

/// Pairs to be simulated.
pub struct Worth<'a> {
    /// The tolerances, each with its studies at both values.
    pub ends: &'a [[Study; 2]],
    /// The study itself: what the pairs have in common with it is built once.
    pub nominal: &'a Study,
    /// Amplitudes from which critical shocks are sought, by point in the order of tables, G; without one a point has no pair.
    pub starts_g: &'a [Option<f64>],
}

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

impl Worth<'_> {
    /// The pairs by tolerance and point; those that the store lacks are simulated by the threads of `pool`.
    /// `progress` is told how many of how many are there.
    ///
    /// # Errors
    /// A stop, or a store that cannot be written. What was finished is kept.
    pub fn simulate(
        &self,
        store: &mut NumberStore,
        pool: &rayon::ThreadPool,
        stop: &StopFlag,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Vec<Vec<Pair>>, Interrupted> {
        let nominal = Physics::of(self.nominal);
        let physics: Vec<[Physics; 2]> = self
            .ends
            .iter()
            .map(|ends| {
                ends.each_ref()
                    .map(|study| Physics::of(study).sharing(&nominal))
            })
            .collect();
        let n_points = self.starts_g.len();
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
                        let found = self.pair(*task, &physics[task.0], known, stop);
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
        physics: &[Physics; 2],
        known: &HashMap<PointDigest, Numbers>,
        stop: &StopFlag,
    ) -> Result<(Pair, Option<(PointDigest, Numbers)>), Interrupted> {
        let Some(start_g) = self.starts_g[place] else {
            return Ok((Pair::default(), None));
        };
        let points = self.ends[tolerance].each_ref().map(|study| {
            let order = study.table_order();
            &study.points[order[place]]
        });
        let start = grid().nearest(start_g);
        let key = key(self.nominal, points, start);
        if let Some(pair) = known.get(&key).and_then(decode) {
            return Ok((pair, None));
        }
        let mut simulated = Simulated {
            physics,
            place,
            sign: points[0].sign.factor(),
            has_mesh: points[0].remeshed.is_some(),
            stop,
        };
        let pair = find(&mut simulated, start)?;
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
fn key(nominal: &Study, points: [&Point; 2], start: i32) -> PointDigest {
    let mut hasher = blake3::Hasher::new();
    let versions = format!("opshock worth 1 {PHYSICS_STRUCTURE} {PHYSICS_HEAD} {start}");
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
