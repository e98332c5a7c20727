//! Etched steps: sliders with a step and a pocket against their Richardson values, one-dimensional
//! step by flux matching, conservation, and positive pressure under suction.

use opshock_solver::air_bearing::FlowModel;
use opshock_solver::air_bearing::steady::fixed_attitude;
use opshock_tests::films::{AMBIENT_PA, LENGTH_M, PlaneSlider, TRAILING_M, uniform};
use opshock_tests::sheet::at_most;
use opshock_tests::{number, reference};

#[test]
fn step_and_pocket_reach_their_richardson_values() {
    let data = reference("step_and_pocket.json");
    for case in data["cases"].as_array().unwrap() {
        let ratio = number(&case["H"]);
        let mut slider =
            PlaneSlider::square(FlowModel::Continuum, ratio, number(&case["Lambda"]), 0.0);
        slider.recesses = if case["case"] == "step" {
            vec![([0.0, 0.5], [0.0, 1.0], 1.5)]
        } else {
            vec![
                ([0.0, 0.2], [0.0, 1.0], 2.0),
                ([0.4, 0.8], [0.25, 0.75], 20.0),
            ]
        };
        let [coarse, fine] = [40, 80].map(|n| slider.hold(&uniform(n, 1.0), &uniform(n, 1.0)));
        for (name, expected, a, b) in [
            (
                "load",
                number(&case["W_richardson"][0]),
                coarse.load,
                fine.load,
            ),
            (
                "centre",
                number(&case["Xcp_richardson"][0]),
                coarse.centre,
                fine.centre,
            ),
        ] {
            let found = (4.0 * b - a) / 3.0;
            assert!((b / expected - 1.0).abs() < 1e-3, "{name} at 80: {b}");
            at_most(
                "step-and-pocket",
                &format!("relative error of the {name}, extrapolated from 40 and 80 cells a side"),
                (found / expected - 1.0).abs(),
                1e-4,
            );
        }
    }
}

/// Parallel step, one-dimensional: the slope of p² follows from one flux through both halves.
///
/// Incompressible at small Λ: p' = (6 μ U h − m)/h³ in both halves with the same m.
#[test]
fn one_dimensional_step_matches_fluxes() {
    let bearing_number = 1e-3;
    let mut slider = PlaneSlider::wide(FlowModel::Continuum, 1.0, bearing_number, 0.0);
    slider.recesses = vec![([0.0, 0.4], [0.0, 5e6], 1.0)];
    let held = slider.hold_row(&uniform(10, 1.0));
    // (Λ h1 − m)/h1³ · 0.4 + (Λ h2 − m)/h2³ · 0.6 = 0 with h1 = 2, h2 = 1.
    let m = bearing_number * (0.4 / 4.0 + 0.6) / (0.4 / 8.0 + 0.6);
    let top = (2.0 * bearing_number - m) / 8.0 * 0.4;
    assert!(
        (held.load / (0.5 * top) - 1.0).abs() < 2e-3,
        "{} {}",
        held.load,
        0.5 * top
    );
}

/// What flows through the edges of any patch of cells is the sum of the cells' residuals: zero in
/// the steady state to 1e-12 of the through-flow, edges of rails included.
#[test]
fn steady_film_conserves_mass_cell_by_cell() {
    let mut slider = PlaneSlider::square(FlowModel::FukuiKaneko, 2.0, 100.0, 0.5);
    slider.recesses = vec![([0.2, 0.5], [0.3, 0.7], 10.0)];
    let lines = uniform(20, 1.0);
    let film = slider.film(&lines, &lines);
    let attitude = slider.attitude();
    let held = fixed_attitude(&film, &attitude).unwrap();
    let mut residual = vec![0.0; film.n_cells()];
    film.flux_residual(&held.psi, &attitude, &mut residual, &mut film.scratch());
    let wind = 100.0 * AMBIENT_PA * TRAILING_M * TRAILING_M / LENGTH_M;
    let through = wind * AMBIENT_PA * TRAILING_M * LENGTH_M;
    assert!(residual.iter().sum::<f64>().abs() < 1e-12 * through);
    for r in residual {
        assert!(r.abs() < 1e-12 * through, "{}", r / through);
    }
}

/// A disk drawn away at 1 m/s for 10 µs from a 100 nm film, implicit Euler: pressure stays positive
/// and what flows in through the edges is what the film gained.
#[test]
fn hard_c7_suction_keeps_pressure_positive_and_mass_closed() {
    use opshock_solver::linalg::banded::BandedLu;
    let slider = PlaneSlider::square(FlowModel::FukuiKaneko, 1.5, 1000.0, 0.64);
    let lines = uniform(24, 1.0);
    let film = slider.film(&lines, &lines);
    let n = film.n_cells();
    let mut attitude = slider.attitude();
    let mut psi = fixed_attitude(&film, &attitude).unwrap().psi;
    let mut lin = film.linearisation();
    let mut scratch = film.scratch();
    let mut lu = BandedLu::<f64>::new(n, lin.by_psi.band());
    let step_s = 1e-7;
    let mut pressure = vec![0.0; n];
    for _ in 0..100 {
        attitude.centre_height_m += 1.0 * step_s;
        let old = psi.clone();
        for _ in 0..12 {
            film.linearise(&psi, &attitude, &mut lin, &mut scratch);
            lu.factor(&lin.by_psi, 1.0 / step_s, film.storage())
                .unwrap();
            let change: Vec<f64> = (0..n).map(|k| (psi[k] - old[k]) / step_s).collect();
            let mut delta = vec![0.0; n];
            film.storage().multiply(&change, &mut delta);
            for (delta, residual) in delta.iter_mut().zip(&lin.residual) {
                *delta += residual;
            }
            lu.solve(&mut delta);
            for (p, d) in psi.iter_mut().zip(&delta) {
                *p = (*p - d).max(0.2 * *p);
            }
        }
        film.flux_residual(&psi, &attitude, &mut lin.residual, &mut scratch);
        let (mut gained, mut flown, mut scale) = (0.0, 0.0, 0.0);
        for k in 0..n {
            gained += film.capacity()[k] * (psi[k] - old[k]) / step_s;
            flown += lin.residual[k];
            scale += film.capacity()[k] * psi[k] / step_s;
        }
        assert!((gained + flown).abs() < 1e-10 * scale);
        film.pressure(&psi, &attitude, &mut pressure);
        assert!(pressure.iter().all(|p| *p > 0.0));
    }
    // 10 µm away nothing but the ambient pressure is left to pull.
    assert!(film.force(&psi, &attitude, &mut scratch)[0] > -AMBIENT_PA * LENGTH_M * LENGTH_M);
}

/// Uniform approach to a height far below any molecule.
#[test]
fn vanishing_gap_keeps_numbers_finite() {
    let slider = PlaneSlider::square(FlowModel::FukuiKaneko, 1.5, 1000.0, 0.64);
    let film = slider.film(&uniform(12, 1.0), &uniform(12, 1.0));
    for height_m in [1e-9, 1e-11, 1e-13, 0.0, -5e-8] {
        let mut attitude = slider.attitude();
        attitude.centre_height_m = height_m;
        let held = fixed_attitude(&film, &attitude).unwrap();
        let mut pressure = vec![0.0; film.n_cells()];
        film.pressure(&held.psi, &attitude, &mut pressure);
        assert!(
            pressure.iter().all(|p| p.is_finite() && *p > 0.0),
            "{height_m}"
        );
        assert!(held.force.iter().all(|f| f.is_finite()));
    }
}
