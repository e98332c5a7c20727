//! The default slider in flight: clearance, steady attitude, stiffness, impedance and modes against
//! an independent solver (`head_default_set.json`), and how few cells that takes.

use nalgebra::{Complex, Matrix3};
use opshock_solver::air_bearing::impedance::SmallMotion;
use opshock_solver::air_bearing::steady::{
    SteadyError, fixed_attitude, fly, fly_from, lower_equilibria,
};
use opshock_solver::air_bearing::{Attitude, Film, FilmResolution, FlowModel};
use opshock_solver::quantity::{GRAM_FORCE_N, rad_per_s_from_rpm};
use opshock_solver::slider::body::Inertia;
use opshock_solver::slider::{Rail, RailOutline, SliderParameters};
use opshock_tests::digests::assert_digest;
use opshock_tests::drives::most_carried;
use opshock_tests::heads::{default_slider, standard_gas};
use opshock_tests::{number, reference};
use serde_json::Value;

const LOAD_N: f64 = 2.2 * GRAM_FORCE_N;
const FLOOR_M: f64 = 0.3e-9;

fn film(slider: &SliderParameters, cells: usize) -> Film {
    let resolution = FilmResolution {
        cells,
        min_height_m: FLOOR_M,
        correction_cells: 0,
    };
    let spin = rad_per_s_from_rpm(5400.0);
    Film::build(
        slider,
        &standard_gas(),
        FlowModel::FukuiKaneko,
        spin,
        &resolution,
    )
    .unwrap()
}

/// The reference's own grid, every cell cut into `cuts` x `cuts`.
fn film_on(grid: &str, cuts: usize) -> Film {
    let data = reference("head_default_set.json");
    let lines: Vec<Vec<f64>> = (0..2)
        .map(|d| {
            let lines = data["parameters"]["grids"][grid][d].as_array().unwrap();
            cut(&lines.iter().map(number).collect::<Vec<f64>>(), cuts)
        })
        .collect();
    let spin = rad_per_s_from_rpm(5400.0);
    Film::on_grid(
        &default_slider(),
        &standard_gas(),
        FlowModel::FukuiKaneko,
        spin,
        FLOOR_M,
        [&lines[0], &lines[1]],
    )
    .unwrap()
}

/// Lines with every cell cut into `cuts`.
pub(super) fn cut(lines: &[f64], cuts: usize) -> Vec<f64> {
    let mut out = vec![lines[0]];
    for w in lines.windows(2) {
        for k in 1..=cuts {
            out.push(w[0] + (w[1] - w[0]) * k as f64 / cuts as f64);
        }
    }
    out
}

fn state(data: &Value, grid: &str) -> Value {
    let states = data["flying_states_grid_study"].as_array().unwrap();
    states.iter().find(|s| s["grid"] == grid).unwrap().clone()
}

#[test]
fn clearance_of_the_true_surface() {
    let data = reference("head_default_set.json");
    let held = &state(&data, "G0")["load_at_fixed_attitude"];
    let q: Vec<f64> = held["q"].as_array().unwrap().iter().map(number).collect();
    let attitude = Attitude {
        centre_height_m: q[0],
        pitch_rad: q[1],
        roll_rad: q[2],
    };
    let clearance = film(&default_slider(), 300).min_clearance(&attitude);
    let expected = number(&held["clearance_nm"]) * 1e-9;
    assert!(
        (clearance.value_m / expected - 1.0).abs() < 1e-9,
        "{clearance:?}"
    );
    assert!((clearance.x_m - 840e-6).abs() < 1e-12 && (clearance.y_m - 250e-6).abs() < 1e-12);
}

