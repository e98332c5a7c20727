//! Pressure fields at asked times: what they agree with, and that keeping them changes nothing.

use opshock_solver::air_bearing::Attitude;
use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::{
    Bearing, Model, Outcome, PressureFields, Request, Verdict, Workspace, simulate,
};
use opshock_tests::pairs::coarse;
use opshock_tests::scenes;

fn scene(cells: usize, tolerance: f64) -> Scene {
    let mut scene = coarse(scenes::scene("fig13-stiffness", "none", 0.5, &[]));
    scene.film_resolution.cells = cells;
    scene.head_resolution.tolerance = tolerance;
    scene
}

fn run(scene: &Scene, amplitude_g: f64, times_s: &[f64], record: bool) -> Outcome {
    let plan = Plan::new(&[Output::PressureField], Mode::Auto).with_field_times(times_s);
    let model = Model::assemble(scene, &plan, None).expect("the scene builds");
    let request = Request {
        amplitude_m_per_s2: m_per_s2_from_g(amplitude_g),
        record,
    };
    simulate(&model, &request, &mut Workspace::default())
}

fn fields(outcome: &Outcome) -> &PressureFields {
    let history = outcome.history.as_ref().expect("recorded");
    history.fields.as_ref().expect("asked for")
}

/// Middle of every cell, in the fields' order, m.
fn cells(fields: &PressureFields) -> Vec<[f64; 2]> {
    let middles = |lines: &[f64]| -> Vec<f64> {
        let pairs = lines.windows(2);
        pairs.map(|w| 0.5 * (w[0] + w[1])).collect()
    };
    let (x, y) = (middles(&fields.x_lines_m), middles(&fields.y_lines_m));
    y.iter()
        .flat_map(|y| x.iter().map(move |x| [*x, *y]))
        .collect()
}

/// The same steps, numbers and verdict with fields, without, and without a record; nothing is kept
/// unless asked for and recorded.
#[test]
fn keeping_fields_changes_no_other_number() {
    let scene = scene(150, 0.02);
    let times_s = [7e-4, -1e-4, 0.0, 1.3e-4, 3e-4];
    let with = run(&scene, 120.0, &times_s, true);
    let mut without = run(&scene, 120.0, &[], true);
    assert_eq!(without.history.as_ref().unwrap().fields, None);
    assert_eq!(run(&scene, 120.0, &times_s, false).history, None);
    assert_eq!(fields(&with).time_s, [-1e-4, 0.0, 1.3e-4, 3e-4, 7e-4]);
    without.history.as_mut().unwrap().fields = Some(fields(&with).clone());
    assert_eq!(with, without);
}

/// A slider is rigid: between two times the gap changes by a plane. It is never below the smallest
/// clearance reported for that time, and no pressure is negative.
#[test]
fn gaps_move_as_a_plane_and_pressures_are_positive() {
    let scene = scene(300, 0.01);
    let times_s = [0.0, 2e-4, 4e-4, 6e-4];
    let outcome = run(&scene, 150.0, &times_s, true);
    assert_eq!(outcome.verdict, Some(Verdict::Survives));
    let fields = fields(&outcome);
    let (n, cells) = (fields.n_cells(), cells(fields));
    let smallest = outcome.min_clearance_m.expect("a head");
    assert!(fields.pressure_pa.iter().all(|&p| p > 0.0));
    assert!(fields.gap_m.iter().all(|&h| h >= smallest));
    let (corner, along, across) = (
        0,
        fields.x_lines_m.len() - 2,
        n + 1 - fields.x_lines_m.len(),
    );
    for k in 1..times_s.len() {
        let change = |i: usize| fields.gap_m[k * n + i] - fields.gap_m[i];
        let slope =
            |i: usize, d: usize| (change(i) - change(corner)) / (cells[i][d] - cells[corner][d]);
        let slopes = [slope(along, 0), slope(across, 1)];
        assert!(
            slopes.iter().any(|s| s.abs() > 1e-8),
            "the slider moves: {slopes:?}"
        );
        for i in 0..n {
            let from = |d: usize| cells[i][d] - cells[corner][d];
            let plane = change(corner) + slopes[0] * from(0) + slopes[1] * from(1);
            assert!(
                (change(i) - plane).abs() < 1e-18 + 1e-11 * plane.abs(),
                "cell {i}"
            );
        }
    }
}

