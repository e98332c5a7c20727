//! The disk read anywhere from one run is what runs see that have their slider there.

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::ramp::RigidRamp;
use opshock_solver::shock::ObliqueShock;
use opshock_solver::structure::{SliderPlace, StructureColumns, disk_displacements};
use opshock_tests::structures::Structure;

use super::base::{BASE, arms, on};
use super::hub::{drive, run, spindle};

const AMPLITUDE_G: f64 = 500.0;

/// Between nodes, at a node, before and after the touch, at the end of the window.
const TIMES_S: [f64; 5] = [0.0, 0.4e-3, 0.9003e-3, 1.50007e-3, 2e-3];

/// Linear interpolation at a time.
fn at(columns: &StructureColumns, time_s: f64) -> f64 {
    let (times, values) = (&columns.time_s, &columns.disk_slider_m);
    let after = times
        .partition_point(|&t| t < time_s)
        .clamp(1, times.len() - 1);
    let share = (time_s - times[after - 1]) / (times[after] - times[after - 1]);
    values[after - 1] + share * (values[after] - values[after - 1])
}

#[test]
fn every_place_of_a_run_is_where_a_slider_there_sees_the_disk() {
    let mut oblique = drive(Some(spindle()));
    oblique.oblique = Some(ObliqueShock {
        in_plane: [0.4, -0.7],
        rotation_per_m: [9.0, 14.0],
    });
    let mut on_hub_and_base = on(&BASE, RigidRamp);
    on_hub_and_base.disk.hub = Some(spindle());
    let mut turned = drive(None).with_ramp(arms());
    turned.ramp.angle_rad = 0.4;
    let structures: [(&str, Structure); 5] = [
        ("ramp at an angle", turned),
        ("oblique shock on a hub", oblique.clone()),
        ("base", on(&BASE, arms())),
        ("hub on a base", on_hub_and_base),
        ("Moreau-Jean on a hub", oblique.with_moreau_jean()),
    ];
    for (name, structure) in structures {
        let outer_m = structure.disk.outer_radius_m;
        let (radii_m, angles_rad) = ([0.0149, 0.0263, outer_m], [-1.3, 0.2, 2.9]);
        let amplitude = m_per_s2_from_g(AMPLITUDE_G);
        let places = [&radii_m[..], &angles_rad];
        let read = disk_displacements(&structure.parameters(), amplitude, &TIMES_S, places);
        let read = read.expect("runs");
        let mut largest = 0.0_f64;
        let mut apart = 0.0_f64;
        let mut around = 0.0_f64;
        for (i, radius_m) in radii_m.into_iter().enumerate() {
            for (j, angle_rad) in angles_rad.into_iter().enumerate() {
                let mut there = structure.clone();
                there.slider = SliderPlace {
                    radius_m,
                    angle_rad,
                    skew_rad: 0.3,
                };
                let seen = run(&there, AMPLITUDE_G);
                assert!(seen.first_touch_s.is_some_and(|t| t < TIMES_S[3]), "{name}");
                let columns = seen.columns.expect("recorded");
                for (k, time_s) in TIMES_S.into_iter().enumerate() {
                    let (one, other) = (read[k][3 * i + j], at(&columns, time_s));
                    largest = largest.max(other.abs());
                    apart = apart.max((one - other).abs());
                    around = around.max((read[k][3 * i + j] - read[k][3 * i]).abs());
                }
            }
        }
        println!("{name}: {apart:e} of {largest:e} m, around {around:e} m");
        assert!(largest > 50e-6, "{name}: {largest:e}");
        // Contact bends the disk around, or the places would be told apart by their radius alone.
        assert!(around > 1e-6, "{name}: {around:e}");
        assert!(apart < 1e-10 * largest, "{name}: {apart:e}");
    }
}

/// The clamp is at rest on a rigid hub; on a bearing it moves as the hub does.
#[test]
fn the_clamp_moves_with_the_hub() {
    let times_s = [1e-3];
    let clamped = drive(None);
    let inner_m = clamped.disk.inner_radius_m;
    let angles_rad = [0.0, 1.0, 2.0, 3.0]
        .map(|quarters| clamped.ramp.angle_rad + quarters * std::f64::consts::FRAC_PI_2);
    let read = |structure: &Structure| {
        let places = [&[inner_m][..], &angles_rad];
        let amplitude = m_per_s2_from_g(AMPLITUDE_G);
        disk_displacements(&structure.parameters(), amplitude, &times_s, places).expect("runs")
    };
    assert_eq!(read(&clamped), [[0.0; 4]]);
    let on_hub = drive(Some(spindle()));
    let columns = run(&on_hub, AMPLITUDE_G).columns.expect("recorded");
    let node = columns.time_s.partition_point(|&t| t < times_s[0] - 1e-12);
    let axial = columns.hub_axial_m[node];
    let tilts = [
        columns.hub_tilt_ramp_rad[node],
        columns.hub_tilt_across_rad[node],
    ];
    for tilt in tilts {
        assert!(inner_m * tilt.abs() > 0.01 * axial.abs(), "{tilt:e}");
    }
    let [at_ramp, across] = tilts;
    let lifts = [at_ramp, across, -at_ramp, -across];
    for (lift, value) in lifts.into_iter().zip(&read(&on_hub)[0]) {
        let expected = axial + inner_m * lift;
        assert!(
            (value - expected).abs() < 1e-12 * axial.abs(),
            "{value:e} {expected:e}"
        );
    }
    let off = disk_displacements(
        &clamped.parameters(),
        1.0,
        &times_s,
        [&[0.9 * inner_m], &[0.0]],
    );
    assert!(off.is_err_and(|error| error.to_string().contains("point")));
}
