//! Forecast of a sweep's cost before it starts: number of simulations, time and disk space.
//!
//! The number of simulations comes from the search itself, run on some tens of made-up tables of
//! failure with the study's own first touches, a fixed seed each. The time of one comes from one
//! simulation per ramp model, or from what the store has measured.

use std::collections::BTreeMap;
use std::time::Instant;

use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2, m_per_s2_from_g};
use serde::Serialize;

use super::guard;
use super::input::SweepInput;
use super::registry::Registry;
use super::simulator::Simulator;
use crate::search::{Campaign, Coordinates, Probe, Ramp, Sign, Touch, Verdict};
use crate::store::{Loaded, StoredTouch};
use crate::study::KeepHistories;

/// An estimate with its range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Lower end.
    pub min: f64,
    /// Expected.
    pub likely: f64,
    /// Upper end.
    pub max: f64,
}

impl Spread {
    fn times(self, factor: Spread) -> Spread {
        Spread {
            min: self.min * factor.min,
            likely: self.likely * factor.likely,
            max: self.max * factor.max,
        }
    }

    fn plus(self, other: Spread) -> Spread {
        Spread {
            min: self.min + other.min,
            likely: self.likely + other.likely,
            max: self.max + other.max,
        }
    }

    fn scaled(self, factor: f64) -> Spread {
        self.times(Spread {
            min: factor,
            likely: factor,
            max: factor,
        })
    }
}

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
    /// Seconds of one simulation by ramp model.
    pub seconds_per_run: BTreeMap<Ramp, f64>,
    /// Core-hours.
    pub core_h: Spread,
    /// Hours with these threads.
    pub wall_h: Spread,
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
        for spread in [
            &mut self.search_runs,
            &mut self.uncertainty_runs,
            &mut self.runs,
            &mut self.core_h,
            &mut self.wall_h,
        ] {
            spread.max *= 1.0 + share;
        }
        self.disk_bytes = (self.disk_bytes as f64 * (1.0 + share)) as u64;
    }
}