/// Pressure and gap of a step give back force and moments of the film in the history: the
/// attitude from how the gap changed since steady flight, the film's state from p and h.
#[test]
fn fields_carry_the_bearing_force_and_moments() {
    let scene = scene(400, 0.02);
    let plain = run(&scene, 100.0, &[], true);
    let head = &plain.history.as_ref().unwrap().head;
    let row = head.time_s.iter().position(|&t| t > 3e-4).expect("a step");
    let outcome = run(&scene, 100.0, &[0.0, head.time_s[row]], true);
    let fields = fields(&outcome);
    let (n, nx, cells) = (fields.n_cells(), fields.x_lines_m.len() - 1, cells(fields));

    let bearing = Bearing::build(&scene, None).expect("flies");
    let (film, steady) = (&bearing.film, &bearing.flight.attitude);
    let change = |i: usize| fields.gap_m[n + i] - fields.gap_m[i];
    let along = (change(nx - 1) - change(0)) / (cells[nx - 1][0] - cells[0][0]);
    let across = (change(n - nx) - change(0)) / (cells[n - nx][1] - cells[0][1]);
    let centre = film.extent_m().map(|extent| 0.5 * extent);
    let rise = change(0) + along * (centre[0] - cells[0][0]) + across * (centre[1] - cells[0][1]);
    let attitude = Attitude {
        centre_height_m: steady.centre_height_m + rise,
        pitch_rad: steady.pitch_rad - along,
        roll_rad: steady.roll_rad + across,
    };
    // psi = p h, with h as the film sees it: ambient psi over ambient pressure.
    let mut psi = vec![0.0; n];
    film.ambient_psi(&attitude, &mut psi);
    for i in 0..n {
        psi[film.cell_index(i % nx, i / nx)] *= fields.pressure_pa[n + i] / film.ambient_pa();
    }
    let of_field = film.force(&psi, &attitude, &mut film.scratch());
    let of_history = [
        head.bearing_force_n[row],
        head.bearing_pitch_n_m[row],
        head.bearing_roll_n_m[row],
    ];
    println!("{of_field:?} of the field, {of_history:?} of the history");
    let arm_m = [1.0, centre[0], centre[1]];
    for k in 0..3 {
        let apart = (of_field[k] - of_history[k]).abs() / (of_history[0] * arm_m[k]);
        assert!(apart < 1e-6, "{k}: {of_field:?} {of_history:?}");
    }
    // A shock of 100 G turns the slider; in steady flight nothing does.
    let moment = |row: usize| head.bearing_pitch_n_m[row].abs() / (of_history[0] * centre[0]);
    assert!(
        moment(0) < 1e-7 && moment(row) > 1e-4,
        "{:e} {:e}",
        moment(0),
        moment(row)
    );
}

/// Between steps: a run with steps ten times as accurate gives the same field.
#[test]
fn fields_between_steps_are_those_of_finer_steps() {
    let times_s = [1.234e-4, 3.21e-4, 6.54e-4];
    let [coarse, fine] = [1e-2, 1e-4].map(|tolerance| {
        let outcome = run(&scene(200, tolerance), 120.0, &times_s, true);
        fields(&outcome).clone()
    });
    let n = coarse.n_cells();
    for k in 0..times_s.len() {
        let peak = fine.pressure_pa[k * n..(k + 1) * n]
            .iter()
            .fold(0.0_f64, |a, b| a.max(*b));
        let apart = (k * n..(k + 1) * n)
            .map(|i| (coarse.pressure_pa[i] - fine.pressure_pa[i]).abs() / peak)
            .fold(0.0, f64::max);
        println!("field {k}: {apart:.1e} of the peak");
        assert!(apart < 1e-2, "field {k}: {apart:e}");
    }
}

/// A run that ends at touch has the fields up to there.
#[test]
fn fields_end_at_the_touch() {
    let scene = scene(150, 0.02);
    let Some(Verdict::Fails { t_fail_s, .. }) = run(&scene, 600.0, &[], true).verdict else {
        panic!("600 G touch");
    };
    let times_s = [0.0, 0.5 * t_fail_s, t_fail_s, 1.001 * t_fail_s];
    let outcome = run(&scene, 600.0, &times_s, true);
    let fields = fields(&outcome);
    assert_eq!(fields.time_s, times_s[..3]);
    assert_eq!(fields.gap_m.len(), 3 * fields.n_cells());
    // The corner that touches lies outside the middles of the cells.
    let lowest = fields.gap_m.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(lowest > 0.0 && lowest < 1e-7, "{lowest:e}");
}
