//! Studies to which a sweep adds widths, with critical shocks that are known: two power laws that cross,
//! one of them with a kink, and uncertainties for which points are refined.

use std::path::Path;
use std::time::{Duration, Instant};

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_solver::scene::discretisation::{Discretisation, Levels};
use opshock_study::search::{Probe, ProbeResult, RunCost, Verdict};
use opshock_study::store::Summary;
use opshock_study::study::{Ramp, SetArg, Study};
use opshock_study::sweep::rounds::{self, Next};
use opshock_study::sweep::{
    Ending, Onset, Progress, Silent, Simulator, SweepInput, SweepOptions, sweep,
};

use crate::tables::failure;

/// Kink of the deformable ramp's curve, ms.
pub const KINK_MS: f64 = 0.8;

/// Share by which the film's grid, as the study has it, moves the rigid ramp's answers where error
/// intervals are asked for; halved by twice the cells.
pub const GRID_ERROR: f64 = 0.02;

/// Critical shocks in G: two power laws that meet at 1.66 ms, one of them with a kink.
pub fn critical_g(ramp: Ramp, pulse_ms: f64) -> f64 {
    match ramp {
        Ramp::None => 900.0,
        Ramp::Rigid => 300.0 * pulse_ms.powf(-0.5),
        Ramp::Deformable => {
            let at_kink = 200.0 * KINK_MS.powf(0.3);
            let slope = if pulse_ms < KINK_MS { -0.9 } else { 0.3 };
            at_kink * (pulse_ms / KINK_MS).powf(slope)
        }
    }
}

/// Where the power laws meet, ms, the rigid ramp's being higher by a factor.
pub fn crossing_ms(rigid_factor: f64) -> f64 {
    (1.5 * rigid_factor).powf(1.25)
}

/// Answers by the laws.
pub struct Law {
    points: Vec<(Ramp, f64)>,
    /// The film's grid moves answers.
    has_grid_error: bool,
    /// Time each run takes.
    pub sleep: Duration,
}

impl Law {
    /// The laws over a study's points.
    pub fn of(study: &Study) -> Law {
        let order = study.table_order().into_iter();
        let points = order.map(|place| &study.points[place]);
        Law {
            points: points.map(|point| (point.ramp, point.pulse_ms)).collect(),
            has_grid_error: study.search.uncertainty,
            sleep: Duration::ZERO,
        }
    }

    fn critical_g(&self, point: usize, levels: Levels) -> f64 {
        let (ramp, pulse_ms) = self.points[point];
        let is_moved = self.has_grid_error && ramp == Ramp::Rigid;
        let halvings = -f64::from(levels.of(Discretisation::FilmGrid));
        let error = if is_moved {
            GRID_ERROR * halvings.exp2()
        } else {
            0.0
        };
        critical_g(ramp, pulse_ms) * (1.0 + error)
    }
}

impl Simulator for Law {
    fn simulate(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> ProbeResult {
        std::thread::sleep(self.sleep);
        let amplitude_g = amplitude_m_per_s2.abs() / STANDARD_GRAVITY_M_PER_S2;
        let fails = amplitude_g >= self.critical_g(point, probe.levels);
        ProbeResult {
            verdict: if fails { failure() } else { Verdict::Survives },
            h_min_m: (!fails).then_some(1e-9),
            t_min_s: (!fails).then_some(1e-3),
            cost: RunCost {
                steps: amplitude_g as u64,
                ..RunCost::default()
            },
        }
    }

    fn onset(&self, point: usize) -> Onset {
        match self.points[point].0 {
            Ramp::None => Onset::NoRamp,
            Ramp::Rigid | Ramp::Deformable => Onset::At {
                amplitude_m_per_s2: 100.0 * STANDARD_GRAVITY_M_PER_S2,
            },
        }
    }
}

/// Three widths, three ramp models, positive shocks, no uncertainty intervals; and what else is set.
///
/// # Panics
/// When a setting is none.
pub fn study(more: &[&str]) -> Study {
    let sets = [
        "pulse.widths_ms=[0.5, 1.0, 3.0]",
        "pulse.signs=[\"+\"]",
        "ramp.models=[\"none\", \"rigid\", \"deformable\"]",
        "search.uncertainty=false",
        "search.added_points.closest_pct=1.0",
        "output.keep_histories=\"none\"",
    ];
    let sets: Vec<SetArg> = sets
        .iter()
        .filter(|set| {
            let key = |set: &str| set.split_once('=').map(|(key, _)| key.to_owned());
            !more.iter().any(|other| key(other) == key(set))
        })
        .chain(more)
        .map(|set| set.parse().expect("a set argument"))
        .collect();
    Study::from_text(&Study::example("refined"), &sets).expect("a study")
}

/// The study that is refined to 3 % and crossings of 4 %.
pub fn refined_study() -> Study {
    study(&[
        "search.added_points.tolerance_pct=3",
        "search.added_points.crossing_pct=4",
    ])
}

/// Sweeps round by round as the program does, at most `rounds` of them: the study of the last round
/// and its table, of which a shard that is left alone knows a part.
///
/// # Panics
/// When a sweep does not end, or a store cannot be read.
pub fn sweep_rounds(
    study: &Study,
    store: &Path,
    options: &SweepOptions,
    rounds: u32,
) -> (Study, Summary) {
    let sleep = Duration::ZERO;
    sweep_reported(study, store, options, rounds, sleep, |_| Box::new(Silent))
}

/// As [`sweep_rounds`], each simulation taking a while and reported to the progress of its round.
///
/// # Panics
/// As there.
pub fn sweep_reported(
    study: &Study,
    store: &Path,
    options: &SweepOptions,
    rounds: u32,
    sleep: Duration,
    progress: impl Fn(&SweepInput) -> Box<dyn Progress>,
) -> (Study, Summary) {
    let mut study =
        rounds::first(study, store, options.shard.as_ref()).expect("stores and a range");
    loop {
        let input = SweepInput::of(&study).expect("input");
        let law = Law {
            sleep,
            ..Law::of(&study)
        };
        let end = sweep(&input, &law, store, options, progress(&input).as_ref()).expect("sweeps");
        assert_eq!(end.ending, Ending::Complete);
        let round = study.points.iter().map(|point| point.round).max();
        let next = rounds::next(&study, store, options, &end.summary, Instant::now());
        match next.expect("stores and a range") {
            Next::Round(next) if round.expect("points") + 1 < rounds => study = *next,
            _ => return (study, end.summary),
        }
    }
}