/// Made-up tables.
const SAMPLES: u64 = 40;
/// Simulations of an uncertainty interval for each discretisation parameter: on the committed table of Fig. 13 an
/// interval took 11 to 70 with six discretisation parameters, 37 in the mean.
const PER_DISCRETISATION: Spread = Spread {
    min: 2.0,
    likely: 6.0,
    max: 12.0,
};
/// Time of a simulation relative to the one measured: shorter when it fails early, longer near the answer, with refined
/// parameters or in a doubled window.
const PACE: Spread = Spread {
    min: 0.5,
    likely: 1.0,
    max: 2.0,
};
/// Share of the threads' time spent simulating.
const CORE_USE: f64 = 0.95;
/// Bytes of a simulation in the journal and in `results.h5`, and of a store without any.
const RUN_BYTES: f64 = 600.0;
const STORE_BYTES: f64 = 150e3;
/// Columns of a history.
const HISTORY_COLUMNS: f64 = 20.0;

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
    let touches: Vec<Touch> = (0..input.points.len())
        .map(|point| match guard::onset(simulator, point) {
            StoredTouch::NoRamp => Touch::NoRamp,
            StoredTouch::Unknown => Touch::Unknown,
            StoredTouch::At(amplitude) => Touch::At {
                onset_g: amplitude / STANDARD_GRAVITY_M_PER_S2,
            },
        })
        .collect();
    let seconds_per_run = pace(input, simulator, &touches, &loaded);

    let valid = |digest| input.points.iter().any(|point| point.digest == digest);
    let reused_runs = loaded.runs.keys().filter(|key| valid(key.point)).count() as u64;
    let mut registry = Registry::new(input, loaded);
    registry.absorb_all();
    let open: Vec<bool> = (0..input.points.len())
        .map(|point| !registry.is_final(point))
        .collect();

    let mut samples: Vec<(f64, Vec<f64>)> = (0..SAMPLES)
        .map(|sample| {
            let runs = made_up(input, &touches, sample);
            let left = runs
                .iter()
                .zip(&open)
                .map(|(&n, &open)| if open { n } else { 0.0 });
            let left: Vec<f64> = left.collect();
            (left.iter().sum(), left)
        })
        .collect();
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let at = |share: f64| &samples[((SAMPLES - 1) as f64 * share).round() as usize];
    let search_runs = Spread {
        min: at(0.05).0,
        likely: at(0.5).0,
        max: at(0.95).0,
    };
    let discretisations = |point: usize| {
        input.points[point]
            .uncertainty
            .as_ref()
            .map_or(0, |uncertainty| uncertainty.discretisations.len())
    };
    let is_open = |point: &usize| open[*point];
    let all_discretisations: usize = (0..open.len()).filter(is_open).map(discretisations).sum();
    let uncertainty_runs = PER_DISCRETISATION.scaled(all_discretisations as f64);

    // Seconds: every point at the pace of its ramp model.
    let pace_of = |point: usize| {
        let ramp = &input.points[point].coordinates.ramp;
        seconds_per_run.get(ramp).copied().unwrap_or(0.0)
    };
    let (searched, weighted_parameters) =
        (0..open.len())
            .filter(is_open)
            .fold((0.0, 0.0), |sum, point| {
                let s = pace_of(point);
                (
                    sum.0 + s * at(0.5).1[point],
                    sum.1 + s * discretisations(point) as f64,
                )
            });
    let per_likely = if search_runs.likely > 0.0 {
        searched / search_runs.likely
    } else {
        0.0
    };
    let seconds = search_runs
        .scaled(per_likely)
        .plus(PER_DISCRETISATION.scaled(weighted_parameters))
        .times(PACE);
    let runs = search_runs.plus(uncertainty_runs);
    let histories = match input.keep_histories {
        KeepHistories::None => 0.0,
        KeepHistories::Bracket => 2.0 * input.points.len() as f64,
        KeepHistories::All => search_runs.max,
    };
    let all_runs = runs.max + reused_runs as f64;
    let disk =
        STORE_BYTES + RUN_BYTES * all_runs + histories * history_nodes * HISTORY_COLUMNS * 8.0;
    Forecast {
        points: input.points.len() as u64,
        answered: open.iter().filter(|open| !**open).count() as u64,
        added_points: 0,
        reused_runs,
        search_runs,
        uncertainty_runs,
        runs,
        seconds_per_run,
        core_h: seconds.scaled(1.0 / 3600.0),
        wall_h: seconds.scaled(1.0 / (3600.0 * CORE_USE * threads as f64)),
        threads,
        disk_bytes: disk as u64,
    }
}

/// Seconds of a simulation by ramp model, stored ones or one made now.
fn pace(
    input: &SweepInput,
    simulator: &dyn Simulator,
    touches: &[Touch],
    loaded: &Loaded,
) -> BTreeMap<Ramp, f64> {
    let mut pace: BTreeMap<Ramp, f64> = BTreeMap::new();
    for (place, point) in input.points.iter().enumerate() {
        let ramp = &point.coordinates.ramp;
        if pace.contains_key(ramp) {
            continue;
        }
        let same = |digest| {
            let of_ramp = |other: &&super::input::SweepPoint| other.coordinates.ramp == *ramp;
            input
                .points
                .iter()
                .filter(of_ramp)
                .any(|other| other.digest == digest)
        };
        let stored = loaded.runs.values().filter(|run| same(run.key.point));
        let (sum, count) = stored.fold((0.0, 0.0), |(sum, count), run| {
            (sum + run.machine.wall_s, count + 1.0)
        });
        let seconds = if count > 0.0 {
            sum / count
        } else {
            measured(input, simulator, place, touches[place])
        };
        pace.insert(*ramp, seconds);
    }
    pace
}

/// Time of one simulation of a point, a little above first touch or in the middle of the range. The first builds shared
/// models, so a second is measured.
fn measured(input: &SweepInput, simulator: &dyn Simulator, point: usize, touch: Touch) -> f64 {
    let settings = &input.settings;
    let guess_g = match touch {
        Touch::At { onset_g } => 1.03 * onset_g,
        Touch::NoRamp | Touch::Unknown => {
            let nodes = settings.range;
            settings
                .grid
                .amplitude_g(nodes.low + (nodes.high - nodes.low) / 2)
        }
    };
    let node = settings
        .grid
        .nearest(guess_g)
        .clamp(settings.range.low, settings.range.high);
    let sign = input.points[point].coordinates.sign.factor();
    let run = |node: i32| {
        let amplitude = sign * m_per_s2_from_g(settings.grid.amplitude_g(node));
        guard::simulate(simulator, point, Probe::at(node), amplitude);
    };
    run(node);
    let began = Instant::now();
    run(node - 1);
    began.elapsed().as_secs_f64()
}

