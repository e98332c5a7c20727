//! Every scene of disk, ramp and head on which the hard cases run, as reduced and as full model. Cases of
//! films, bodies, searches and single heads under a given disk have no plan to differ in.

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::scene::Scene;
use opshock_solver::scene::plan::Output;
use opshock_study::hard_cases::scenes::drive::small_scene;
use opshock_study::hard_cases::scenes::noted::structures_of;
use opshock_study::hard_cases::{CASES, Case};
use opshock_tests::pairs::{Pair, compare};
use opshock_tests::structures::Structure;

/// Steps of a run above which a pair belongs to `make verify-effects`.
const FEW_STEPS: f64 = 12_000.0;

/// The structure in a drive whose other parts no output of disk and ramp asks for.
fn in_a_drive(base: &Scene, structure: &Structure) -> Scene {
    let mut scene = base.clone();
    scene.disk = structure.disk.clone();
    scene.disk_resolution = structure.disk_resolution.clone();
    scene.ramp = structure.ramp.clone();
    scene.slider.radius_m = structure.slider.radius_m;
    scene.slider.angle_rad = structure.slider.angle_rad;
    scene.slider.skew_rad = structure.slider.skew_rad;
    scene.pulse = structure.pulse.clone();
    scene.window = structure.window;
    scene.structure_resolution = structure.resolution.clone();
    scene
}

fn n_steps(structure: &Structure) -> f64 {
    match structure.window {
        opshock_solver::scene::Window::Fixed { length_s } => length_s / structure.resolution.step_s,
        opshock_solver::scene::Window::UntilDecayed { max_s, .. } => {
            max_s / structure.resolution.step_s
        }
    }
}

/// Pairs of `case`, each scene and shock once, as far as `is_wanted`; returns how many.
fn pairs_of(case: &Case, base: &Scene, is_wanted: impl Fn(&Structure) -> bool) -> usize {
    let mut seen: Vec<String> = Vec::new();
    for (structure, amplitude) in structures_of(|| drop(case.run())) {
        let key = format!("{structure:?} {amplitude:e}");
        if seen.contains(&key) || !amplitude.is_finite() || !is_wanted(&structure) {
            continue;
        }
        // Nothing moves, so that no output can differ.
        let asked: &[Output] = match amplitude.abs() > 1e-200 {
            true => &[Output::ContactForce, Output::DiskDisplacement],
            false => &[],
        };
        let what = format!("{} {}, pair {}", case.id, case.name, seen.len());
        let scene = in_a_drive(base, &structure);
        compare(&scene, asked, amplitude / G, None, Pair::default(), &what);
        seen.push(key);
    }
    seen.len()
}

fn all_pairs(is_wanted: impl Fn(&Structure) -> bool) -> Vec<(&'static str, usize)> {
    let base = small_scene();
    let counts = CASES
        .iter()
        .map(|case| (case.id, pairs_of(case, &base, &is_wanted)));
    counts.filter(|(_, n)| *n > 0).collect()
}

#[test]
fn effects_auto_is_full_for_the_hard_cases() {
    let pairs = all_pairs(|structure| n_steps(structure) <= FEW_STEPS);
    println!("{pairs:?}");
    let with_scenes = [
        "A3", "A4", "A8", "A9", "A10", "A13", "B1", "B5", "B8", "B9", "B11", "B12", "B14", "B16",
        "B17", "B18", "E10", "F1", "F3",
    ];
    let cases: Vec<&str> = pairs.iter().map(|(id, _)| *id).collect();
    assert_eq!(cases, with_scenes);
}

/// Longer runs of the hard cases.
#[test]
#[ignore = "slow"]
fn effects_slow_auto_is_full_for_long_hard_cases() {
    let pairs = all_pairs(|structure| n_steps(structure) > FEW_STEPS);
    println!("{pairs:?}");
    assert!(pairs.iter().any(|(id, _)| *id == "B7"));
}

/// The whole drives of D7 and F4, with the head.
#[test]
fn effects_auto_is_full_for_the_hard_cases_with_a_head() {
    let scene = small_scene();
    let mut loaded = scene.clone();
    loaded.suspension.gram_load_n *= 1.5;
    for (scene, amplitude_g) in [(&scene, 200.0), (&loaded, 200.0), (&scene, 150.0)] {
        let asked = [
            Output::CriticalShock,
            Output::ContactForce,
            Output::PressureField,
        ];
        let pair = Pair {
            with_head: true,
            ..Pair::default()
        };
        let what = format!("D7, F4: {amplitude_g} G");
        compare(scene, &asked, amplitude_g, None, pair, &what);
    }
}
