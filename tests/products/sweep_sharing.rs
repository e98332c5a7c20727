//! What the points of a sweep share changes no number of any of them.

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_study::search::{Probe, ProbeResult};
use opshock_study::study::Study;
use opshock_study::sweep::{Physics, Simulator};
use opshock_tests::pairs::assert_same_answers;
use opshock_tests::scenes;

/// Two sliders at two altitudes on one drive: the structure of all four points is the same.
fn designs(effects: &str) -> Study {
    let study = scenes::study(
        "fig13",
        &[
            ("pulse.widths_ms", "[0.5]"),
            ("pulse.signs", "[\"+\"]"),
            ("pulse.window_ms", "0.8"),
            ("ramp.models", "[\"rigid\"]"),
            ("slider.surface.crown_nm", "[12, 18]"),
            ("gas.altitude_m", "[0, 3000]"),
            ("resolution.preset", "\"coarse\""),
            ("resolution.film_cells", "150"),
            ("resolution.disk_cut_khz", "10"),
            ("solver.effects", effects),
        ],
    );
    assert_eq!(study.points.len(), 4);
    study
}

/// Every point at two amplitudes, above and below touch, each twice.
fn ask(physics: &Physics, threads: usize) -> Vec<ProbeResult> {
    let jobs: Vec<(usize, f64)> = [150.0, 300.0, 150.0, 300.0]
        .into_iter()
        .flat_map(|g| (0..4).map(move |point| (point, m_per_s2_from_g(g))))
        .collect();
    let answer = |&(point, a): &(usize, f64)| physics.simulate(point, Probe::at(0), a);
    if threads == 1 {
        return jobs.iter().map(answer).collect();
    }
    std::thread::scope(|scope| {
        let started: Vec<_> = jobs
            .iter()
            .map(|job| scope.spawn(move || answer(job)))
            .collect();
        let joined = started.into_iter().map(|one| one.join().expect("a result"));
        joined.collect()
    })
}

#[test]
fn shared_structures_and_flights_give_the_bits_of_points_simulated_alone() {
    let study = designs("\"auto\"");
    let shared = ask(&Physics::of(&study), 1);
    assert_eq!(shared, ask(&Physics::of(&study), 16));
    let all = ask(&Physics::of(&designs("\"full\"")), 1);
    assert_same_answers(&shared, &all);
    // Designs differ, and a question asked again has the same answer.
    assert_ne!(shared[0].h_min_m, shared[1].h_min_m);
    assert_eq!(shared[..8], shared[8..]);
}