/// Simulations of each point's search on a made-up table.
fn made_up(input: &SweepInput, touches: &[Touch], sample: u64) -> Vec<f64> {
    let settings = input.settings;
    let coordinates: Vec<Coordinates> = input
        .points
        .iter()
        .map(|point| point.coordinates.clone())
        .collect();
    let mut campaign = Campaign::new(settings, &coordinates);
    for (point, &touch) in touches.iter().enumerate() {
        campaign.set_touch(point, touch);
    }
    let law = Law::of(input, touches, sample);
    while !campaign.is_done() {
        for (point, at) in coordinates.iter().enumerate() {
            while let Some(asked) = campaign.ask(point) {
                let amplitude_g = settings.grid.amplitude_g(asked.probe.index);
                let fails = law.fails(at, touches[point], amplitude_g);
                let verdict = if fails {
                    Verdict::Fails {
                        t_fail_s: 0.0,
                        x_m: 0.0,
                        y_m: 0.0,
                    }
                } else {
                    Verdict::Survives
                };
                campaign.tell(point, &verdict);
            }
        }
    }
    (0..coordinates.len())
        .map(|point| campaign.findings(point).runs as f64)
        .collect()
}

/// A made-up table: without ramp a power law of the width; with one, between first touch and that.
struct Law {
    none_g: f64,
    slope: f64,
    /// Factor of negative shocks.
    minus: f64,
    /// Place between first touch and the answer without ramp, rigid and deformable, and how it
    /// changes with the width.
    place: [f64; 2],
    drift: f64,
    /// A non-monotone interval as shares of the amplitude that fails.
    window: Option<(f64, f64)>,
}

impl Law {
    fn of(input: &SweepInput, touches: &[Touch], sample: u64) -> Law {
        let mut state = sample;
        let mut share = || {
            // splitmix64
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        };
        let grid = input.settings.grid;
        let highest_g = grid.amplitude_g(input.settings.range.high);
        let touch_g = |touch: &Touch| match touch {
            Touch::At { onset_g } => *onset_g,
            Touch::NoRamp | Touch::Unknown => 0.0,
        };
        let lowest_g = touches
            .iter()
            .map(touch_g)
            .fold(grid.amplitude_g(input.settings.range.low), f64::max)
            .min(highest_g);
        Law {
            none_g: lowest_g * (highest_g / lowest_g).powf(0.7 * share()),
            slope: 0.6 * (share() - 0.5),
            minus: 0.7 + 0.6 * share(),
            place: [0.4 * share(), share()],
            drift: 0.3 * share(),
            window: (share() < 0.25).then(|| {
                let low = 0.7 + 0.25 * share();
                (low, low * (1.02 + 0.1 * share()))
            }),
        }
    }

    fn fails(&self, at: &Coordinates, touch: Touch, amplitude_g: f64) -> bool {
        let sign = if at.sign == Sign::Plus {
            1.0
        } else {
            self.minus
        };
        let none_g = self.none_g * sign * at.pulse_ms.powf(self.slope);
        let (Touch::At { onset_g }, false) = (touch, at.ramp == Ramp::None) else {
            return amplitude_g >= none_g;
        };
        let place = self.place[usize::from(at.ramp == Ramp::Deformable)];
        let place = (place + self.drift * at.pulse_ms.ln()).clamp(0.02, 0.95);
        let critical_g = onset_g * (none_g / onset_g).max(1.0).powf(place);
        let is_in = |(low, high): (f64, f64)| {
            (low * critical_g..high * critical_g).contains(&amplitude_g) && amplitude_g > onset_g
        };
        amplitude_g >= critical_g.min(none_g) || self.window.is_some_and(is_in)
    }
}
