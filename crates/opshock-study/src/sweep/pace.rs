//! Time that a simulation takes, by what it is made for.
//!
//! A plain run of the search is the unit, per ramp model. A run with changed refinement levels takes
//!
//! ```text
//! t / t_plain = h F(film) T(head) + s 2.2^structure
//! ```
//!
//! | symbol | meaning | value |
//! |---|---|---|
//! | h, s | shares of the head and of disk and ramp in a plain run | 1, 0 without ramp; 0.9, 0.1 with one |
//! | F | factor of a film of half, quarter, eighth of the cells, or of twice and four times as many | 0.42, 0.18, 0.13; 2.45, 6 |
//! | T | factor of a level of the head's tolerances | 2.2 finer, 0.75 coarser |
//!
//! times 0.6 since many of them fail early. A run in a doubled window takes 1.5 plain runs without ramp, 0.7 with one;
//! a quasi-static film 1.2 of those without ramp, one of 2⁻ⁿ of the cells 0.6 × 2⁻ⁿ; a plain run with a ramp 2.4 of those without. The factors are rounded means of four sweeps: two studies of Fig. 13, a default
//! drive and one at the preset coarse; 0.6 was chosen so that forecasts of these sweeps hold. What the store
//! measures replaces it: the ratio of measured to modelled time of each kind of run, and of all kinds of a ramp model
//! where the kind is new.

use std::collections::BTreeMap;

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::input::SweepInput;
use super::registry::{Registry, uncertainty_asked};
use crate::search::{Probe, Ramp};

/// A kind of run: all that its time is modelled from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Kind {
    /// Ramp model.
    pub(super) ramp: Ramp,
    /// Refinement levels.
    pub(super) levels: Levels,
    /// Multiple of the study's window.
    pub(super) window_factor: u8,
}

impl Kind {
    /// The kind of a probe.
    pub(super) fn of(ramp: Ramp, probe: &Probe) -> Kind {
        Kind {
            ramp,
            levels: probe.levels,
            window_factor: probe.window_factor,
        }
    }

    fn plain(ramp: Ramp) -> Kind {
        Kind {
            ramp,
            levels: Levels::NONE,
            window_factor: 1,
        }
    }

    /// Its time in plain runs of the ramp model.
    fn relative(self) -> f64 {
        let (head, structure) = match self.ramp {
            Ramp::None => (1.0, 0.0),
            Ramp::Rigid | Ramp::Deformable => (0.9, 0.1),
        };
        let level = |discretisation| i32::from(self.levels.of(discretisation));
        match level(Discretisation::QuasiStaticFilm) {
            // A film at rest, extrapolated from twice the cells, or one of fewer cells.
            1.. => return 1.2 * head / self.of_none(),
            steps @ ..=-1 => return 0.6 * head / self.of_none() * 0.5_f64.powi(-steps),
            0 => {}
        }
        if self.window_factor > 1 {
            return if self.ramp == Ramp::None { 1.5 } else { 0.7 };
        }
        let film = match level(Discretisation::FilmGrid) {
            ..=-3 => 0.13,
            -2 => 0.18,
            -1 => 0.42,
            finer => 2.45_f64.powi(finer),
        };
        let tolerance = match level(Discretisation::HeadTolerance) {
            ..=-1 => 0.75,
            finer => 2.2_f64.powi(finer),
        };
        let time = head * film * tolerance
            + structure * 2.2_f64.powi(level(Discretisation::StructureStep));
        if self.levels.is_none() {
            time
        } else {
            MANY_FAIL * time
        }
    }

    /// A plain run of the ramp model in plain runs without ramp.
    fn of_none(self) -> f64 {
        match self.ramp {
            Ramp::None => 1.0,
            Ramp::Rigid | Ramp::Deformable => 2.4,
        }
    }
}

/// Time of runs of changed scenes, many of which fail early, over that of survivors.
const MANY_FAIL: f64 = 0.6;