/// Converged: 9.15 ± 0.05 nm and 113.0 µrad; lift 3.66 and suction −1.46 gf. What it costs: the
/// error is below 3 % at 1000 cells, 0.4 % at 2400, 0.6 % at 4000 and 0.4 % at 8000, where a grid that
/// merely follows the edges has 24, 14 (2400 cells) and 5.6 % (8000). On coarse grids it goes up and down by as much
/// with the number of cells between two edges.
#[test]
fn default_slider_flies_at_its_converged_clearance() {
    for (cells, tolerance) in [(1000, 0.03), (2400, 0.005), (4000, 0.006), (8000, 0.004)] {
        let film = film(&default_slider(), cells);
        assert!((film.n_cells() as f64 / cells as f64 - 1.0).abs() < 0.1);
        let flight = fly(&film, [LOAD_N, 0.0, 0.0]).unwrap();
        assert_digest(&format!("reference flight {cells} cells"), &flight.psi);
        let clearance_nm = flight.min_clearance_m * 1e9;
        assert!(
            (clearance_nm / 9.15 - 1.0).abs() < tolerance,
            "{cells}: {clearance_nm}"
        );
        assert!(flight.attitude.roll_rad.abs() < 1e-12);
        assert!(flight.n_iterations <= 16, "{}", flight.n_iterations);
        if cells == 8000 {
            let pitch_urad = flight.attitude.pitch_rad * 1e6;
            assert!((pitch_urad - 113.0).abs() < 0.5, "{pitch_urad}");
            assert!((flight.lift_n / GRAM_FORCE_N - 3.665).abs() < 0.02);
            assert!((flight.suction_n / GRAM_FORCE_N + 1.465).abs() < 0.02);
            let lower = lower_equilibria(&film, [LOAD_N, 0.0, 0.0], &flight);
            assert!(lower.is_empty());
        }
    }
}

/// Halved and divided by three, all cells of the layout of 2000 take the error of the flying height
/// down with the second power of their size, the first of their number: 9.239, 9.180, 9.167 nm
/// against 9.155.
#[test]
fn flying_height_converges_with_the_formal_order_on_nested_grids() {
    let slider = default_slider();
    let lines = film(&slider, 2000).lines_m().map(<[f64]>::to_vec);
    let error = |cuts: usize| {
        let spin = rad_per_s_from_rpm(5400.0);
        let [x, y] = [&lines[0], &lines[1]].map(|lines| cut(lines, cuts));
        let gas = standard_gas();
        let flow = FlowModel::FukuiKaneko;
        let film = Film::on_grid(&slider, &gas, flow, spin, FLOOR_M, [&x, &y]).unwrap();
        fly(&film, [LOAD_N, 0.0, 0.0]).unwrap().min_clearance_m * 1e9 - 9.155
    };
    let whole = error(1);
    for cuts in [2, 3] {
        let order = (whole / error(cuts)).ln() / ((cuts * cuts) as f64).ln();
        assert!((order - 1.0).abs() < 0.2, "{cuts}: {order}");
    }
}

/// Stiffness of the converged flight to 1.5 %, at the same clearance: the reference's two finest
/// grids (9.66 and 9.37 nm) extrapolated linearly to where 8000 cells fly.
#[test]
fn static_stiffness_agrees_where_both_have_converged() {
    let data = reference("head_default_set.json");
    let film = film(&default_slider(), 8000);
    let flight = fly(&film, [LOAD_N, 0.0, 0.0]).unwrap();
    let (coarse, fine) = (state(&data, "G4"), state(&data, "G8"));
    let clearance = |s: &Value| number(&s["hmin_nm"]) * 1e-9;
    let t = (flight.min_clearance_m - clearance(&coarse)) / (clearance(&fine) - clearance(&coarse));
    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)] {
        let (a, b) = (number(&coarse["K"][i][j]), number(&fine["K"][i][j]));
        let expected = a + t * (b - a);
        let found = flight.stiffness[i][j];
        assert!(
            (found / expected - 1.0).abs() < 0.015,
            "K[{i}][{j}] {found:e} {expected:e}"
        );
    }
}

