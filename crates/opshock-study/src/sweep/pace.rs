//! Time of the simulations of a sweep on this machine: the modelled one (`run_time`), corrected by what the store has
//! measured, of each kind of run and, where the kind is new, of all kinds of a ramp model.

use std::collections::{BTreeMap, BTreeSet};

use super::input::{PointFilm, SweepInput};
use super::registry::{Registry, uncertainty_asked};
use super::run_time::{Kind, RunTime, of_correction, of_none};
use crate::search::{Ramp, Verdict};

/// Runs as many as which the model counts against measured ones, of a kind and of all kinds together.
const MODEL_RUNS: f64 = 2.0;
const MODEL_RUNS_OF_ALL: f64 = 8.0;
/// Measured over modelled time that counts at most.
const MOST_OVER_MODEL: f64 = 3.0;
/// Runs of a ramp model as many as which the unit by the runs of all ramp models counts.
const UNIT_RUNS: f64 = 2.0;
/// Standard deviation of the logarithm of a modelled time before anything was measured.
const MODEL_SPREAD: f64 = 0.4;
/// That of the time of a plain run, known from one, and the runs after which half of its variance is left. Both are estimates.
const PLAIN_SPREAD: f64 = 0.35;
const PLAIN_RUNS: f64 = 8.0;

/// Measured time, modelled time and number of some runs.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    measured_s: f64,
    modelled_s: f64,
    runs: f64,
}

impl Sums {
    /// Measured over modelled time, where `runs` more took `ratio` times the modelled time.
    fn ratio(self, runs: f64, ratio: f64) -> f64 {
        if self.runs == 0.0 {
            return ratio;
        }
        let more_s = runs * self.modelled_s / self.runs;
        (self.measured_s + ratio * more_s) / (self.modelled_s + more_s)
    }
}

/// Seconds of every kind of run on this machine.
#[derive(Clone, Debug, Default)]
pub(super) struct Pace {
    plain_s: BTreeMap<Ramp, f64>,
    plain_runs: BTreeMap<Ramp, f64>,
    of_kind: BTreeMap<Kind, Sums>,
    of_ramp: BTreeMap<Ramp, Sums>,
    /// Films and refinement levels at which this process has sampled defect corrections.
    corrections: BTreeSet<(usize, i8)>,
}

