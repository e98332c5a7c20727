//! Forecast of a sweep's cost before it starts or goes on: number of simulations, time and disk space.
//!
//! What is left is made up to its end many times (`remainder`), with the study's own first touches. The time of a
//! simulation comes from a few per ramp model that are measured now, or from what the store has measured.

use std::collections::BTreeMap;
use std::time::Instant;

use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2, m_per_s2_from_g};
use serde::Serialize;

use super::guard;
use super::input::SweepInput;
use super::pace::Pace;
use super::registry::Registry;
use super::remainder::remainder;
use super::run_time::RunTime;
use super::simulator::Simulator;
use super::spread::Spread;
use crate::search::{Probe, Ramp, Touch, Verdict};
use crate::store::{Loaded, StoredTouch};
use crate::study::KeepHistories;

/// Forecast of a sweep. Times and runs are what is left to do.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Forecast {
    /// Points of the study.
    pub points: u64,
    /// Points whose answer the store has.
    pub answered: u64,
    /// Points that may be added; contained in every maximum, and in nothing else.
    #[serde(skip_serializing_if = "is_none")]
    pub added_points: u64,
    /// Finished simulations in the store that stay valid.
    pub reused_runs: u64,
    /// Simulations of the searches.
    pub search_runs: Spread,
    /// Simulations for the uncertainty intervals.
    pub uncertainty_runs: Spread,
    /// All simulations.
    pub runs: Spread,
    /// Seconds of a survivor near the critical shock of a positive pulse of 1 ms, on the scene as it is, by ramp model.
    pub seconds_per_run: BTreeMap<Ramp, f64>,
    /// Core-hours.
    pub core_h: Spread,
    /// Hours with these threads.
    pub wall_h: Spread,
    /// Core-hours of a sweep that refines no point, if this one may.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unrefined_core_h: Option<Spread>,
    /// Hours of such a sweep with these threads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unrefined_wall_h: Option<Spread>,
    /// Threads.
    pub threads: usize,
    /// Bytes of the store in the end.
    pub disk_bytes: u64,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
fn is_none(count: &u64) -> bool {
    *count == 0
}

impl Forecast {
    /// Includes `points` added ones in every maximum, at the cost of the study's own: twice the likely number of runs
    /// of a point, at the pace of a long one.
    pub fn may_add(&mut self, points: u64) {
        let open = self.points - self.answered;
        if open == 0 {
            // Everything is answered, and nothing was left to add.
            return;
        }
        self.added_points = points;
        let share = points as f64 / open as f64;
        let all = [
            &mut self.search_runs,
            &mut self.uncertainty_runs,
            &mut self.runs,
            &mut self.core_h,
            &mut self.wall_h,
        ];
        let unrefined = [&mut self.unrefined_core_h, &mut self.unrefined_wall_h];
        for spread in all.into_iter().chain(unrefined.into_iter().flatten()) {
            spread.max *= 1.0 + share;
        }
        self.disk_bytes = (self.disk_bytes as f64 * (1.0 + share)) as u64;
    }
}

/// Bytes of a simulation in the journal and in `results.h5`, and of a store without any.
const RUN_BYTES: f64 = 600.0;
const STORE_BYTES: f64 = 150e3;
/// Columns of a history.
const HISTORY_COLUMNS: f64 = 20.0;

/// Simulations that a forecast for this number of threads runs at a time: threads slow one another down, so that it measures
/// with as many, but not with more than this machine has cores.
pub fn workers(threads: usize) -> usize {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    threads.min(cores)
}

