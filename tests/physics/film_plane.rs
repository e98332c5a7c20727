//! Plane sliders: an independent solution of the ordinary differential equation (backward shooting,
//! 1e-10), closed limits, a square slider with its Richardson value, and exact symmetries.

use opshock_solver::air_bearing::FlowModel;
use opshock_tests::digests::assert_digest;
use opshock_tests::films::{Held, PlaneSlider, crowded, crowded_twice, model, uniform};
use opshock_tests::sheet::at_most;
use opshock_tests::{number, reference};

fn richardson(coarse: f64, fine: f64) -> f64 {
    (4.0 * fine - coarse) / 3.0
}

/// Load of every case to 1e-5 and its order in the cell size.
///
/// The order is asked for where the outlet layer (a share 1/Λ of the length) spans cells; beyond,
/// the layer contributes through the profile inside the last cell and errors are small at once.
#[test]
fn wide_plane_slider_reaches_the_ode_solution_with_order_two() {
    let data = reference("plane_slider_1d.json");
    let cases = data["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 18);
    let mut all = Vec::new();
    for case in cases {
        let bearing_number = number(&case["Lambda"]);
        let slider = PlaneSlider::wide(
            model(case["model"].as_str().unwrap()),
            number(&case["H"]),
            bearing_number,
            number(&case["Kn_trailing"]),
        );
        let crowding = if bearing_number > 5e3 { 8.0 } else { 4.0 };
        let [a, b, c] = [64, 128, 256].map(|n| slider.hold_row(&crowded(n, crowding)));
        let (load, centre) = (number(&case["W"]), number(&case["Xcp"]));
        all.extend([&a, &b, &c].map(|row| row.load));
        let found = richardson(b.load, c.load);
        at_most(
            "plane-slider",
            "relative error of the load, extrapolated from 128 and 256 cells",
            (found / load - 1.0).abs(),
            1e-5,
        );
        let found = richardson(b.centre, c.centre);
        at_most(
            "plane-slider",
            "relative error of the centre of pressure, likewise",
            (found / centre - 1.0).abs(),
            2e-5,
        );
        // Where the leading coefficient all but vanishes there is no order to speak of.
        if bearing_number <= 100.0 && (c.load / load - 1.0).abs() > 3e-6 {
            let order = ((a.load - b.load) / (b.load - c.load)).abs().log2();
            at_most(
                "plane-slider",
                "distance of the order of convergence from 2",
                (order - 2.0).abs(),
                0.15,
            );
        }
    }
    assert_digest("reference plane_slider_1d", &all);
}

/// First-order slip, H = 2 − x: load and peak within 0.1 % at 64 cells crowding at the outlet.
#[test]
fn hard_c1_sixty_four_cells_give_load_and_peak_to_a_thousandth() {
    for (knudsen, bearing_number, load, centre, peak) in [
        (0.0, 1.0, 0.02638214, 0.5760537, 1.0418171),
        (0.0, 10.0, 0.21002882, 0.6228682, 1.3612459),
        (0.0, 100.0, 0.37074123, 0.6940930, 1.8515775),
        (0.0, 1000.0, 0.38478901, 0.7045057, 1.9759700),
        (0.1, 1.0, 0.01873479, 0.5672862, 1.0293653),
        (0.1, 10.0, 0.16714721, 0.6068856, 1.2788680),
        (0.1, 100.0, 0.36438729, 0.6894843, 1.8155337),
        (0.1, 1000.0, 0.38418563, 0.7040477, 1.9695566),
        (1.0, 1.0, 0.00521583, 0.5517479, 1.0080184),
        (1.0, 10.0, 0.05263369, 0.5653839, 1.0822948),
        (1.0, 100.0, 0.30365885, 0.6507819, 1.5795284),
        (1.0, 1000.0, 0.37872234, 0.6999230, 1.9207217),
    ] {
        let slider = PlaneSlider::wide(FlowModel::Slip1, 2.0, bearing_number, knudsen);
        let held = slider.hold_row(&crowded(64, 4.0));
        let place = format!("Kn {knudsen} Λ {bearing_number}");
        assert!(
            (held.load / load - 1.0).abs() < 1e-3,
            "{place}: {}",
            held.load
        );
        assert!(
            (held.centre / centre - 1.0).abs() < 1e-3,
            "{place}: {}",
            held.centre
        );
        let found = largest(&held);
        assert!((found / peak - 1.0).abs() < 1e-3, "{place}: {found}");
    }
}

fn largest(held: &Held) -> f64 {
    held.pressure
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Λ to 0 and to infinity; no pressure outside what p h = const allows.
#[test]
fn hard_c2_limits_of_the_bearing_number_and_no_new_extrema() {
    let limits = reference("film_limits_1d.json");
    let hold = |bearing_number: f64| {
        PlaneSlider::wide(FlowModel::Continuum, 2.0, bearing_number, 0.0)
            .hold_row(&crowded(512, 4.0))
    };
    let slow = [hold(1e-4), hold(1e-2)];
    assert_digest(
        "reference film_limits_1d",
        &slow.each_ref().map(|row| row.load),
    );
    let expected = number(&limits["W_over_Lambda_zero"]);
    for (slow, bearing_number) in slow.iter().zip([1e-4, 1e-2]) {
        at_most(
            "bearing-number-limits",
            "relative error of load over bearing number, at 1e-4 and 1e-2",
            (slow.load / bearing_number / expected - 1.0).abs(),
            1e-3,
        );
    }

    let expected = number(&limits["W_infinite"]);
    for bearing_number in [1e4, 1e5, 1e6, 1e7] {
        let held = hold(bearing_number);
        let tolerance = 5.0 / bearing_number + 2e-6;
        at_most(
            "bearing-number-limits",
            "relative error of the load from 1e4 to 1e7, of 5/Λ + 2e-6",
            (held.load / expected - 1.0).abs() / tolerance,
            1.0,
        );
        let x = crowded(512, 4.0);
        for (i, p) in held.pressure.iter().enumerate() {
            let h = 2.0 - 0.5 * (x[i] + x[i + 1]);
            assert!(
                *p >= 1.0 - 1e-12 && *p <= 2.0 / h * (1.0 + 1e-12),
                "{bearing_number}: {p}"
            );
        }
    }
    // Carried by the wind alone p h keeps its inlet value to the last bits.
    let carried = hold(1e7);
    let inlet = carried.pressure[0] * (2.0 - 0.5 * crowded(512, 4.0)[1]);
    assert!((inlet - 2.0).abs() < 1e-13);
}

#[test]
fn square_plane_slider_reaches_its_richardson_value() {
    let data = reference("plane_slider_square.json");
    let mut all = Vec::new();
    for case in data["cases"].as_array().unwrap() {
        let bearing_number = number(&case["Lambda"]);
        let slider = PlaneSlider::square(
            model(case["model"].as_str().unwrap()),
            number(&case["H"]),
            bearing_number,
            number(&case["Kn_trailing"]),
        );
        let crowding = if bearing_number > 50.0 { 4.0 } else { 2.0 };
        let n = if bearing_number > 50.0 { 100 } else { 80 };
        let [coarse, fine] =
            [n / 2, n].map(|n| slider.hold(&crowded(n, crowding), &crowded_twice(n)));
        let load = number(&case["W_richardson"][0]);
        all.extend([coarse.load, fine.load]);
        let found = richardson(coarse.load, fine.load);
        at_most(
            "square-slider",
            "relative error of the load, extrapolated",
            (found / load - 1.0).abs(),
            1e-4,
        );
        let centre = number(&case["Xcp_richardson"][0]);
        at_most(
            "square-slider",
            "relative error of the centre of pressure on the finer grid",
            (fine.centre / centre - 1.0).abs(),
            1e-4,
        );
    }
    assert_digest("reference plane_slider_square", &all);
}

/// Parallel, with or without wind, with every model: ambient everywhere.
#[test]
fn flat_slider_stays_at_ambient_pressure() {
    for model in [
        FlowModel::Continuum,
        FlowModel::Slip1,
        FlowModel::Slip2,
        FlowModel::FukuiKaneko,
    ] {
        for bearing_number in [0.0, 1.0, 1e3, 1e6] {
            let mut slider = PlaneSlider::square(model, 1.0, bearing_number, 0.7);
            slider.skew_rad = 0.3;
            let held = slider.hold(&crowded(20, 2.0), &uniform(15, 1.0));
            for p in &held.pressure {
                assert!((p - 1.0).abs() < 1e-14, "{model:?} {bearing_number}: {p}");
            }
            assert!(held.load.abs() < 1e-14, "{}", held.load);
        }
    }
}

/// Without wind a tilted slider feels nothing, however tilted.
#[test]
fn tilted_slider_at_rest_stays_at_ambient_pressure() {
    let held = PlaneSlider::square(FlowModel::FukuiKaneko, 3.0, 0.0, 0.7)
        .hold(&uniform(12, 1.0), &uniform(9, 1.0));
    for p in &held.pressure {
        assert!((p - 1.0).abs() < 1e-12, "{p}");
    }
}

#[test]
fn hard_c9_roll_and_skew_have_their_mirror_images() {
    let lines = (crowded_twice(24), crowded_twice(18));
    let mut slider = PlaneSlider::square(FlowModel::FukuiKaneko, 2.0, 300.0, 0.5);
    slider.recesses = vec![([0.1, 0.3], [0.2, 0.8], 4.0)];

    // Roll, and skew, to one side and to the other.
    let force = |roll: f64, skew: f64| {
        let mut slider = slider.clone();
        slider.skew_rad = skew;
        let film = slider.film(&lines.0, &lines.1);
        let mut attitude = slider.attitude();
        attitude.roll_rad = roll;
        opshock_solver::air_bearing::steady::fixed_attitude(&film, &attitude)
            .unwrap()
            .force
    };
    for (roll, skew) in [(3e-5, 0.0), (0.0, 0.5), (2e-5, -0.5)] {
        let (one, other) = (force(roll, skew), force(-roll, -skew));
        assert!((one[0] - other[0]).abs() < 1e-12 * one[0].abs());
        assert!((one[1] - other[1]).abs() < 1e-12 * one[1].abs());
        assert!((one[2] + other[2]).abs() < 1e-12 * one[2].abs());
    }
    let level = force(0.0, 0.0);
    assert!(level[2].abs() < 1e-13 * level[0] * 1e-3);

    // Wind from behind on a slider built the other way round.
    let flip = |range: [f64; 2]| [1.0 - range[1], 1.0 - range[0]];
    let mut behind = slider.clone();
    behind.skew_rad = std::f64::consts::PI;
    behind.recesses = slider
        .recesses
        .iter()
        .map(|(x, y, depth)| (flip(*x), *y, *depth))
        .collect();
    let film = behind.film(&lines.0, &lines.1);
    let mut attitude = slider.attitude();
    attitude.pitch_rad = -attitude.pitch_rad;
    let turned = opshock_solver::air_bearing::steady::fixed_attitude(&film, &attitude)
        .unwrap()
        .force;
    assert!(
        (turned[0] / level[0] - 1.0).abs() < 1e-12,
        "{turned:?} {level:?}"
    );
    assert!((turned[1] / level[1] + 1.0).abs() < 1e-11);
}
