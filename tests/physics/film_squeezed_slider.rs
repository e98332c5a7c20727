//! A slider pressed onto the disk by a slow shock: the error of its film's grid, and that it is
//! the error of the same film under quasi-static compression, at a fixed attitude.

use nalgebra::{Matrix3, Vector3};
use opshock_solver::air_bearing::steady::{fixed_attitude, fly_from};
use opshock_solver::air_bearing::{Attitude, Film};
use opshock_solver::quantity::{GRAM_FORCE_N, STANDARD_GRAVITY_M_PER_S2 as G};
use opshock_solver::scene::Scene;
use opshock_solver::simulation::quasi_static::{Other, quasi_static_clearance};
use opshock_solver::simulation::{
    Bearing, Model, Outcome, Request, Scope, Verdict, Workspace, simulate,
};
use opshock_tests::scenes::scene;

/// Figure 13 without a ramp, 1.5 ms, on about `cells` film cells; the compression lies within 2 ms.
fn squeezed(cells: usize) -> Scene {
    let sets = [("pulse.window_ms", "2.0")];
    let mut scene = scene("fig13-stiffness", "none", 1.5, &sets);
    scene.film_resolution.cells = cells;
    scene.film_resolution.correction_cells = 0;
    scene
}

/// The shock that presses the slider onto the disk, of this size.
fn shaken(scene: &Scene, amplitude_g: f64) -> Outcome {
    let model = Model::build(scene, Scope::Full, None).expect("builds");
    let request = Request {
        amplitude_m_per_s2: -amplitude_g * G,
        record: false,
    };
    simulate(&model, &request, &mut Workspace::default())
}

fn survives(scene: &Scene, amplitude_g: f64) -> bool {
    match shaken(scene, amplitude_g).verdict {
        Some(Verdict::Survives) => true,
        Some(Verdict::Fails { .. }) => false,
        _ => panic!("{amplitude_g} g: undecided"),
    }
}

fn force(film: &Film, attitude: &Attitude) -> Vector3<f64> {
    Vector3::from(fixed_attitude(film, attitude).expect("held").force)
}

/// Row of the compliance: clearance lost at `attitude` per force and moments that the film lacks.
fn compliance(film: &Film, attitude: &Attitude) -> Vector3<f64> {
    let whole = force(film, attitude);
    let mut stiffness = Matrix3::zeros();
    for k in 0..3 {
        let mut moved = *attitude;
        let step = match k {
            0 => &mut moved.centre_height_m,
            1 => &mut moved.pitch_rad,
            _ => &mut moved.roll_rad,
        };
        // A picometre, and angles that turn a corner by less.
        let by = if k == 0 { 1e-12 } else { 1e-9 };
        *step += by;
        stiffness.set_column(k, &((whole - force(film, &moved)) / by));
    }
    let closest = film.min_clearance(attitude);
    let [length, width] = film.extent_m();
    let arms = Vector3::new(
        1.0,
        -(closest.x_m - 0.5 * length),
        closest.y_m - 0.5 * width,
    );
    stiffness.transpose().try_inverse().expect("stiff") * arms
}

/// Films of 500, 700 and 2000 cells put the critical shock of a quasi-static compression up to 5 % away from
/// that of 1000, without order. By how much follows from quasi-static films at the attitude of the smallest
/// clearance: the load grows with the shock, so a share of it that a film carries more or less is a share
/// of the shock: 530.4, 572.5 and 553.7 g are expected, 531.6, 573.3 and 553.9 found.
#[test]
fn grid_error_of_a_slow_squeeze_is_that_of_the_held_film() {
    let own = squeezed(1000);
    let critical_g = 544.8;
    assert!(survives(&own, 0.997 * critical_g) && !survives(&own, 1.003 * critical_g));
    let film = own.film().expect("film");
    let q = shaken(&own, 0.99 * critical_g).lowest.expect("a head");
    let carried = force(&film, &q);
    let row = compliance(&film, &q);
    let grown = carried - Vector3::new(own.suspension.gram_load_n, 0.0, 0.0);
    for cells in [500, 700, 2000] {
        let other = squeezed(cells);
        let more = force(&other.film().expect("film"), &q) - carried;
        let share = row.dot(&more) / row.dot(&grown);
        let expected_g = critical_g * (1.0 + share);
        assert!(share.abs() > 0.01, "{cells}: {share}");
        assert!(
            survives(&other, 0.995 * expected_g) && !survives(&other, 1.005 * expected_g),
            "{cells}: not at {expected_g}"
        );
    }
}

