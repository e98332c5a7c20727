//! Simulates the pairs of a study: every tolerance at its two values, for every point.

use std::path::Path;

use opshock_solver::quantity::m_per_s2_from_g;

use super::pair::{Bracket, End, FINENESS, LEVELS, Pair, Shaken, find};
use crate::population::{Interrupted, Nominal};
use crate::provenance::{PHYSICS_HEAD, PHYSICS_STRUCTURE};
use crate::search::{AmplitudeGrid, Probe, Verdict};
use crate::store::summary::Status;
use crate::store::{Known, NumberStore, Numbers, PointDigest};
use crate::study::{Point, RemeshedRamp, Study};
use crate::sweep::{
    Ending, Physics, ProgressKind, Simulator as _, SweepInput, SweepOptions, Until, sweep,
};

/// Cumulative probabilities of the two values: one standard deviation of a normal distribution either way.
pub const ENDS: [f64; 2] = [0.158_655_253_931_457, 0.841_344_746_068_543];

/// A change is refined until its half-width is the study's target uncertainty of a critical shock over this.
const NARROWER: f64 = 3.0;

/// Pairs to be simulated.
pub struct Worth<'a> {
    nominal: &'a Study,
    shared: Nominal<'a>,
    /// By tolerance, at both values.
    ends: &'a [[Study; 2]],
}

/// Brackets within which critical shocks are sought, G: by tolerance, value, and point in the order of tables. A point without
/// one has no pair.
pub type Starts = Vec<[Vec<Option<[f64; 2]>>; 2]>;

/// Stores of pairs, with their format.
pub const STORE: &str = "worth 1";

/// The amplitude grid of all pairs.
pub(super) fn grid() -> AmplitudeGrid {
    AmplitudeGrid::for_tolerance(FINENESS).expect("a tolerance of a grid")
}

impl<'a> Worth<'a> {
    /// Of a study, and of its studies at both values of every tolerance ([`crate::population::Tolerances::studies_at`]).
    pub fn new(nominal: &'a Study, ends: &'a [[Study; 2]]) -> Self {
        Self {
            nominal,
            shared: Nominal::of(nominal),
            ends,
        }
    }

    /// Brackets of every study, with the scan for earlier failures of any sweep; each in a store of its own in `folder`.
    ///
    /// # Errors
    /// A stop, or a store that cannot be written. What was finished is kept.
    pub fn starts(
        &self,
        folder: &Path,
        threads: usize,
        until: &Until,
        progress: ProgressKind,
    ) -> Result<Starts, Interrupted> {
        let one = |tolerance: usize, end: usize| {
            let study = &self.ends[tolerance][end];
            // The command has checked the amplitudes of the study itself.
            let input = SweepInput::of(study).map_err(|_| Interrupted::Stopped)?;
            let name = format!("{}-{}", tolerance + 1, ["low", "high"][end]);
            let progress = progress.start(&name);
            let options = SweepOptions {
                stop: until.stop.clone(),
                budget: until.left(),
                ..SweepOptions::with_threads(threads)
            };
            let swept = sweep(
                &input,
                &self.shared.shared_by(study),
                &folder.join(&name),
                &options,
                progress.as_ref(),
            )?;
            if swept.ending != Ending::Complete {
                return Err(Interrupted::Stopped);
            }
            let rows = swept.summary.points.into_iter();
            Ok(rows
                .map(|row| row.bracket_g().filter(|_| row.status == Status::Ok))
                .collect())
        };
        (0..self.ends.len())
            .map(|tolerance| Ok([one(tolerance, 0)?, one(tolerance, 1)?]))
            .collect()
    }

    /// The pairs by tolerance and point; those that the store lacks are simulated by `threads`. `progress` gets how many of how
    /// many are there.
    ///
    /// # Errors
    /// A stop, or a store that cannot be written. What was finished is kept.
    pub fn simulate(
        &self,
        starts: &Starts,
        store: &mut NumberStore,
        threads: usize,
        until: &Until,
        mut progress: impl FnMut(usize, usize),
    ) -> Result<Vec<Vec<Pair>>, Interrupted> {
        let n_points = self.nominal.points.len();
        let n = self.ends.len() * n_points;
        let pairs = store.answers(
            n,
            threads,
            |task, known| {
                let (tolerance, place) = (task / n_points, task % n_points);
                match self.pair(tolerance, place, &starts[tolerance], known, until) {
                    Ok((pair, new)) => (Ok(pair), new.into_iter().collect()),
                    Err(why) => (Err(why), Vec::new()),
                }
            },
            |done| progress(done, n),
        )?;
        Ok(pairs.chunks(n_points).map(<[Pair]>::to_vec).collect())
    }

