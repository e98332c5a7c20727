//! Derivatives of the discrete film against finite differences, and exact states.

use super::*;
use crate::gas::GasParameters;
use crate::slider::{Rail, RailOutline, SliderParameters, SurfaceParameters};

fn air() -> GasParameters {
    GasParameters {
        pressure_pa: 101_325.0,
        viscosity_pa_s: 1.806e-5,
        mean_free_path_m: 6.35e-8,
    }
}

/// A femto slider with a step, a pad, a slanted rail and every kind of form.
fn slider() -> SliderParameters {
    let rectangle = |x_m, y_m, recess_m| Rail {
        outline: RailOutline::Rectangle { x_m, y_m },
        recess_m,
    };
    SliderParameters {
        radius_m: 0.021,
        angle_rad: 0.0,
        skew_rad: 0.1,
        length_m: 850e-6,
        width_m: 700e-6,
        height_m: 230e-6,
        density_kg_per_m3: 4300.0,
        surface: SurfaceParameters {
            base_recess_m: 1.5e-6,
            crown_m: 15e-9,
            camber_m: 2e-9,
            twist_m: 1e-9,
            taper_length_m: 50e-6,
            taper_angle_rad: 1e-3,
            rails: vec![
                rectangle([50e-6, 240e-6], [30e-6, 670e-6], 0.25e-6),
                rectangle([120e-6, 240e-6], [50e-6, 650e-6], 0.0),
                Rail {
                    outline: RailOutline::Polygon {
                        points_m: vec![
                            [600e-6, 250e-6],
                            [840e-6, 200e-6],
                            [840e-6, 500e-6],
                            [600e-6, 450e-6],
                        ],
                    },
                    recess_m: 0.0,
                },
            ],
        },
    }
}

fn film(cells: usize, min_height_m: f64) -> Film {
    film_of(FlowModel::FukuiKaneko, cells, min_height_m)
}

fn film_of(flow: FlowModel, cells: usize, min_height_m: f64) -> Film {
    let resolution = FilmResolution {
        cells,
        min_height_m,
        correction_cells: 0,
    };
    Film::build(&slider(), &air(), flow, 565.0, &resolution).unwrap()
}

fn wavy_state(film: &Film, attitude: &Attitude) -> Vec<f64> {
    let mut psi = vec![0.0; film.n_cells()];
    film.ambient_psi(attitude, &mut psi);
    for (k, v) in psi.iter_mut().enumerate() {
        // Neighbours differ by up to ten times, beyond what G of a centre serves.
        *v *= (1.2 * (k as f64 * 1.37).sin()).exp();
    }
    psi
}

/// Equal but for the order of additions.
fn assert_same(a: &[f64], b: &[f64]) {
    let scale = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        assert!((a - b).abs() < 1e-14 * scale, "cell {k}: {a:e} {b:e}");
    }
}

