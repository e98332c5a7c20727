//! Contact of asperities: closed forms on plates, derivatives, bounces, and a head that touches and flies again.

use nalgebra::Vector3;
use opshock_solver::air_bearing::Attitude;
use opshock_solver::air_bearing::gap_forces::AsperityContact;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::{Model, Outcome, Request, Verdict, Workspace, simulate};
use opshock_solver::slider::{RailOutline, SliderParameters, SurfaceParameters};
use opshock_tests::heads::{default_slider, gap_load};
use opshock_tests::rough::{
    AfterBounces, Bounces, ELASTIC, INTEGRALS, ROUGH, SOFT, film, level, moment_of_pressure,
    padded, plate, struck, unit_pressure_pa,
};
use opshock_tests::scenes;
use opshock_tests::sheet::at_most;

/// Its sheet in the verification manual.
const SHEET: &str = "asperity-contact";

#[test]
fn plates_bear_greenwood_and_williamsons_load_with_coulombs_friction() {
    let (mut force_error, mut moment_error) = (0.0_f64, 0.0_f64);
    for skew_deg in [0.0, 12.0, -7.0] {
        let slider = plate(skew_deg);
        let film = film(&slider, ELASTIC);
        let area = slider.length_m * slider.width_m;
        let unit = unit_pressure_pa(&ELASTIC);
        for (x, integral) in INTEGRALS.into_iter().filter(|(x, _)| *x >= 0.0) {
            let load = gap_load(&film, &level(x * 0.5e-9));
            let force = area * unit * integral;
            force_error = force_error.max((load.force[0] / force - 1.0).abs());
            // Friction μ F along the disk's motion, which the skew turns; its lever is the slider's height.
            let [vx, vy] = film.disk_velocity_m_per_s();
            let couple = 0.3 * force * slider.height_m / vx.hypot(vy);
            let expected = [-couple * vx, couple * vy];
            for (moment, expected) in load.force[1..].iter().zip(expected) {
                moment_error =
                    moment_error.max((moment - expected).abs() / (couple * vx.hypot(vy)));
            }
            let along = load.in_plane_n.expect("friction is in the plane");
            moment_error = moment_error.max((along[0].hypot(along[1]) / (0.3 * force) - 1.0).abs());
        }
    }
    at_most(SHEET, "normal force, relative", force_error, 1e-8);
    at_most(SHEET, "friction, relative", moment_error, 1e-8);
}

/// A plane corner h = h0 + a u + b v over u, v >= 0 bears 1/(a b) times the integral of s p(h0 + s) over s.
#[test]
fn a_corner_bears_what_its_patch_bears() {
    let plate = plate(0.0);
    let [x_m, y_m] = [plate.length_m, plate.width_m]
        .map(|extent_m| [2.0, 9.0].map(|line| line / 12.0 * extent_m));
    let pad = padded(RailOutline::Rectangle { x_m, y_m });
    let nominal = ROUGH.nominal();
    let mut worst = 0.0_f64;
    for slider in [plate, pad] {
        let film = film(&slider, ROUGH);
        for (depth_m, pitch_rad, roll_rad) in [
            (5e-9, 1e-3, 5e-3),
            (50e-9, -1e-3, 5e-3),
            (20e-9, 1e-4, -3e-4),
            (10e-9, -5e-3, -14e-3),
        ] {
            let at = struck(&slider, &film, depth_m, [pitch_rad, roll_rad]);
            let force = moment_of_pressure(&nominal, depth_m, 1) / (pitch_rad * roll_rad).abs();
            let found = gap_load(&film, &at).force[0];
            worst = worst.max((found / force - 1.0).abs());
        }
    }
    at_most(SHEET, "force on a tilted corner, relative", worst, 0.02);
}

