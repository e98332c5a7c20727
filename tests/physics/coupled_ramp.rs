//! A ramp whose arms are one body: against separate arms, the other contact method, and its balances.

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{ArmMode, CoupledMode, OneBody, RampBody, RampError, RigidRamp};
use opshock_solver::structure::{StructureRun, Workspace};
use opshock_tests::structures::{Structure, s1, s1_arms};

fn run(structure: &Structure, amplitude: f64) -> StructureRun {
    structure
        .build()
        .run(amplitude, true, &mut Workspace::default())
        .unwrap()
}

/// Largest difference of any recorded displacement of disk and arms, m.
fn distance_m(a: &StructureRun, b: &StructureRun) -> f64 {
    let [a, b] = [a, b].map(|run| run.columns.as_ref().unwrap());
    let pairs = [
        (&a.disk_slider_m, &b.disk_slider_m),
        (&a.disk_ramp_m, &b.disk_ramp_m),
        (&a.ramp_top_m, &b.ramp_top_m),
        (&a.ramp_bottom_m, &b.ramp_bottom_m),
    ];
    let mut largest = 0.0_f64;
    for (x, y) in pairs {
        assert_eq!(x.len(), y.len());
        for (x, y) in x.iter().zip(y) {
            largest = largest.max((x - y).abs());
        }
    }
    largest
}

fn arm_modes() -> Vec<ArmMode> {
    let [top, _] = s1_arms().arms().expect("set S1 has separate arms");
    top
}

/// Equal separate arms as one body: any two modes of equal frequency may be mixed, here into arms
/// that move together and arms that move apart.
fn mixed() -> RampBody {
    let half = 0.5_f64.sqrt();
    let modes = arm_modes().into_iter().flat_map(|mode| {
        let shape = half / mode.mass_kg.sqrt();
        let participation = mode.mass_kg.sqrt() * mode.participation / half;
        let of = |bottom, participation_sqrt_kg| CoupledMode {
            frequency_hz: mode.frequency_hz,
            shape_per_sqrt_kg: [shape, bottom],
            participation_sqrt_kg,
            damping_ratio: mode.damping_ratio,
        };
        [of(shape, participation), of(-shape, 0.0)]
    });
    OneBody {
        modes: modes.collect(),
    }
    .into()
}

/// Two fingers on a body: modes of the default ramp from geometry, rounded.
fn bolted() -> RampBody {
    let mode = |frequency_hz, top, bottom, participation_sqrt_kg| CoupledMode {
        frequency_hz,
        shape_per_sqrt_kg: [top, bottom],
        participation_sqrt_kg,
        damping_ratio: 0.02,
    };
    OneBody {
        modes: vec![
            mode(3180.0, 220.2, 218.7, 6.06e-3),
            mode(20_430.0, 738.3, -352.2, -4.36e-4),
            mode(23_380.0, 265.8, 712.6, -2.28e-3),
            mode(26_290.0, 100.7, 187.2, 6.06e-3),
            mode(50_460.0, 203.8, 174.5, -4.3e-5),
            mode(79_670.0, 581.0, -240.9, -1.2e-4),
            mode(89_930.0, 199.0, 604.0, 1.9e-5),
        ],
    }
    .into()
}