impl Pace {
    /// What the runs that the searches and intervals of `registry` have used took.
    pub(super) fn of(input: &SweepInput, registry: &Registry<'_>) -> Pace {
        let campaign = registry.campaign();
        let mut all: Vec<(f64, usize, RunTime, f64)> = Vec::new();
        for point in 0..input.points.len() {
            let film = input.points[point].film.number;
            let search = campaign.search(point);
            let searched = search.into_iter().flat_map(|search| search.log());
            let interval = registry.interval(point);
            let asks = interval.into_iter().flat_map(|interval| interval.log);
            let asked = asks.map(|&ask| uncertainty_asked(ask));
            for asked in searched.copied().chain(asked) {
                let key = registry.key(point, asked.probe);
                let run = registry.runs().get(&key);
                // One that was taken from another point took no time.
                if let Some(run) = run.filter(|run| run.machine.wall_s > 0.0) {
                    let fails = matches!(run.result.verdict, Verdict::Fails { .. });
                    let time = RunTime::of(input, registry, campaign, point, &asked, fails);
                    all.push((run.machine.finished_unix_s, film, time, run.machine.wall_s));
                }
            }
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        // The first run of a ramp model, or with a new defect correction, builds what the others share.
        let (mut built, mut sampled) = (BTreeSet::new(), BTreeSet::new());
        let mut corrections = BTreeSet::new();
        all.retain(|&(finished_unix_s, film, time, _)| {
            let is_first = built.insert(time.kind.ramp);
            let level = time.kind.correction();
            let samples = level.is_some_and(|level| {
                if registry.is_of_this_process(finished_unix_s) {
                    corrections.insert((film, level));
                }
                sampled.insert((film, level))
            });
            !is_first && !samples
        });
        let mut plain: BTreeMap<Ramp, Sums> = BTreeMap::new();
        for &(_, _, time, wall_s) in &all {
            if time.kind.is_plain() {
                let sums = plain.entry(time.kind.ramp).or_default();
                sums.measured_s += wall_s;
                sums.modelled_s += time.units;
                sums.runs += 1.0;
            }
        }
        let in_none = plain
            .iter()
            .fold(Sums::default(), |all, (&ramp, one)| Sums {
                measured_s: all.measured_s + one.measured_s / of_none(ramp),
                modelled_s: all.modelled_s + one.modelled_s,
                runs: all.runs + one.runs,
            });
        let none_s = in_none.ratio(0.0, 0.0);
        let mut pace = Pace {
            corrections,
            ..Pace::default()
        };
        for (&ramp, sums) in &plain {
            let of_all = none_s * of_none(ramp);
            pace.plain_s.insert(ramp, sums.ratio(UNIT_RUNS, of_all));
            pace.plain_runs.insert(ramp, sums.runs);
        }
        for (_, _, time, wall_s) in all {
            let kind = time.kind;
            let Some(plain_s) = pace.plain_s.get(&kind.ramp) else {
                continue;
            };
            let modelled_s = plain_s * time.units;
            // A run that built its scene says little of the next one.
            let wall_s = wall_s.min(MOST_OVER_MODEL * modelled_s);
            let of_kind = pace.of_kind.entry(kind).or_default();
            let of_ramp = (!kind.is_plain()).then(|| pace.of_ramp.entry(kind.ramp).or_default());
            for sums in [Some(of_kind), of_ramp].into_iter().flatten() {
                sums.measured_s += wall_s;
                sums.modelled_s += modelled_s;
                sums.runs += 1.0;
            }
        }
        pace
    }

    /// Takes `seconds` for a unit of a ramp model that was not measured yet.
    pub(super) fn set_plain(&mut self, ramp: Ramp, seconds: f64) {
        self.plain_s.entry(ramp).or_insert(seconds);
    }

    /// Seconds of a unit by ramp model.
    pub(super) fn plain_s(&self) -> &BTreeMap<Ramp, f64> {
        &self.plain_s
    }

    /// Seconds of a run; `None` before any was measured.
    pub(super) fn seconds(&self, time: RunTime) -> Option<f64> {
        let kind = time.kind;
        let plain_s = self.plain_s.get(&kind.ramp).copied().or_else(|| {
            let (ramp, seconds) = self.plain_s.first_key_value()?;
            Some(seconds * of_none(kind.ramp) / of_none(*ramp))
        })?;
        let sums = |known: Option<&Sums>| known.copied().unwrap_or_default();
        let of_all = sums(self.of_ramp.get(&kind.ramp)).ratio(MODEL_RUNS_OF_ALL, 1.0);
        let of_all = if kind.is_plain() { 1.0 } else { of_all };
        let ratio = sums(self.of_kind.get(&kind)).ratio(MODEL_RUNS, of_all);
        Some(plain_s * time.units * ratio)
    }

    /// Seconds of sampling the defect correction of a film at a level; zero where it is known.
    pub(super) fn correction_s(&self, film: PointFilm, level: i8) -> f64 {
        let kept = film.kept.get(level as usize - 1).copied();
        let is_known = kept == Some(true) || self.corrections.contains(&(film.number, level));
        let known = self.plain_s.first_key_value().filter(|_| !is_known);
        known.map_or(0.0, |(ramp, plain_s)| {
            of_correction(level, film.cells) * plain_s / of_none(*ramp)
        })
    }

    /// Standard deviation of the logarithm of the time of a plain run.
    pub(super) fn plain_spread(&self, ramp: Ramp) -> f64 {
        let runs = self.plain_runs.get(&ramp).copied().unwrap_or(0.0);
        PLAIN_SPREAD / (1.0 + runs / PLAIN_RUNS).sqrt()
    }

    /// Standard deviation of the logarithm of the time of other runs over that of a plain one.
    pub(super) fn spread(&self, ramp: Ramp) -> f64 {
        let runs = self.of_ramp.get(&ramp).map_or(0.0, |sums| sums.runs);
        MODEL_SPREAD / (1.0 + runs / MODEL_RUNS_OF_ALL).sqrt()
    }
}