/// A line of length L from which both sides rise with slopes a and b bears L (1/a + 1/b) times the integral of p(h0 + s) over s; a
/// slanted side that rises on one side alone has one of the two.
#[test]
fn the_end_of_a_taper_and_a_slanted_side_bear_what_their_strips_bear() {
    let nominal = ROUGH.nominal();
    let plain = plate(0.0);
    let surface = SurfaceParameters {
        taper_length_m: 2.0 / 12.0 * plain.length_m,
        taper_angle_rad: 10e-3_f64.atan(),
        ..SurfaceParameters::default()
    };
    let tapered = SliderParameters {
        surface,
        ..plate(0.0)
    };
    let ridged = film(&tapered, ROUGH);
    let mut worst = 0.0_f64;
    for (depth_m, pitch_rad) in [(5e-9, -5e-3), (20e-9, -1e-3), (50e-9, -7e-3)] {
        let at = struck(&tapered, &ridged, depth_m, [pitch_rad, 0.0]);
        let slopes = 1.0 / -pitch_rad + 1.0 / (10e-3 + pitch_rad);
        let force = tapered.width_m * slopes * moment_of_pressure(&nominal, depth_m, 0);
        let found = gap_load(&ridged, &at).force[0];
        worst = worst.max((found / force - 1.0).abs());
    }
    at_most(SHEET, "force on the end of a taper, relative", worst, 0.02);
    // A pad whose trailing side runs 0.2 mm back over its width of 0.5 mm.
    let (back_m, across_m) = (0.2e-3_f64, 0.5e-3);
    let corners = [
        [0.2e-3, 0.1e-3],
        [0.7e-3, 0.1e-3],
        [0.7e-3 - back_m, 0.1e-3 + across_m],
        [0.2e-3, 0.1e-3 + across_m],
    ];
    let slanted = padded(RailOutline::Polygon {
        points_m: corners.to_vec(),
    });
    let film = film(&slanted, ROUGH);
    let length_m = back_m.hypot(across_m);
    let mut worst = 0.0_f64;
    for (depth_m, slope) in [(5e-9, 1e-3), (10e-9, 2e-3), (20e-9, 5e-3)] {
        // Falls towards the side, which points along (across, back).
        let slopes = [slope * across_m / length_m, -slope * back_m / length_m];
        let at = struck(&slanted, &film, depth_m, slopes);
        let force = length_m / slope * moment_of_pressure(&nominal, depth_m, 0);
        let found = gap_load(&film, &at).force[0];
        worst = worst.max((found / force - 1.0).abs());
    }
    at_most(SHEET, "force on a slanted side, relative", worst, 0.02);
}

#[test]
fn derivatives_are_those_of_the_loads() {
    let slider = plate(9.0);
    let film = film(&slider, ROUGH);
    let level = Attitude {
        centre_height_m: 0.8e-9,
        ..Attitude::default()
    };
    let tilted = [[1e-6, 0.0], [2e-6, -1.5e-6], [1e-3, 3e-3]]
        .map(|slopes| struck(&slider, &film, 2e-9, slopes));
    for at in [level].into_iter().chain(tilted) {
        let load = gap_load(&film, &at);
        let steps = [1e-13, 2e-10, 2e-10];
        for q in 0..3 {
            let moved = |by: f64| {
                let mut moved = at;
                *[
                    &mut moved.centre_height_m,
                    &mut moved.pitch_rad,
                    &mut moved.roll_rad,
                ][q] += by;
                Vector3::from(gap_load(&film, &moved).force)
            };
            let slopes = (moved(steps[q]) - moved(-steps[q])) / (2.0 * steps[q]);
            for f in 0..3 {
                // Relative to the load's own over the step's reach: moments of a level plate cancel.
                let lengths = [1.0, 0.5e-3, 0.5e-3];
                let size = load.by_attitude[0][0].abs() * lengths[f] * lengths[q];
                let error = (load.by_attitude[f][q] - slopes[f]).abs() / size;
                assert!(error < 1e-5, "force {f} by {q}: {error:e}");
            }
        }
    }
}

