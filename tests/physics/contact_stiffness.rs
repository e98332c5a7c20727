//! The local stiffness of the contact: what it must converge to, and what it must not take.

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{ArmMode, Arms};
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{Model, Outcome, Request, Scope, Workspace, simulate};
use opshock_tests::scenes::scene;

/// Figure 13's disk and ramp alone for 2 ms: their first contact is over by then.
fn paper(ramp: &str, pulse_ms: f64, sets: &[(&str, &str)]) -> Scene {
    let window = [("pulse.window_ms", "2.0")];
    let all: Vec<(&str, &str)> = window.iter().chain(sets).copied().collect();
    scene("fig13-stiffness", ramp, pulse_ms, &all)
}

fn outcome(scene: &Scene, amplitude_g: f64) -> Outcome {
    let model = Model::build(scene, Scope::Structure, None).expect("builds");
    let request = Request {
        amplitude_m_per_s2: amplitude_g * G,
        record: true,
    };
    simulate(&model, &request, &mut Workspace::default())
}

fn impulse(outcome: &Outcome) -> f64 {
    outcome.top.impulse_n_s
}

/// A spring whose mass went with the step took 1 % of the energy at 0.25 us and twice as much at
/// each half of it.
#[test]
fn a_lasting_contact_takes_less_energy_the_finer_the_step() {
    let at = |step_us| {
        let sets = [
            ("resolution.disk_cut_khz", "60"),
            ("resolution.disk_harmonics", "56"),
            ("resolution.structure_step_us", step_us),
        ];
        outcome(&paper("rigid", 2.0, &sets), 400.0)
    };
    let [coarse, fine] = ["0.25", "0.125"].map(at);
    for (run, share) in [(&coarse, 1e-4), (&fine, 3e-5)] {
        let taken = run.energy.algorithmic_j / run.energy.h_peak_j;
        assert!(taken <= 0.0 && taken > -share, "{taken:e}");
        assert!(run.energy.closure.abs() < 1e-9);
    }
    let change = impulse(&coarse) / impulse(&fine) - 1.0;
    assert!(change.abs() < 2e-4, "{change:e}");
    // What it takes it takes from the damping: all that is lost hardly depends on the step.
    let [lost, lost_finely] = [&coarse, &fine].map(|run| {
        let e = &run.energy;
        (e.damping_loss_j + e.impact_loss_j - e.algorithmic_j) / e.h_peak_j
    });
    assert!(
        (lost - lost_finely).abs() < 1e-5,
        "{lost:e} {lost_finely:e}"
    );
}

/// Under the slider the motion after an impact is that of few modes; a hard contact of the same scene
/// moves by ten times as much from 120 to 240 kHz.
#[test]
fn motion_under_the_slider_converges_with_the_disks_modes() {
    let rate = |is_hard: bool, cut, harmonics, elements| {
        let sets = [
            ("resolution.disk_cut_khz", cut),
            ("resolution.disk_harmonics", harmonics),
            ("resolution.disk_elements", elements),
        ];
        let mut scene = paper("rigid", 0.5, &sets);
        if is_hard {
            scene.ramp.contact_stiffness_n_per_m = None;
        }
        let history = outcome(&scene, 200.0).history.expect("recorded");
        let slider = &history.structure.disk_slider_m;
        // Second differences on the common grid: what the film has to follow.
        slider
            .windows(3)
            .map(|w| w[0] - 2.0 * w[1] + w[2])
            .collect::<Vec<f64>>()
    };
    let moved = |is_hard: bool| {
        let [a, b] = [
            rate(is_hard, "120", "80", "56"),
            rate(is_hard, "240", "112", "80"),
        ];
        assert_eq!(a.len(), b.len());
        let largest = b.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let apart = a.iter().zip(&b).map(|(x, y)| (x - y).abs());
        apart.fold(0.0, f64::max) / largest
    };
    let (soft, hard) = (moved(false), moved(true));
    println!("largest change: {soft:.4} with the spring, {hard:.4} without");
    assert!(soft < 0.2, "{soft}");
    assert!(hard > 2.0 * soft, "{hard} {soft}");
}

/// With a rigid ramp the spring is the arm's only mode: as the step shrinks it moves as such an arm.
#[test]
fn a_rigid_ramp_with_a_stiffness_is_an_arm_of_one_mode() {
    let sets = [
        ("resolution.disk_cut_khz", "20"),
        ("resolution.structure_step_us", "0.03125"),
    ];
    let rigid = paper("rigid", 0.5, &sets);
    let stiffness = rigid
        .ramp
        .contact_stiffness_n_per_m
        .expect("the study has one");
    let frequency_hz = rigid.ramp.contact_frequency_hz;
    let arm = vec![ArmMode {
        frequency_hz,
        mass_kg: stiffness / (std::f64::consts::TAU * frequency_hz).powi(2),
        participation: 0.0,
        damping_ratio: rigid.ramp.contact_damping_ratio,
    }];
    let mut alike = rigid.clone();
    alike.ramp.contact_stiffness_n_per_m = None;
    alike.ramp.model = Arms {
        top: arm.clone(),
        bottom: arm,
    }
    .into();
    let [a, b] = [&rigid, &alike].map(|scene| outcome(scene, 250.0));
    assert_eq!(a.top.first_touch_s, b.top.first_touch_s);
    assert!(a.top.first_touch_s.is_some());
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-4;
    assert!(near(impulse(&a), impulse(&b)), "{:?} {:?}", a.top, b.top);
    assert!(near(a.disk.slider_max_m, b.disk.slider_max_m));
    // Below first touch it is the motion without any ramp.
    let none = paper("none", 0.5, &sets);
    assert_eq!(outcome(&none, 150.0).disk, outcome(&rigid, 150.0).disk);
}