/// On the reference's own grid of 2162 cells, held in its flying attitude. Both discretisations are
/// some per cent from converged there (their clearances differ by 0.7 nm of 10), so stiffness
/// agrees to 5 %, to 8 % at 10 kHz where gas waves are as long as the slider, the low damping to
/// 12 %; the free slider's modes agree to 3 %. At 100 kHz the reference's roll stiffness (2.098e-2 N m) is itself
/// 6 % above that of this grid with every cell cut in four (1.971e-2): 1.993e-2 is found.
#[test]
fn impedance_and_modes_at_the_reference_attitude() {
    let data = reference("head_default_set.json");
    let flown = state(&data, "G2");
    let attitude = Attitude {
        centre_height_m: number(&flown["hc_nm"]) * 1e-9,
        pitch_rad: number(&flown["pitch_urad"]) * 1e-6,
        roll_rad: 0.0,
    };
    let film = film_on("G2", 1);
    assert_eq!(film.n_cells(), 2162);
    let held = fixed_attitude(&film, &attitude).unwrap();
    let mut motion = SmallMotion::new(&film, &held.psi, &attitude);
    for row in data["impedance_G2"]["rows"].as_array().unwrap() {
        let frequency_hz = number(&row["f"]);
        let z = motion.impedance(frequency_hz).unwrap();
        let tolerance = match frequency_hz {
            1e4 => 0.08,
            1e5 => 0.06,
            _ => 0.05,
        };
        for i in 0..3 {
            let expected = number(&row["K"][i][i]);
            let found = z[(i, i)].re;
            assert!(
                (found / expected - 1.0).abs() < tolerance,
                "{frequency_hz} Hz K[{i}]: {found:e}"
            );
        }
        if frequency_hz <= 1e4 {
            let found = z[(0, 0)].im / (std::f64::consts::TAU * frequency_hz);
            let expected = number(&row["C"][0][0]);
            assert!(
                (found / expected - 1.0).abs() < 0.12,
                "{frequency_hz} Hz C: {found}"
            );
        }
    }
    let modes = motion
        .free_modes(Inertia::of(&default_slider()).diagonal())
        .unwrap();
    let expected = data["air_bearing_modes_G2_free_slider"].as_array().unwrap();
    for (mode, row) in modes.iter().zip(expected) {
        let frequency_hz = number(&row["f_Hz"]);
        assert!(
            (mode.frequency_hz / frequency_hz - 1.0).abs() < 0.03,
            "{mode:?}"
        );
        assert!(mode.damping_ratio > 0.0 && mode.damping_ratio < 0.05);
    }
}

/// Z(f)[i][j] of a row of a reference.
fn tabled(row: &Value, i: usize, j: usize) -> Complex<f64> {
    let omega = std::f64::consts::TAU * number(&row["f"]);
    Complex::new(number(&row["K"][i][j]), omega * number(&row["C"][i][j]))
}

/// Z at the frequencies of the independent scheme's table, in flight.
fn impedance_in_flight(film: &Film, frequencies_hz: &[f64]) -> Vec<Matrix3<Complex<f64>>> {
    let flight = fly(film, [LOAD_N, 0.0, 0.0]).unwrap();
    let mut motion = SmallMotion::new(film, &flight.psi, &flight.attitude);
    let rows = frequencies_hz.iter();
    rows.map(|&f| motion.impedance(f).unwrap()).collect()
}

/// Two grids extrapolated to cells of no size, with the first order that film edges leave.
fn continued<T>(coarse: T, fine: T, cuts: [f64; 2]) -> T
where
    T: std::ops::Mul<f64, Output = T> + std::ops::Sub<Output = T>,
{
    let [c, f] = cuts;
    fine * (f / (f - c)) - coarse * (c / (f - c))
}

/// The largest |Z − Z_ref|/|Z_ref| over heave, pitch and roll and their coupling. Z_ref: the
/// independent scheme's grids of 8648 and 34592 cells, extrapolated.
fn impedance_error(found: &[Matrix3<Complex<f64>>], wanted: impl Fn(f64) -> bool) -> f64 {
    let data = reference("impedance_plain_scheme.json");
    let [coarse, fine] = [1, 2].map(|k| data["grids"][k]["rows"].as_array().unwrap());
    let mut worst = 0.0_f64;
    for ((z, coarse), fine) in found.iter().zip(coarse).zip(fine) {
        let frequency_hz = number(&fine["f"]);
        if !wanted(frequency_hz) {
            continue;
        }
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)] {
            let limit = continued(tabled(coarse, i, j), tabled(fine, i, j), [2.0, 4.0]);
            let error = (z[(i, j)] - limit).norm() / limit.norm();
            println!("{frequency_hz} Hz, Z[{i}][{j}]: {error:.2e}");
            worst = worst.max(error);
        }
    }
    worst
}

fn frequencies_hz() -> Vec<f64> {
    let data = reference("impedance_plain_scheme.json");
    let rows = data["grids"][0]["rows"].as_array().unwrap();
    rows.iter().map(|row| number(&row["f"])).collect()
}

/// Impedance from 1 Hz to 500 kHz against a scheme that shares no code with this one, on the grid
/// laid out for the flying state: 1.8 % at 8118 cells. At 50 and 100 kHz, where gas waves are as long as pads, the
/// limit of the other scheme is no better known: its finest grids say 1.68e6 + 0.110e6 i and 1.70e6 + 0.069e6 i N/m
/// for the heave, extrapolated 1.69 + 0.087 and 1.74 + 0.064, and 32058 cells here 1.67 + 0.066 and 1.70 + 0.055 (off those
/// 8220 cells are 1.5 and 1.6 %).
#[test]
fn impedance_agrees_with_an_independent_scheme() {
    let found = impedance_in_flight(&film(&default_slider(), 8000), &frequencies_hz());
    let parts = found
        .iter()
        .flat_map(|z| z.iter().flat_map(|z| [z.re, z.im]));
    assert_digest("reference impedance", &parts.collect::<Vec<f64>>());
    let is_wave = |f: f64| f == 5e4 || f == 1e5;
    let others = impedance_error(&found, |f| !is_wave(f));
    assert!(others < 0.018, "{others}");
    let waves = impedance_error(&found, is_wave);
    assert!(waves < 0.1, "{waves}");
}