#[test]
fn a_drive_without_asperities_has_every_bit_it_had() {
    let slider = default_slider();
    let attitude = level(2e-9);
    let plain = film(&slider, AsperityContact::default());
    let far = film(&slider, ROUGH);
    let mut psi = vec![0.0; plain.n_cells()];
    plain.ambient_psi(&attitude, &mut psi);
    assert!(
        plain
            .gap_loads(&psi, &attitude, &mut plain.scratch())
            .is_empty()
    );
    // Rough surfaces that fly 20 σ apart have the film of smooth ones.
    let attitude = level(10e-9);
    plain.ambient_psi(&attitude, &mut psi);
    let [smooth, rough] =
        [&plain, &far].map(|film| film.force(&psi, &attitude, &mut film.scratch()));
    assert_eq!(smooth.map(f64::to_bits), rough.map(f64::to_bits));
}

#[test]
fn energy_closes_through_a_hundred_bounces() {
    for (surfaces, yields) in [(ELASTIC, false), (SOFT, true)] {
        let AfterBounces {
            imbalance,
            returned,
        } = Bounces::onto(&surfaces.nominal()).hundred();
        at_most(
            SHEET,
            "energy not accounted for, over the kinetic energy",
            imbalance,
            1e-9,
        );
        match yields {
            false => assert!((returned - 1.0).abs() < 1e-9, "{returned}"),
            true => assert!(returned < 0.9, "{returned}"),
        }
    }
}

/// A shock of Fig. 13's drive without ramp, with rough surfaces.
fn shocked(outputs: &[Output], amplitude_g: f64, settings: &[(&str, &str)]) -> Outcome {
    let rough = ("asperity_contact.roughness_nm", "0.5");
    let coarse = ("resolution.preset", "\"coarse\"");
    let settings: Vec<(&str, &str)> = [rough, coarse]
        .into_iter()
        .chain(settings.iter().copied())
        .collect();
    let scene = scenes::scene("fig13", "none", 2.0, &settings);
    let model = Model::assemble(&scene, &Plan::new(outputs, Mode::Auto), None).expect("a scene");
    let request = Request {
        amplitude_m_per_s2: 9.80665 * amplitude_g,
        record: false,
    };
    simulate(&model, &request, &mut Workspace::default())
}

#[test]
fn what_comes_after_touch_changes_nothing_before_it() {
    let [stops, goes_on] = [
        vec![Output::CriticalShock],
        vec![Output::CriticalShock, Output::SliderContact],
    ]
    .map(|outputs| shocked(&outputs, 700.0, &[]));
    assert!(matches!(stops.verdict, Some(Verdict::Fails { .. })));
    assert_eq!(stops.verdict, goes_on.verdict);
    assert_eq!(stops.min_clearance_m, goes_on.min_clearance_m);
    assert_eq!(stops.dimple, goes_on.dimple);
    assert!(goes_on.cost.steps > 10 * stops.cost.steps);
}

/// The first contact after touch, before bounces make small differences large.
#[test]
fn first_contact_converges_with_the_tolerance_and_needs_no_minimum_film_height() {
    let first = |settings: &[(&str, &str)]| {
        let window = [("pulse.window_ms", "2.0")];
        let settings: Vec<_> = window.iter().chain(settings).copied().collect();
        let outcome = shocked(&[Output::SliderContact], 700.0, &settings);
        let contact = outcome.slider_contact.expect("rough surfaces");
        assert!(
            contact.episodes.len() > 3 && !contact.goes_on,
            "{contact:?}"
        );
        contact.episodes[0].impulse_n_s
    };
    let fine = first(&[("resolution.head_tolerance", "2.5e-4")]);
    let coarse = (first(&[]) / fine - 1.0).abs();
    let finer = (first(&[("resolution.head_tolerance", "1e-3")]) / fine - 1.0).abs();
    at_most(
        SHEET,
        "impulse at the preset's tolerance, relative",
        coarse,
        0.02,
    );
    at_most(
        SHEET,
        "impulse at a tolerance of 1e-3, relative",
        finer,
        2e-3,
    );
    let halved = first(&[
        ("resolution.head_tolerance", "2.5e-4"),
        ("resolution.min_film_height_nm", "0.15"),
    ]);
    at_most(
        SHEET,
        "half the minimum film height, relative",
        (halved / fine - 1.0).abs(),
        2e-3,
    );
}
