//! The dimple's preload: a force between slider and suspension that the film does not see, until it is used up.

use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::Outcome;
use opshock_tests::{pairs, scenes};

/// 1 gf in N.
const GF_N: f64 = 9.80665e-3;

/// A shock of 2 ms without a ramp, recorded past a touch.
fn shaken(preload_gf: f64, amplitude_g: f64) -> Outcome {
    let preload = preload_gf.to_string();
    let settings = [
        ("resolution.preset", "coarse"),
        ("resolution.film_cells", "200"),
        ("pulse.window_ms", "2.5"),
        ("suspension.gram_load_gf", "0.5"),
        ("suspension.gimbal.dimple_preload_gf", &preload),
    ];
    let scene = scenes::scene("drive-2.5in", "none", 2.0, &settings);
    let plan = Plan::new(&[Output::DimpleForce], Mode::Auto).past_touch();
    pairs::run(&scene, &plan, amplitude_g, None).1
}

fn smallest_force_n(outcome: &Outcome) -> f64 {
    outcome.dimple.expect("a head").min_force_n
}

#[test]
fn a_preload_adds_to_the_contact_force_and_moves_nothing_while_the_dimple_is_closed() {
    let [without, with] = [0.0, 1.0].map(|preload_gf| shaken(preload_gf, 100.0));
    let [one, other] = [&without, &with].map(|o| &o.history.as_ref().expect("recorded").head);
    assert!(one.time_s.len() > 100);
    for (a, b) in one.dimple_force_n.iter().zip(&other.dimple_force_n) {
        assert!((b - a - GF_N).abs() < 1e-9 * GF_N, "{a:e} {b:e}");
    }
    for (a, b) in one.min_clearance_m.iter().zip(&other.min_clearance_m) {
        assert!((b / a - 1.0).abs() < 1e-9, "{a:e} {b:e}");
    }
}

/// The shock takes a force from the dimple that grows with the amplitude, so that one that opens at A under a load of
/// 0.5 gf opens at 1.4 A when a preload of 0.2 gf is added.
#[test]
fn a_preload_moves_the_opening_of_the_dimple_as_the_load_would() {
    let at_g = 50.0;
    let taken_n_per_g = (0.5 * GF_N - smallest_force_n(&shaken(0.0, at_g))) / at_g;
    let opens_g = 0.5 * GF_N / taken_n_per_g;
    for (preload_gf, factor) in [(0.0, 1.0), (0.2, 1.4)] {
        let force_n = |share: f64| smallest_force_n(&shaken(preload_gf, share * factor * opens_g));
        assert!(force_n(0.99) > 0.0);
        assert_eq!(force_n(1.01), 0.0);
    }
}