#[test]
fn equal_separate_arms_as_one_body_are_what_they_were() {
    for (g, width_s) in [(400.0, 2e-3), (200.0, 5e-4)] {
        let separate = s1(width_s, s1_arms());
        let one_body = separate.with_ramp(mixed());
        assert_eq!(separate.build().n_modes(), one_body.build().n_modes());
        let [a, b] = [&separate, &one_body].map(|s| run(s, g * G));
        let touches = [&a, &b].map(|r| r.top.episodes.len() + r.bottom.episodes.len());
        assert!(touches[0] > 0 && touches[0] == touches[1], "{touches:?}");
        let apart = distance_m(&a, &b);
        assert!(apart < 1e-9, "{g} g: {apart:e} m");
        for (a, b) in [(&a.top, &b.top), (&a.bottom, &b.bottom)] {
            assert!((a.impulse_n_s - b.impulse_n_s).abs() <= 1e-6 * a.impulse_n_s);
        }
        // The amplitude of the first touch is that of the same free motion.
        for positive in [true, false] {
            let [x, y] = [&separate, &one_body]
                .map(|s| s.build().touch_amplitude_m_per_s2(positive).unwrap());
            assert!((x / y - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn a_push_on_one_arm_moves_the_other_and_the_balances_close() {
    let structure = s1(2e-3, bolted());
    let touched = run(&structure, 400.0 * G);
    assert!(touched.top.impulse_n_s > 0.0 && touched.bottom.impulse_n_s == 0.0);
    // The bottom arm without any contact is the unit response scaled from below the touch.
    let first_s = touched.first_touch_s.unwrap();
    let free = run(&structure, 40.0 * G);
    assert!(free.first_touch_s.is_none());
    let [with, without] = [&touched, &free].map(|r| r.columns.as_ref().unwrap());
    let (mut before, mut after) = (0.0_f64, 0.0_f64);
    for (k, time_s) in with.time_s.iter().enumerate() {
        let moved = (with.ramp_bottom_m[k] - 10.0 * without.ramp_bottom_m[k]).abs();
        match *time_s < first_s {
            true => before = before.max(moved),
            false => after = after.max(moved),
        }
    }
    assert!(before < 1e-15 && after > 1e-6, "{before:e} {after:e}");
    for g in [100.0, 200.0, 400.0, -400.0, 800.0] {
        let run = run(&structure, g * G);
        let energy = &run.energy;
        assert!(
            energy.closure < 1e-9 && energy.algorithmic_j <= 0.0,
            "{g}: {energy:?}"
        );
        assert!(run.complementarity.min_multiplier_n_s >= 0.0);
        assert!(run.complementarity.max_penetration_m < 1e-7);
    }
}

/// Moreau and Jean's steps know nothing of the impact law of the production scheme.
#[test]
fn both_contact_methods_agree_on_one_body() {
    let base = s1(2e-3, bolted()).with_cut(20e3);
    let exact = run(&base.with_step(0.125e-6), 400.0 * G);
    let mut errors = Vec::new();
    for step_s in [0.5e-6, 0.125e-6] {
        let other = run(&base.with_step(step_s).with_moreau_jean(), 400.0 * G);
        errors.push((other.disk.slider_max_m - exact.disk.slider_max_m).abs());
        let impulse = other.top.impulse_n_s / exact.top.impulse_n_s - 1.0;
        assert!(impulse.abs() < 0.05, "{step_s:e}: {impulse:e}");
    }
    assert!(errors[1] < 0.1e-6, "{errors:?}");
}

#[test]
fn a_body_that_cannot_move_a_contact_point_is_refused() {
    let mode = CoupledMode {
        frequency_hz: 1e3,
        shape_per_sqrt_kg: [100.0, 0.0],
        participation_sqrt_kg: 1e-3,
        damping_ratio: 0.02,
    };
    let refused = |modes: Vec<CoupledMode>| {
        let mut structure = s1(2e-3, RigidRamp);
        structure.ramp.model = OneBody { modes }.into();
        structure.ramp.validate().unwrap_err()
    };
    assert_eq!(
        refused(vec![mode]),
        RampError::CannotMove { side: "bottom" }
    );
    assert_eq!(refused(Vec::new()), RampError::CannotMove { side: "top" });
    for (name, change) in [
        (
            "frequency_hz",
            CoupledMode {
                frequency_hz: 0.0,
                ..mode
            },
        ),
        (
            "participation",
            CoupledMode {
                participation_sqrt_kg: f64::NAN,
                ..mode
            },
        ),
        (
            "damping_ratio",
            CoupledMode {
                damping_ratio: -0.1,
                ..mode
            },
        ),
    ] {
        match refused(vec![change]) {
            RampError::Parameter { name: found, .. } => assert_eq!(found, name),
            other => panic!("{name}: {other:?}"),
        }
    }
}