/// Runs as many as which the model counts against measured ones, of a kind and of all kinds together.
const MODEL_RUNS: f64 = 2.0;
const MODEL_RUNS_OF_ALL: f64 = 8.0;
/// Standard deviation of the logarithm of a modelled time before anything was measured.
const MODEL_SPREAD: f64 = 0.2;
/// That of the time of a plain run, known from one, and the runs after which half of its variance is left.
const PLAIN_SPREAD: f64 = 0.25;
const PLAIN_RUNS: f64 = 4.0;

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
}

impl Pace {
    /// What the runs that the searches and intervals of `registry` have used took.
    pub(super) fn of(input: &SweepInput, registry: &Registry<'_>) -> Pace {
        let mut all: Vec<(Kind, f64)> = Vec::new();
        for (point, one) in input.points.iter().enumerate() {
            let search = registry.campaign().search(point);
            let searched = search.into_iter().flat_map(|search| search.log());
            let interval = registry.interval(point);
            let asks = interval.into_iter().flat_map(|interval| interval.log);
            let asked = asks.map(|&ask| uncertainty_asked(ask));
            for asked in searched.copied().chain(asked) {
                let key = registry.key(point, asked.probe);
                if let Some(run) = registry.runs().get(&key) {
                    let kind = Kind::of(one.coordinates.ramp, &asked.probe);
                    all.push((kind, run.machine.wall_s));
                }
            }
        }
        let mut plain: BTreeMap<Ramp, Sums> = BTreeMap::new();
        for &(kind, wall_s) in &all {
            if kind == Kind::plain(kind.ramp) {
                let sums = plain.entry(kind.ramp).or_default();
                sums.measured_s += wall_s;
                sums.runs += 1.0;
            }
        }
        let mut pace = Pace::default();
        for (&ramp, sums) in &plain {
            pace.plain_s.insert(ramp, sums.measured_s / sums.runs);
            pace.plain_runs.insert(ramp, sums.runs);
        }
        for (kind, wall_s) in all {
            let Some(plain_s) = pace.plain_s.get(&kind.ramp) else {
                continue;
            };
            let modelled_s = plain_s * kind.relative();
            let is_plain = kind == Kind::plain(kind.ramp);
            let of_kind = pace.of_kind.entry(kind).or_default();
            let of_ramp = (!is_plain).then(|| pace.of_ramp.entry(kind.ramp).or_default());
            for sums in [Some(of_kind), of_ramp].into_iter().flatten() {
                sums.measured_s += wall_s;
                sums.modelled_s += modelled_s;
                sums.runs += 1.0;
            }
        }
        pace
    }

    /// Takes `seconds` for a plain run of a ramp model that was not measured yet.
    pub(super) fn set_plain(&mut self, ramp: Ramp, seconds: f64) {
        self.plain_s.entry(ramp).or_insert(seconds);
    }

    /// Seconds of a plain run by ramp model.
    pub(super) fn plain_s(&self) -> &BTreeMap<Ramp, f64> {
        &self.plain_s
    }

    /// Seconds of a run; `None` before any was measured.
    pub(super) fn seconds(&self, kind: Kind) -> Option<f64> {
        let plain_s = self.plain_s.get(&kind.ramp).copied().or_else(|| {
            let (ramp, seconds) = self.plain_s.first_key_value()?;
            let known = Kind::plain(*ramp);
            Some(seconds * kind.of_none() / known.of_none())
        })?;
        let sums = |known: Option<&Sums>| known.copied().unwrap_or_default();
        let of_all = sums(self.of_ramp.get(&kind.ramp)).ratio(MODEL_RUNS_OF_ALL, 1.0);
        let of_all = if kind == Kind::plain(kind.ramp) {
            1.0
        } else {
            of_all
        };
        let ratio = sums(self.of_kind.get(&kind)).ratio(MODEL_RUNS, of_all);
        Some(plain_s * kind.relative() * ratio)
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