#[test]
fn jacobian_matches_differences_above_and_inside_the_floor() {
    for (flow, min_height_m) in [
        (FlowModel::FukuiKaneko, 3e-10),
        (FlowModel::FukuiKaneko, 2e-8),
        (FlowModel::Continuum, 3e-10),
        (FlowModel::Continuum, 2e-8),
    ] {
        let mut film = film_of(flow, 400, min_height_m);
        // Of the higher floor with cells of first order.
        if min_height_m > 1e-9 {
            film = film.of_first_order_at(&[0, 57, 58, 200]);
        }
        let attitude = Attitude {
            centre_height_m: 55e-9,
            pitch_rad: 1.1e-4,
            roll_rad: 1e-5,
        };
        let psi = wavy_state(&film, &attitude);
        let mut scratch = film.scratch();
        let mut lin = film.linearisation();
        film.linearise(&psi, &attitude, &mut lin, &mut scratch);
        let n = film.n_cells();
        let residual = |psi: &[f64], attitude: &Attitude| {
            let mut out = vec![0.0; n];
            film.flux_residual(psi, attitude, &mut out, &mut film.scratch());
            out
        };
        assert_same(&residual(&psi, &attitude), &lin.residual);

        // A direction in psi.
        let direction: Vec<f64> = (0..n).map(|k| psi[k] * (k as f64 * 1.3).cos()).collect();
        let shifted =
            |e: f64| -> Vec<f64> { psi.iter().zip(&direction).map(|(p, d)| p + e * d).collect() };
        let e = 1e-6;
        let (plus, minus) = (
            residual(&shifted(e), &attitude),
            residual(&shifted(-e), &attitude),
        );
        let mut product = vec![0.0; n];
        lin.by_psi.multiply(&direction, &mut product);
        let scale = product.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        for k in 0..n {
            let numeric = (plus[k] - minus[k]) / (2.0 * e);
            assert!(
                (numeric - product[k]).abs() < 2e-7 * scale,
                "cell {k}: {numeric} {}",
                product[k]
            );
        }

        // The three attitude columns.
        for (q, step) in [1e-14, 1e-10, 1e-10].into_iter().enumerate() {
            let moved = |s: f64| {
                let mut a = attitude;
                match q {
                    0 => a.centre_height_m += s,
                    1 => a.pitch_rad += s,
                    _ => a.roll_rad += s,
                }
                residual(&psi, &a)
            };
            let (plus, minus) = (moved(step), moved(-step));
            let scale = lin.by_attitude[q]
                .iter()
                .fold(0.0_f64, |m, v| m.max(v.abs()));
            for k in 0..n {
                let numeric = (plus[k] - minus[k]) / (2.0 * step);
                let analytic = lin.by_attitude[q][k];
                assert!(
                    (numeric - analytic).abs() < 3e-6 * scale,
                    "column {q}, cell {k}: {numeric} {analytic}"
                );
            }
        }
    }
}

#[test]
fn force_gradients_match_differences() {
    for flow in [FlowModel::FukuiKaneko, FlowModel::Continuum] {
        compare_force_gradients(&film_of(flow, 400, 2e-8));
    }
}

fn compare_force_gradients(film: &Film) {
    let attitude = Attitude {
        centre_height_m: 55e-9,
        pitch_rad: 1.1e-4,
        roll_rad: 1e-5,
    };
    let psi = wavy_state(film, &attitude);
    let n = film.n_cells();
    let mut lin = film.linearisation();
    film.linearise(&psi, &attitude, &mut lin, &mut film.scratch());
    let (by_psi, by_attitude) = (&lin.force_by_psi, lin.force_by_attitude);
    let mut residual = vec![0.0; n];
    let together =
        film.flux_residual_and_force(&psi, &attitude, &mut residual, &mut film.scratch());
    for (a, b) in lin
        .force
        .into_iter()
        .zip(film.force(&psi, &attitude, &mut film.scratch()))
    {
        assert!((a - b).abs() < 1e-12 * a.abs());
    }
    assert_eq!(together, film.force(&psi, &attitude, &mut film.scratch()));
    assert_same(&residual, &lin.residual);
    let direction: Vec<f64> = (0..n).map(|k| psi[k] * (k as f64 * 1.3).cos()).collect();
    // Rounding of a force of 0.1 N, 1e-17 N, over 2e leaves 1e-8 of these gradients.
    let e = 1e-5;
    let at = |e: f64| {
        let psi: Vec<f64> = psi.iter().zip(&direction).map(|(p, d)| p + e * d).collect();
        film.force(&psi, &attitude, &mut film.scratch())
    };
    let (plus, minus) = (at(e), at(-e));
    for f in 0..3 {
        let numeric = (plus[f] - minus[f]) / (2.0 * e);
        let analytic: f64 = by_psi[f].iter().zip(&direction).map(|(g, d)| g * d).sum();
        assert!((numeric - analytic).abs() < 1e-7 * analytic.abs().max(1e-6));
    }
    for q in 0..3 {
        let step = [1e-13, 1e-9, 1e-9][q];
        let at = |s: f64| {
            let mut a = attitude;
            match q {
                0 => a.centre_height_m += s,
                1 => a.pitch_rad += s,
                _ => a.roll_rad += s,
            }
            film.force(&psi, &a, &mut film.scratch())
        };
        let (plus, minus) = (at(step), at(-step));
        for f in 0..3 {
            let numeric = (plus[f] - minus[f]) / (2.0 * step);
            let scale = by_attitude[f][q]
                .abs()
                .max((by_attitude[f][f] * by_attitude[q][q]).abs().sqrt());
            assert!(
                (numeric - by_attitude[f][q]).abs() < 1e-5 * scale,
                "{f} {q}"
            );
        }
    }
}

