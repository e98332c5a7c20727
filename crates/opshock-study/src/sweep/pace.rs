//! Time that a simulation takes, by what it is made for.
//!
//! The unit is a run on the scene as it is that a search requests for its bracket and that survives, per ramp model.
//! Another run takes
//!
//! ```text
//! t / t_unit = V (h F(film) T(head) + s 2.2^structure)
//! ```
//!
//! | symbol | meaning | value |
//! |---|---|---|
//! | h, s | shares of the head and of disk and ramp | 0.87, 0 without ramp; 0.78, 0.09 with one |
//! | F | factor of a film of half, quarter, eighth of the cells, or of 2^n as many | 0.75, 0.34, 0.28; 2.6^n |
//! | T | factor of 2^n times finer tolerances of the head, or of coarser ones | 1.8^n; 0.8 |
//! | V | factor of a failure, which ends early | 0.22 without ramp, 0.35 with one; 1 for survivors |
//!
//! A run of the scan below the bracket takes 0.65 units, since low amplitudes take few steps; a failure on the scene as it
//! is 0.22 without ramp, 0.47 with one. A quasi-static film takes 0.9 units of those without ramp, one of 2^-n of the cells
//! 0.45 x 2^-n; a unit with a ramp is 2.1 of those without. The factors are rounded medians
//! or means of 23 to 28 sweeps, twenty of them small studies at the presets coarse and standard, the others Fig. 13, its
//! variants and a choice of five clearances. What the store measures replaces them: the ratio of
//! measured to modelled time of each kind of run, and of all kinds of a ramp model where the kind is new.

use std::collections::{BTreeMap, BTreeSet};

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::input::SweepInput;
use super::registry::{Registry, uncertainty_asked};
use crate::search::{Asked, Purpose, Ramp, Verdict};

/// A kind of run: all that its time is modelled from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Kind {
    /// Ramp model.
    pub(super) ramp: Ramp,
    /// Refinement levels.
    pub(super) levels: Levels,
    /// Multiple of the study's window.
    pub(super) window_factor: u8,
    /// It is of a search's scan below the bracket.
    pub(super) scans: bool,
    /// It ends by a failure.
    pub(super) fails: bool,
}

impl Kind {
    /// The kind of a requested run that fails or survives.
    pub(super) fn of(ramp: Ramp, asked: &Asked, fails: bool) -> Kind {
        Kind {
            ramp,
            levels: asked.probe.levels,
            window_factor: asked.probe.window_factor,
            scans: asked.purpose == Purpose::Scan,
            fails,
        }
    }

    /// A run of the search on the scene as it is.
    fn is_plain(self) -> bool {
        self.levels.is_none() && self.window_factor == 1
    }

    /// Its time in units of the ramp model.
    fn relative(self) -> f64 {
        let has_ramp = self.ramp != Ramp::None;
        if self.is_plain() {
            return match (self.fails, has_ramp) {
                (true, false) => 0.22,
                (true, true) => 0.47,
                (false, _) if self.scans => 0.65,
                (false, _) => 1.0,
            };
        }
        let (head, structure) = if has_ramp { (0.78, 0.09) } else { (0.87, 0.0) };
        let level = |discretisation| i32::from(self.levels.of(discretisation));
        match level(Discretisation::QuasiStaticFilm) {
            // A film at rest, extrapolated from twice the cells, or one of fewer cells.
            1.. => return 0.9 / of_none(self.ramp),
            steps @ ..=-1 => return 0.45 / of_none(self.ramp) * 0.5_f64.powi(-steps),
            0 => {}
        }
        let film = match level(Discretisation::FilmGrid) {
            ..=-3 => 0.28,
            -2 => 0.34,
            -1 => 0.75,
            finer => 2.6_f64.powi(finer),
        };
        let tolerance = match level(Discretisation::HeadTolerance) {
            ..=-1 => 0.8,
            finer => 1.8_f64.powi(finer),
        };
        let time = head * film * tolerance
            + structure * 2.2_f64.powi(level(Discretisation::StructureStep));
        match (self.fails, has_ramp) {
            (true, false) => 0.22 * time,
            (true, true) => 0.35 * time,
            (false, _) => time,
        }
    }
}

/// A unit of the ramp model in those without ramp.
fn of_none(ramp: Ramp) -> f64 {
    match ramp {
        Ramp::None => 1.0,
        Ramp::Rigid | Ramp::Deformable => 2.1,
    }
}

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
        let mut all: Vec<(f64, Kind, f64)> = Vec::new();
        for (point, one) in input.points.iter().enumerate() {
            let search = registry.campaign().search(point);
            let searched = search.into_iter().flat_map(|search| search.log());
            let interval = registry.interval(point);
            let asks = interval.into_iter().flat_map(|interval| interval.log);
            let asked = asks.map(|&ask| uncertainty_asked(ask));
            for asked in searched.copied().chain(asked) {
                let key = registry.key(point, asked.probe);
                if let Some(run) = registry.runs().get(&key) {
                    let fails = matches!(run.result.verdict, Verdict::Fails { .. });
                    let kind = Kind::of(one.coordinates.ramp, &asked, fails);
                    all.push((run.machine.finished_unix_s, kind, run.machine.wall_s));
                }
            }
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        // The first run of a ramp model builds what the others share.
        let mut built = BTreeSet::new();
        all.retain(|(_, kind, _)| !built.insert(kind.ramp));
        let mut plain: BTreeMap<Ramp, Sums> = BTreeMap::new();
        for &(_, kind, wall_s) in &all {
            if kind.is_plain() {
                let sums = plain.entry(kind.ramp).or_default();
                sums.measured_s += wall_s;
                sums.modelled_s += kind.relative();
                sums.runs += 1.0;
            }
        }
        let mut pace = Pace::default();
        for (&ramp, sums) in &plain {
            pace.plain_s.insert(ramp, sums.measured_s / sums.modelled_s);
            pace.plain_runs.insert(ramp, sums.runs);
        }
        for (_, kind, wall_s) in all {
            let Some(plain_s) = pace.plain_s.get(&kind.ramp) else {
                continue;
            };
            let modelled_s = plain_s * kind.relative();
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
    pub(super) fn seconds(&self, kind: Kind) -> Option<f64> {
        let plain_s = self.plain_s.get(&kind.ramp).copied().or_else(|| {
            let (ramp, seconds) = self.plain_s.first_key_value()?;
            Some(seconds * of_none(kind.ramp) / of_none(*ramp))
        })?;
        let sums = |known: Option<&Sums>| known.copied().unwrap_or_default();
        let of_all = sums(self.of_ramp.get(&kind.ramp)).ratio(MODEL_RUNS_OF_ALL, 1.0);
        let of_all = if kind.is_plain() { 1.0 } else { of_all };
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
