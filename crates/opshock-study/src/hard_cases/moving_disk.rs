//! Hard cases C of the head over a disk that moves suddenly: touch, suction, lift-off and return.

use super::check::{Check, largest};
use super::naive;
use super::scenes::heads::{SuddenDisk, default_film, default_head, default_resolution};
use opshock_solver::air_bearing::Attitude;
use opshock_solver::air_bearing::steady::fixed_attitude;
use opshock_solver::disk::{DiskMotion, DiskPose};
use opshock_solver::head::{HeadRun, HeadWorkspace, ShockLoad, Verdict};
use opshock_solver::quantity::GRAM_FORCE_N;
use opshock_solver::shock::{Pulse, PulseShape};
use std::f64::consts::TAU;

const PULSE: Pulse = Pulse {
    shape: PulseShape::HalfSine,
    width_s: 2e-3,
};

fn sudden(velocity_m_per_s: f64, window_s: f64) -> HeadRun {
    moving(&SuddenDisk { velocity_m_per_s }, window_s)
}

fn moving(disk: &dyn DiskMotion, window_s: f64) -> HeadRun {
    let model = default_head(300, &default_resolution());
    let load = ShockLoad {
        base: None,
        pulse: &PULSE,
        amplitude_m_per_s2: 0.0,
    };
    let mut workspace = HeadWorkspace::new(&model);
    model.run(disk, &load, window_s, true, true, &mut workspace)
}

pub(super) fn c6() -> Vec<Check> {
    // Ten metres a second through 10 nm in a nanosecond: every first iterate lies below the disk.
    let run = sudden(10.0, 1e-6);
    let (fails, t_fail_s) = match run.verdict {
        Verdict::Fails { t_fail_s, .. } => (true, t_fail_s),
        _ => (false, f64::NAN),
    };
    vec![
        Check::none("other verdicts than touch", usize::from(!fails)).against(
            "free-molecular flow at the first iterate, 10 nm - 10 m/s x 2 ns: not a number",
            f64::from(u8::from(
                naive::film::free_molecular_flow((10e-9 - 10.0 * 2e-9) / 63.5e-9).is_nan(),
            )),
        ),
        Check::new("clearance at touch, m", run.min_clearance_m.abs(), 1e-15),
        Check::new(
            "touch later than a slider left behind is hit, s",
            t_fail_s - 1.1e-9,
            1e-9,
        ),
        Check::new(
            "smallest pressure below zero, Pa",
            -run.cost.min_pressure_pa,
            0.0,
        ),
    ]
}

pub(super) fn c7() -> Vec<Check> {
    let run = sudden(-1.0, 1e-5);
    let columns = run.columns.as_ref().expect("recorded");
    let pull = largest(columns.bearing_force_n.iter().map(|f| -f));
    let area = 0.85e-3 * 0.70e-3;
    let strip = naive::film::incompressible_suction(1.8e-5, 1.0, 0.70e-3, 10e-9);
    vec![
        Check::new(
            "smallest pressure below zero, Pa",
            -run.cost.min_pressure_pa,
            0.0,
        )
        .against(
            "incompressible strip of 0.7 mm at 10 nm",
            -(101_325.0 + strip),
        ),
        Check::new(
            "pull of the film, of ambient pressure x area",
            pull / (101_325.0 * area),
            1.0,
        ),
        Check::new(
            "mass not accounted for by a step, of the film's",
            run.cost.mass_balance_error,
            1e-2,
        ),
        Check::none(
            "verdicts other than survival",
            usize::from(run.verdict != Verdict::Survives),
        ),
    ]
}

/// How far [`AwayAndBack`] goes, m.
const AWAY_M: f64 = 4e-5;

/// A disk that leaves the slider and comes back within 0.1 ms.
struct AwayAndBack;

impl DiskMotion for AwayAndBack {
    fn pose(&self, t: f64) -> DiskPose {
        let phase = TAU * 1e4 * t.clamp(0.0, 1e-4);
        DiskPose {
            displacement_m: -0.5 * AWAY_M * (1.0 - phase.cos()),
            ..DiskPose::default()
        }
    }
    fn pose_rate(&self, t: f64) -> DiskPose {
        let phase = TAU * 1e4 * t.clamp(0.0, 1e-4);
        DiskPose {
            displacement_m: -0.5 * AWAY_M * TAU * 1e4 * phase.sin(),
            ..DiskPose::default()
        }
    }
    fn events_s(&self) -> &[f64] {
        &[1e-4]
    }
}

pub(super) fn c13() -> Vec<Check> {
    let (film, flight) = default_film(300);
    let area = 0.85e-3 * 0.70e-3;
    let (mut pull, mut spring) = (0.0_f64, 0.0_f64);
    for rise in [0.0, 1e-8, 1e-7, 1e-6, 1e-5] {
        let attitude = Attitude {
            centre_height_m: flight.attitude.centre_height_m + rise,
            ..flight.attitude
        };
        let held = fixed_attitude(&film, &attitude).expect("a steady film");
        pull = pull.max(-held.force[0] / (film.ambient_pa() * area));
        let linear = flight.stiffness[0][0].abs() * rise - 2.2 * GRAM_FORCE_N;
        spring = spring.max(linear / (film.ambient_pa() * area));
    }
    // Drawn away and brought back: the force comes from the film's state, and the run reports what happened.
    let run = sudden(-0.05, 2e-5);
    let columns = run.columns.as_ref().expect("recorded");
    let moved = largest(columns.bearing_force_n.iter().map(|f| -f)) / (film.ambient_pa() * area);
    let slap = moving(&AwayAndBack, 1.5e-4);
    let columns = slap.columns.as_ref().expect("recorded");
    let drawn = largest(columns.bearing_force_n.iter().map(|f| -f)) / (film.ambient_pa() * area);
    let linear = flight.stiffness[0][0].abs() * AWAY_M / (film.ambient_pa() * area);
    vec![
        Check::new("pull at 0 to 10 um, of ambient pressure x area", pull, 1.0)
            .against("linear spring of the steady flight", spring),
        Check::new("pull while the disk falls away", moved, 1.0),
        Check::new("pull of a disk 40 um away and back in 0.1 ms", drawn, 1.0)
            .against("linear spring of the steady flight", linear),
        Check::none(
            "loads that never fall below zero",
            usize::from(drawn <= 0.0),
        ),
        Check::new(
            "smallest pressure below zero on the way, Pa",
            -slap.cost.min_pressure_pa,
            0.0,
        ),
        Check::none(
            "way back without a verdict",
            usize::from(matches!(slap.verdict, Verdict::Undecided { .. })),
        ),
    ]
}