#[test]
fn fluxes_leave_one_cell_and_enter_the_next() {
    for flow in [FlowModel::FukuiKaneko, FlowModel::Continuum] {
        compare_columns(&film_of(flow, 300, 3e-10));
    }
}

fn compare_columns(film: &Film) {
    let attitude = Attitude {
        centre_height_m: 60e-9,
        pitch_rad: 1e-4,
        roll_rad: 0.0,
    };
    let psi = wavy_state(film, &attitude);
    let mut lin = film.linearisation();
    film.linearise(&psi, &attitude, &mut lin, &mut film.scratch());
    // Columns of cells whose ψ no flux through the slider's edge depends on sum to zero.
    let [nx, ny] = film.lines_m().map(|l| l.len() - 1);
    let n = film.n_cells();
    for i in 2..nx - 2 {
        for j in 2..ny - 2 {
            let c = film.cell_index(i, j);
            let sum: f64 = (0..n).map(|r| lin.by_psi.get(r, c)).sum();
            assert!(sum.abs() < 1e-12 * lin.by_psi.get(c, c).abs());
        }
    }
}

#[test]
fn flying_slider_balances_its_load_and_reports_consistent_forces() {
    let film = film(700, 3e-10);
    let load = [0.02, 1e-7, -5e-8];
    let flight = steady::fly(&film, load).unwrap();
    let force = film.force(&flight.psi, &flight.attitude, &mut film.scratch());
    let scale = [load[0], load[0] * 4e-4, load[0] * 3e-4];
    for k in 0..3 {
        assert!((force[k] - load[k]).abs() < 1e-9 * scale[k]);
    }
    assert!((flight.lift_n + flight.suction_n - load[0]).abs() < 1e-9 * load[0]);
    assert!(flight.n_iterations <= 20);

    // Stiffness and damping against Z(iω) at a low frequency, and Z against the quasi-static film.
    let mut motion = impedance::SmallMotion::new(&film, &flight.psi, &flight.attitude);
    let z = motion.impedance(1.0).unwrap();
    for i in 0..3 {
        for j in 0..3 {
            let size = (flight.stiffness[i][i] * flight.stiffness[j][j]).sqrt();
            assert!((z[(i, j)].re - flight.stiffness[i][j]).abs() < 1e-6 * size);
            let size = (flight.damping[i][i] * flight.damping[j][j]).abs().sqrt();
            let damping = z[(i, j)].im / std::f64::consts::TAU;
            assert!((damping - flight.damping[i][j]).abs() < 1e-4 * size);
        }
    }
    let step = 1e-12;
    let held = |dh: f64| {
        let mut attitude = flight.attitude;
        attitude.centre_height_m += dh;
        steady::fixed_attitude(&film, &attitude).unwrap().force
    };
    let (up, down) = (held(step), held(-step));
    let stiffness = -(up[0] - down[0]) / (2.0 * step);
    assert!((stiffness / flight.stiffness[0][0] - 1.0).abs() < 1e-4);
}