/// At the attitude of the smallest clearance, quasi-static films of 500 and of 2000 cells give the clearance that
/// the shock itself leaves on them. Extrapolated from every cell cut in two it is that from every cell cut in
/// three, whose error of second order is a ninth.
#[test]
fn held_films_tell_what_other_grids_leave_of_the_clearance() {
    let own = squeezed(1000);
    let bearing = Bearing::build(&own, None).expect("flies");
    let film = &*bearing.film;
    let amplitude_g = 500.0;
    let run = shaken(&own, amplitude_g);
    let (q, own_nm) = (
        run.lowest.expect("a head"),
        1e9 * run.min_clearance_m.expect("a head"),
    );
    let held_nm = |other: Other| {
        let held = quasi_static_clearance(&own, &bearing, &q, other).expect("held");
        1e9 * held.min_clearance_m
    };
    for cells in [500, 2000] {
        let shaken = shaken(&squeezed(cells), amplitude_g);
        let shaken_nm = 1e9 * shaken.min_clearance_m.expect("a head");
        let reported_nm = held_nm(Other::Cells(cells));
        let (reported, moved) = (reported_nm - own_nm, shaken_nm - own_nm);
        assert!(
            (reported / moved - 1.0).abs() < 0.2,
            "{cells}: {reported} {moved} nm"
        );
    }
    let lines = film
        .lines_m()
        .map(|lines| super::film_flight::cut(lines, 3));
    let third = own.film_on([&lines[0], &lines[1]]).expect("film");
    let carried = force(film, &q);
    let third = fly_from(&third, carried.into(), &q).expect("flies");
    let by_third = 9.0 / 8.0 * (1e9 * third.min_clearance_m - own_nm);
    let by_half = held_nm(Other::Continued) - own_nm;
    assert!(
        (by_half / by_third - 1.0).abs() < 0.1,
        "{by_half} {by_third} nm"
    );
}

/// Twice the gram load with the disk's roll, as 1 ms into that shock: halved and divided by three, all
/// cells of the layout of 2000 take the error of the clearance down with the second power of their size:
/// 0.6083, 0.5995 and 0.5975 nm.
#[test]
fn squeezed_clearance_converges_with_the_formal_order_on_nested_grids() {
    let own = squeezed(2000);
    let film = own.film().expect("film");
    let lines = film.lines_m().map(<[f64]>::to_vec);
    let load = [1.94 * GRAM_FORCE_N, 3.7e-7, -2.0e-7];
    let tilted = Attitude {
        centre_height_m: 0.0,
        pitch_rad: 127e-6,
        roll_rad: 13e-6,
    };
    let start = Attitude {
        centre_height_m: 0.6e-9 - film.min_clearance(&tilted).value_m,
        ..tilted
    };
    let clearance_nm = |cuts: usize| {
        let [x, y] = [&lines[0], &lines[1]].map(|lines| super::film_flight::cut(lines, cuts));
        let film = own.film_on([&x, &y]).expect("film");
        let flight = fly_from(&film, load, &start).expect("flies");
        flight.min_clearance_m * 1e9
    };
    let [whole, half, third] = [1, 2, 3].map(clearance_nm);
    // Errors of e, e/4 and e/9.
    let observed = (whole - half) / (half - third);
    assert!((observed / 5.4 - 1.0).abs() < 0.3, "{observed}");
}