/// On one family of grids, extrapolated to cells of no size: within 0.8 % at 1 Hz to 10 kHz and at 500 kHz.
/// In between the film's gas waves, which coarse grids damp, make the approach to the limit oscillate; there the
/// finest grids are compared as they are (34592 cells each): stiffness within 3 %, and Z within
/// 2 % at 200 kHz, 3.5 % at 100 kHz and 6.5 % at 50 kHz, where the imaginary parts still move towards each other.
#[test]
#[ignore = "slow: about 40 s"]
fn film_slow_impedance_continued_to_its_limit() {
    let all = frequencies_hz();
    let [coarse, fine] = [2, 3].map(|cuts| impedance_in_flight(&film_on("G2", cuts), &all));
    let found: Vec<_> = coarse
        .into_iter()
        .zip(fine)
        .map(|(c, f)| Matrix3::from_fn(|i, j| continued(c[(i, j)], f[(i, j)], [2.0, 3.0])))
        .collect();
    let waves = |f: f64| [5e4, 1e5, 2e5].contains(&f);
    let error = impedance_error(&found, |f| !waves(f));
    assert!(error < 0.008, "{error}");

    let data = reference("impedance_plain_scheme.json");
    let finest = impedance_in_flight(&film_on("G2", 4), &[5e4, 1e5, 2e5]);
    let rows = data["grids"][2]["rows"].as_array().unwrap();
    let rows = rows.iter().filter(|row| waves(number(&row["f"])));
    for ((row, z), bound) in rows.zip(&finest).zip([0.065, 0.035, 0.02]) {
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)] {
            let expected = tabled(row, i, j);
            let error = (z[(i, j)] - expected).norm() / expected.norm();
            let stiffness = z[(i, j)].re / expected.re - 1.0;
            println!(
                "{} Hz, Z[{i}][{j}]: {error:.2e}, stiffness {stiffness:.2e}",
                row["f"]
            );
            assert!(error < bound && stiffness.abs() < 0.03);
        }
    }
}

/// From 10 µm, from 0.1 nm, with the pitch of the wrong sign.
#[test]
fn hard_c12_bad_first_attitudes_reach_the_same_flight() {
    let film = film(&default_slider(), 1000);
    let load = [LOAD_N, 0.0, 0.0];
    let flown = fly(&film, load).unwrap();
    let touching = flown.attitude.centre_height_m - flown.min_clearance_m;
    for (centre_height_m, pitch_rad, roll_rad) in [
        (1e-5, 1e-4, 0.0),
        (touching + 1e-10, flown.attitude.pitch_rad, 0.0),
        (1e-7, -1e-4, 0.0),
        (1e-7, 1e-4, 1e-4),
    ] {
        let start = Attitude {
            centre_height_m,
            pitch_rad,
            roll_rad,
        };
        let other = fly_from(&film, load, &start).unwrap();
        assert!(
            (other.min_clearance_m / flown.min_clearance_m - 1.0).abs() < 1e-9,
            "{start:?}"
        );
    }
}

fn thin_margin_slider() -> SliderParameters {
    let mut slider = default_slider();
    slider.radius_m = 22.215e-3;
    for (rail, width) in [(6, 205e-6), (7, 125e-6)] {
        let RailOutline::Rectangle { y_m, .. } = &mut slider.surface.rails[rail].outline else {
            panic!("rail {rail} is a rectangle");
        };
        *y_m = [350e-6 - 0.5 * width, 350e-6 + 0.5 * width];
    }
    slider
}

/// The thin-margin surface (centre step 205 µm wide, centre pad 125 µm, 0.948 gf at r 22.215 mm):
/// 3.64 nm converged.
#[test]
fn thin_margin_slider_flies_at_three_point_seven_nanometres() {
    let slider = thin_margin_slider();
    for (cells, tolerance) in [(2000, 0.025), (4000, 0.01)] {
        let flight = fly(&film(&slider, cells), [0.948 * GRAM_FORCE_N, 0.0, 0.0]).unwrap();
        let found = flight.min_clearance_m * 1e9;
        assert!((found / 3.64 - 1.0).abs() < tolerance, "{cells}: {found}");
    }
}