/// Forecast for sweeping `input` with the results `loaded` from its store.
///
/// `history_nodes` is the number of time steps of a kept history.
pub fn forecast(
    input: &SweepInput,
    simulator: &dyn Simulator,
    loaded: Loaded,
    threads: usize,
    history_nodes: f64,
) -> Forecast {
    let valid = |digest| input.points.iter().any(|point| point.digest == digest);
    let reused_runs = loaded.runs.keys().filter(|key| valid(key.point)).count() as u64;
    let mut registry = Registry::new(input, loaded.clone());
    registry.absorb_all();
    let touch = |point: usize| {
        let known = registry.campaign().touch(point);
        known.unwrap_or_else(|| match guard::onset(simulator, point) {
            StoredTouch::NoRamp => Touch::NoRamp,
            StoredTouch::Unknown => Touch::Unknown,
            StoredTouch::At(amplitude) => Touch::At {
                onset_g: amplitude / STANDARD_GRAVITY_M_PER_S2,
            },
        })
    };
    let touches: Vec<Touch> = (0..input.points.len()).map(touch).collect();
    let mut pace = Pace::of(input, &registry);
    for (place, point) in input.points.iter().enumerate() {
        let ramp = point.coordinates.ramp;
        if !registry.is_final(place) && !pace.plain_s().contains_key(&ramp) {
            let seconds = measured(input, simulator, place, touches[place], workers(threads));
            pace.set_plain(ramp, seconds);
        }
    }
    let left = remainder(input, &registry, &touches, &pace, threads);
    let unrefined = input.without_refinement().map(|plain| {
        let mut registry = Registry::new(&plain, loaded);
        registry.absorb_all();
        remainder(&plain, &registry, &touches, &pace, threads)
    });
    let hours = |seconds: Spread| seconds.scaled(1.0 / 3600.0);
    let answered = (0..input.points.len()).filter(|&point| registry.is_final(point));
    let histories = match input.keep_histories {
        KeepHistories::None => 0.0,
        KeepHistories::Bracket => 2.0 * input.points.len() as f64,
        KeepHistories::All => left.search_runs.max + reused_runs as f64,
    };
    let all_runs = left.runs.max + reused_runs as f64;
    let disk =
        STORE_BYTES + RUN_BYTES * all_runs + histories * history_nodes * HISTORY_COLUMNS * 8.0;
    Forecast {
        points: input.points.len() as u64,
        answered: answered.count() as u64,
        added_points: 0,
        reused_runs,
        search_runs: left.search_runs,
        uncertainty_runs: left.uncertainty_runs,
        runs: left.runs,
        seconds_per_run: pace.plain_s().clone(),
        core_h: hours(left.core_s),
        wall_h: hours(left.wall_s),
        unrefined_core_h: unrefined.as_ref().map(|left| hours(left.core_s)),
        unrefined_wall_h: unrefined.as_ref().map(|left| hours(left.wall_s)),
        threads,
        disk_bytes: disk as u64,
    }
}

/// Time of a unit, by two survivors of a point half an octave apart, of which the higher lies next to a failure. All workers
/// simulate them at the same time. The very first simulation builds what the others share and is not measured.
fn measured(
    input: &SweepInput,
    simulator: &dyn Simulator,
    point: usize,
    touch: Touch,
    workers: usize,
) -> f64 {
    /// Amplitude over that of first touch from which the failure is sought.
    const OVER_TOUCH: f64 = 1.4;
    let (grid, range) = (&input.settings.grid, input.settings.range);
    let from = match touch {
        Touch::At { onset_g } => grid.nearest(OVER_TOUCH * onset_g),
        Touch::NoRamp | Touch::Unknown => range.low + (range.high - range.low) / 2,
    };
    let sign = input.points[point].coordinates.sign.factor();
    let run = |grid_point: i32| {
        let amplitude = sign * m_per_s2_from_g(grid.amplitude_g(grid_point));
        let one = || guard::simulate(simulator, point, Probe::at(grid_point), amplitude);
        let began = Instant::now();
        let result = std::thread::scope(|scope| {
            for _ in 1..workers {
                scope.spawn(one);
            }
            one()
        });
        let seconds = began.elapsed().as_secs_f64();
        (seconds, result.verdict == Verdict::Survives)
    };
    let half_octave = (grid.steps_per_octave / 2).max(1);
    let mut grid_point = from.clamp(range.low, range.high);
    run(grid_point);
    grid_point = (grid_point - 1).max(range.low);
    let (mut seconds, mut survives) = run(grid_point);
    let upwards = survives;
    // The last survivor and the one before.
    let mut survivors = [(grid_point, seconds); 2];
    let step = if upwards { half_octave } else { -half_octave };
    while survives == upwards && (range.low..=range.high).contains(&(grid_point + step)) {
        grid_point += step;
        (seconds, survives) = run(grid_point);
        if survives {
            survivors = [survivors[1], (grid_point, seconds)];
        }
    }
    if !upwards {
        let below = (grid_point - half_octave).max(range.low);
        survivors = [(grid_point, seconds), (below, run(below).0)];
    }
    let onset_g = touch.onset_g().unwrap_or(0.0);
    let highest = survivors[0].0.max(survivors[1].0);
    let units = survivors.map(|(grid_point, _)| {
        // The critical amplitude lies a quarter of an octave above the highest survivor on average.
        let octaves = 0.25 + f64::from(highest - grid_point) / f64::from(grid.steps_per_octave);
        let run = RunTime::survivor(&input.points[point], Probe::at(grid_point));
        run.at(grid.amplitude_g(grid_point), onset_g, octaves).units
    });
    survivors.iter().map(|(_, seconds)| seconds).sum::<f64>() / units.iter().sum::<f64>()
}