    /// A pair, and its record if it is new.
    fn pair(
        &self,
        tolerance: usize,
        place: usize,
        starts: &[Vec<Option<[f64; 2]>>; 2],
        known: &Known,
        until: &Until,
    ) -> Result<(Pair, Option<(PointDigest, Numbers)>), Interrupted> {
        let [Some(low_g), Some(high_g)] = starts.each_ref().map(|of_points| of_points[place])
        else {
            return Ok((Pair::default(), None));
        };
        let points = self.ends[tolerance].each_ref().map(|study| {
            let order = study.table_order();
            &study.points[order[place]]
        });
        let starts = [low_g, high_g].map(|[survived_g, failed_g]| {
            let survives = grid().nearest(survived_g);
            let fails = grid().nearest(failed_g).max(survives + 1);
            Bracket { survives, fails }
        });
        let target = points[0].target_uncertainty / NARROWER;
        let most_finer = self.nominal.search.max_refinements as usize;
        let key = key(self.nominal, points, starts);
        if let Some(pair) = known.get(&key).and_then(decode) {
            return Ok((pair, None));
        }
        let physics = self.ends[tolerance].each_ref();
        let physics = physics.map(|study| self.shared.shared_by(study));
        let mut simulated = Simulated {
            physics: &physics,
            shared: &self.shared,
            place,
            point: points[0],
            until,
        };
        let amplitude_g = |step: i32| grid().amplitude_g(step);
        let is_narrow = |pair: &Pair| {
            let change = pair.change_g(&amplitude_g);
            let least_g = pair.critical_g(&amplitude_g).into_iter().flatten();
            let least_g = least_g.fold(f64::INFINITY, f64::min);
            change.is_some_and(|[_, half_g]| half_g <= target * least_g)
        };
        let pair = find(&mut simulated, starts, most_finer, &is_narrow)?;
        Ok((pair, Some((key, encode(&pair)))))
    }
}

/// A pair that is simulated.
struct Simulated<'a> {
    physics: &'a [Physics; 2],
    shared: &'a Nominal<'a>,
    place: usize,
    /// At the lower value; at the higher one it has the same sign and the same discretisation parameters.
    point: &'a Point,
    until: &'a Until,
}

impl Shaken for Simulated<'_> {
    type Interrupted = Interrupted;

    fn survives(&mut self, end: End, refined: i8, step: i32) -> Result<Option<bool>, Interrupted> {
        if self.until.is_over() {
            return Err(Interrupted::Stopped);
        }
        let probe = Probe {
            levels: self.point.levels(refined),
            ..Probe::at(step)
        };
        let amplitude = self.point.sign.factor() * m_per_s2_from_g(grid().amplitude_g(step));
        let physics = &self.physics[usize::from(end == End::High)];
        if refined > 0 {
            physics.take_films(self.shared.finer());
        }
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
fn key(nominal: &Study, points: [&Point; 2], starts: [Bracket; 2]) -> PointDigest {
    let mut hasher = blake3::Hasher::new();
    let versions = format!("opshock worth 3 {PHYSICS_STRUCTURE} {PHYSICS_HEAD} {starts:?}");
    hasher.update(versions.as_bytes());
    // Effects and outputs of the study.
    hasher.update(&nominal.digest);
    for point in points {
        hasher.update(&point.id.0);
        let remeshed = point.remeshed.as_ref().map(RemeshedRamp::content);
        hasher.update(remeshed.unwrap_or_default().as_bytes());
    }
    PointDigest(*hasher.finalize().as_bytes())
}

fn encode(pair: &Pair) -> Numbers {
    let brackets = pair.0.iter().flatten();
    let steps = brackets.flat_map(|bracket| {
        let steps = bracket.map(|bracket| [bracket.survives, bracket.fails].map(f64::from));
        [steps.map(|steps| steps[0]), steps.map(|steps| steps[1])]
    });
    steps.map(Some).collect()
}

fn decode(numbers: &Numbers) -> Option<Pair> {
    let steps: Option<Vec<Option<f64>>> = numbers.iter().copied().collect();
    let steps = steps.filter(|steps| steps.len() == 4 * LEVELS)?;
    let mut pair = Pair::default();
    for (bracket, steps) in pair.0.iter_mut().flatten().zip(steps.chunks(2)) {
        *bracket = steps[0].zip(steps[1]).map(|(survives, fails)| Bracket {
            survives: survives as i32,
            fails: fails as i32,
        });
    }
    Some(pair)
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
        for finer in [None, bracket(-7)] {
            let pair = Pair([
                [bracket(3), bracket(80)],
                [bracket(0), bracket(70)],
                [bracket(1), finer],
                [None, finer],
            ]);
            assert_eq!(decode(&encode(&pair)), Some(pair));
        }
    }
}