/// Both surfaces at 16000 cells, one more halving of the error: 9.15 ± 0.05 nm and 113.0 µrad as the
/// reference converges to, and 3.64 nm as our own sequence of grids does.
#[test]
#[ignore = "slow: about 30 s"]
fn film_slow_both_surfaces_converge() {
    let flight = fly(&film(&default_slider(), 16000), [LOAD_N, 0.0, 0.0]).unwrap();
    let (found, pitch) = (
        flight.min_clearance_m * 1e9,
        flight.attitude.pitch_rad * 1e6,
    );
    println!("drive-2.5in: {found:.4} nm, {pitch:.3} urad");
    assert!((found - 9.15).abs() < 0.05, "{found}");
    assert!((pitch - 113.0).abs() < 0.2, "{pitch}");
    let flight = fly(
        &film(&thin_margin_slider(), 16000),
        [0.948 * GRAM_FORCE_N, 0.0, 0.0],
    )
    .unwrap();
    let found = flight.min_clearance_m * 1e9;
    println!("fig13: {found:.4} nm");
    assert!((found - 3.64).abs() < 0.03, "{found}");
}

/// The layout serves any surface: a slanted, skewed one with a tapered leading edge flies at 2.47 nm (32000 cells),
/// within 3 % of it on 6000 cells and 12 % on 1500. Slanted sides are followed in steps, which converge with the first
/// order only. (With ψ carried across the slider to the first order, 1500 and 6000 cells came within 4 % of each other
/// here, and at a skew of 8 degrees 1500 missed 27 %.)
#[test]
fn layout_serves_slanted_rails_and_skew() {
    let mut slider = default_slider();
    slider.skew_rad = 4f64.to_radians();
    slider.surface.taper_length_m = 20e-6;
    slider.surface.taper_angle_rad = 0.01;
    slider.surface.rails[7] = Rail {
        outline: RailOutline::Polygon {
            points_m: vec![
                [710e-6, 270e-6],
                [840e-6, 240e-6],
                [840e-6, 460e-6],
                [710e-6, 430e-6],
            ],
        },
        recess_m: 0.0,
    };
    for (cells, tolerance) in [(1500, 0.12), (6000, 0.03)] {
        let flight = fly(&film(&slider, cells), [LOAD_N, 0.0, 0.0]).unwrap();
        let found = 1e9 * flight.min_clearance_m;
        assert!((found / 2.468 - 1.0).abs() < tolerance, "{cells}: {found}");
    }
}

/// Wind across the slider is followed to the second order as that along it: 7.19 nm at 4 degrees and 4.77 nm at 8
/// (32000 cells) within 1.5 % on 16000, of which the first order missed 2.3 % at 8 degrees.
#[test]
fn skewed_slider_converges_on_fine_grids() {
    for (skew_deg, limit_nm) in [(4.0_f64, 7.19), (8.0, 4.77)] {
        let mut slider = default_slider();
        slider.skew_rad = skew_deg.to_radians();
        let flight = fly(&film(&slider, 16000), [LOAD_N, 0.0, 0.0]).unwrap();
        let found = 1e9 * flight.min_clearance_m;
        assert!(
            (found / limit_nm - 1.0).abs() < 0.015,
            "{skew_deg}: {found}"
        );
    }
}

/// The load at which followed flights end is the most that quasi-static films carry; under a little less one flies.
#[test]
fn load_that_cannot_be_carried_is_reported_with_the_most_that_can() {
    let film = film(&default_slider(), 300);
    let load_n = 10.0 * GRAM_FORCE_N;
    let Err(SteadyError::CannotFly {
        carried_n,
        clearance_m,
        ..
    }) = fly(&film, [load_n, 0.0, 0.0])
    else {
        panic!("flies under {load_n} N");
    };
    let (most_n, _) = most_carried(&film, 0.9);
    assert!(
        (carried_n / most_n - 1.0).abs() < 0.02,
        "{carried_n:e} {most_n:e}"
    );
    assert!(clearance_m > 0.0);
    let lighter = fly(&film, [0.99 * carried_n, 0.0, 0.0]).expect("flies");
    assert!(lighter.min_clearance_m > clearance_m);
}
