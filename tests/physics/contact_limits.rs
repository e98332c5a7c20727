//! Contact where the answer is known: mirrored shocks, arms without mass and arms that do not move.

use super::contact::{cases, run, slider_distance};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{NoRamp, RigidRamp};
use opshock_tests::structures::{s1, s1_arms};

#[test]
fn hard_b17_the_negative_shock_is_the_mirror_bit_by_bit() {
    for case in cases() {
        let (plus, minus) = (
            run(&case.structure, case.amplitude),
            run(&case.structure, -case.amplitude),
        );
        assert_eq!(plus.top, minus.bottom);
        assert_eq!(plus.bottom, minus.top);
        for (a, b) in plus.history.nodes().iter().zip(minus.history.nodes()) {
            assert_eq!(a.displacement_m, -b.displacement_m);
            assert_eq!(a.pitch_rad, -b.pitch_rad);
            assert_eq!(a.roll_rad, -b.roll_rad);
        }
    }
}

/// Hard case B11: very light arms are no ramp, very heavy ones a rigid ramp.
#[test]
fn hard_b11_series_of_arm_masses() {
    let base = s1(5e-4, RigidRamp).with_cut(20e3);
    let amplitude = 200.0 * G;
    let scaled = |factor: f64, keep_stiffness: bool| {
        let mut arms = s1_arms();
        for mode in arms.contacts.iter_mut().flatten() {
            mode.mass_kg *= factor;
            mode.participation = 0.0;
            if keep_stiffness {
                mode.frequency_hz /= factor.sqrt();
            }
        }
        base.with_ramp(arms)
    };
    let (none, rigid) = (
        run(&base.with_ramp(NoRamp), amplitude),
        run(&base, amplitude),
    );
    let light = run(&scaled(1e-9, false), amplitude);
    assert!(slider_distance(&light, &none) < 1e-6 * none.disk.slider_max_m);
    for keep in [false, true] {
        let heavy = run(&scaled(1e9, keep), amplitude);
        assert!(slider_distance(&heavy, &rigid) < 1e-6 * none.disk.slider_max_m);
    }
    for exponent in -9..=9 {
        for keep in [false, true] {
            let run = run(&scaled(10_f64.powi(exponent), keep), amplitude);
            let e = &run.energy;
            assert!(
                e.closure < 1e-9 && e.algorithmic_j <= 0.0,
                "1e{exponent} {keep}: {e:?}"
            );
            assert!(run.complementarity.min_multiplier_n_s >= 0.0);
        }
    }
}