#[test]
fn far_starts_reach_the_same_equilibrium() {
    let film = film(500, 3e-10);
    let load = [0.02, 0.0, 0.0];
    let flown = steady::fly(&film, load).unwrap();
    let start = |centre_height_m, pitch_rad| Attitude {
        centre_height_m,
        pitch_rad,
        roll_rad: 0.0,
    };
    for from in [
        start(1e-5, 1e-4),
        start(
            flown.attitude.centre_height_m - flown.min_clearance_m + 1e-10,
            1e-4,
        ),
        start(1e-7, -1e-4),
        start(2e-7, 4e-4),
    ] {
        let other = steady::fly_from(&film, load, &from).unwrap();
        assert!(
            (other.min_clearance_m / flown.min_clearance_m - 1.0).abs() < 1e-8,
            "{from:?}"
        );
        assert!((other.attitude.pitch_rad / flown.attitude.pitch_rad - 1.0).abs() < 1e-8);
    }
}

/// With G at the cells' centres this film has several steady states, and Newton's method comes to none of them.
#[test]
fn film_without_slip_has_one_steady_state() {
    // Shallow steps in front of the pads of a 2.5-inch drive's slider, in micrometres: ends along x, across y, recess.
    let rails = [
        [20.0, 170.0, 30.0, 670.0, 0.25],
        [170.0, 240.0, 50.0, 650.0, 0.0],
        [240.0, 720.0, 30.0, 100.0, 0.25],
        [640.0, 720.0, 30.0, 100.0, 0.0],
        [240.0, 720.0, 600.0, 670.0, 0.25],
        [640.0, 720.0, 600.0, 670.0, 0.0],
        [600.0, 710.0, 210.0, 490.0, 0.25],
        [710.0, 840.0, 250.0, 450.0, 0.0],
    ];
    let mut slider = slider();
    slider.skew_rad = 0.0;
    slider.surface.rails = rails
        .iter()
        .map(|[x0, x1, y0, y1, recess]| Rail {
            outline: RailOutline::Rectangle {
                x_m: [1e-6 * x0, 1e-6 * x1],
                y_m: [1e-6 * y0, 1e-6 * y1],
            },
            recess_m: 1e-6 * recess,
        })
        .collect();
    let resolution = FilmResolution {
        cells: 1000,
        min_height_m: 3e-10,
        correction_cells: 0,
    };
    let flow = FlowModel::Continuum;
    let film = Film::build(&slider, &air(), flow, 565.0, &resolution).unwrap();
    let usual = film.usual_attitude();
    let mut newton = newton::Newton::<f64>::new(&film);
    for share in [1.0, 0.5, 0.25] {
        let mut attitude = usual;
        attitude.centre_height_m *= share;
        attitude.pitch_rad *= share;
        let from = [0.3, 1.0, 3.0].map(|factor| {
            let mut psi: Vec<f64> = film.ambient(&attitude).iter().map(|p| factor * p).collect();
            let (_, step) = newton
                .hold(&mut psi, &attitude, 60, newton::CONVERGED)
                .unwrap();
            assert!(step < newton::CONVERGED, "{share} {factor}");
            psi
        });
        let [low, middle, high] = &from;
        for (k, psi) in middle.iter().enumerate() {
            for other in [low[k], high[k]] {
                assert!((other / psi - 1.0).abs() < 1e-7, "{share}, cell {k}");
            }
        }
    }
}

/// A cell of first order shares no storage, as others do, and gas is conserved.
#[test]
fn cells_of_first_order_store_for_themselves_alone() {
    let film = film_of(FlowModel::FukuiKaneko, 400, 3e-10);
    let (n, cells) = (film.n_cells(), [3, 57, 200]);
    let shared = |film: &Film, cell: usize| {
        let others = (0..n).filter(|&other| other != cell);
        others
            .filter(|&other| film.storage().get(cell, other) != 0.0)
            .count()
    };
    let flat = film.of_first_order_at(&cells);
    assert!(cells.iter().any(|&cell| shared(&film, cell) > 0));
    for cell in cells {
        assert_eq!(shared(&flat, cell), 0, "{cell}");
    }
    for column in 0..n {
        let sum: f64 = (0..n).map(|row| flat.storage().get(row, column)).sum();
        assert!(
            (sum / flat.capacity()[column] - 1.0).abs() < 1e-13,
            "{column}"
        );
    }
}
