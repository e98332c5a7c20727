//! Annular plate and spinning disk against closed forms and independent determinants.

use opshock_solver::disk::{
    DiskBasis, DiskDamping, DiskParameters, DiskResolution, Harmonics, MembraneStress,
};
use opshock_solver::quantity::rad_per_s_from_rpm;
use opshock_solver::ramp::{NoRamp, RampParameters};
use opshock_solver::scene::discretisation::{Discretisation, Levels};
use opshock_solver::structure::modes;
use opshock_tests::digests::assert_digest;
use opshock_tests::scenes::scene;
use opshock_tests::sheet::at_most;
use opshock_tests::structures::{drive_disk, reference_disk, s1};
use opshock_tests::{number, reference};
use std::f64::consts::TAU;

fn resolution(n_elements: usize, cut_hz: f64) -> DiskResolution {
    DiskResolution {
        n_harmonics: 12,
        cut_hz,
        n_elements,
        static_correction: false,
    }
}

/// A plate at rest with outer radius 1 and sqrt(rho h / D) = 1, so that omega is lambda squared.
fn unit_plate(poisson: f64, inner: f64) -> DiskParameters {
    DiskParameters {
        inner_radius_m: inner,
        outer_radius_m: 1.0,
        thickness_m: 1e-2,
        youngs_modulus_pa: 12.0 * (1.0 - poisson * poisson) * 1e6,
        poisson,
        density_kg_per_m3: 100.0,
        spin_rad_per_s: 0.0,
        damping: DiskDamping::ModalRatio(0.0),
        space_fixed_damping_per_s: 0.0,
        hub: None,
    }
}

fn lambda_squared(basis: &DiskBasis, n: usize, circles: usize) -> f64 {
    basis
        .modes
        .iter()
        .find(|m| m.nodal_diameters == n && m.nodal_circles == Some(circles))
        .expect("mode")
        .omega_rad_per_s
}

#[test]
fn hard_a11_annular_plate_frequencies_are_those_of_the_bessel_determinant() {
    let data = reference("annular_plate.json");
    let (mut largest, mut found) = (0.0_f64, Vec::new());
    for row in data["rows"].as_array().unwrap() {
        let plate = unit_plate(number(&row["nu"]), number(&row["ri_over_ro"]));
        let basis = DiskBasis::build(
            &plate,
            &resolution(80, 400.0 / TAU),
            &[],
            None,
            Harmonics::All,
        )
        .unwrap();
        let n = row["n"].as_u64().unwrap() as usize;
        for (circles, exact) in row["lambda2_m0_m1_m2"]
            .as_array()
            .unwrap()
            .iter()
            .enumerate()
        {
            let value = lambda_squared(&basis, n, circles);
            largest = largest.max((value / number(exact) - 1.0).abs());
            found.push(value);
        }
    }
    assert_digest("reference annular_plate", &found);
    at_most(
        "annular-plate",
        "relative error of an eigenvalue, 80 elements",
        largest,
        1e-6,
    );
}

#[test]
fn plate_frequencies_converge_with_order_four() {
    let data = reference("annular_plate.json");
    for row in data["rows"].as_array().unwrap().iter().step_by(4) {
        let plate = unit_plate(number(&row["nu"]), number(&row["ri_over_ro"]));
        let n = row["n"].as_u64().unwrap() as usize;
        let exact = number(&row["lambda2_m0_m1_m2"][1]);
        let error = |n_elements: usize| {
            let basis = DiskBasis::build(
                &plate,
                &resolution(n_elements, 400.0 / TAU),
                &[],
                None,
                Harmonics::All,
            )
            .unwrap();
            (lambda_squared(&basis, n, 1) / exact).powi(2) - 1.0
        };
        let (coarse, fine) = (error(24), error(48));
        let order = (coarse / fine).log2();
        assert!(coarse > 0.0 && fine > 0.0, "Ritz values lie above");
        at_most(
            "annular-plate",
            "distance of the order of convergence from 4, 24 and 48 elements",
            (order - 4.0).abs(),
            0.25,
        );
    }
}

#[test]
fn hard_a12_extreme_radii_stay_definite_and_monotone() {
    for inner in [0.05, 0.95] {
        let plate = unit_plate(0.3, inner);
        for n in 0..=6 {
            let frequency = |n_elements| {
                let basis = DiskBasis::build(
                    &plate,
                    &resolution(n_elements, 1e6),
                    &[],
                    None,
                    Harmonics::All,
                )
                .unwrap();
                lambda_squared(&basis, n, 0)
            };
            let values = [8, 16, 32].map(frequency);
            assert!(values[0] > values[1] * (1.0 - 1e-9) && values[1] > values[2] * (1.0 - 1e-9));
        }
    }
}

#[test]
fn hard_a7_spinning_disk_frequencies_in_both_frames() {
    let data = reference("spinning_disk.json");
    let mut found = Vec::new();
    let ramp = RampParameters {
        model: NoRamp.into(),
        ..s1(1e-3, NoRamp).ramp
    };
    for case in data["frequencies_Hz"].as_array().unwrap() {
        for sense in [1.0, -1.0] {
            let disk = DiskParameters {
                spin_rad_per_s: sense * rad_per_s_from_rpm(number(&case["rpm"])),
                ..reference_disk()
            };
            let table = modes(&disk, &resolution(40, 20e3), &ramp).unwrap().disk;
            found.extend(table.iter().map(|row| row.rotating_frame_hz));
            assert!(
                table
                    .windows(2)
                    .all(|p| p[0].rotating_frame_hz <= p[1].rotating_frame_hz)
            );
            for mode in case["modes"].as_array().unwrap() {
                let row = |circles| {
                    *table
                        .iter()
                        .find(|r| {
                            r.nodal_diameters as u64 == mode["n"].as_u64().unwrap()
                                && r.nodal_circles == circles
                        })
                        .expect("mode")
                };
                let close = |value: f64, key: &str| {
                    let exact = number(&mode[key]);
                    let what = match key.starts_with("f_rot") {
                        true => "relative error of a frequency in the disk's frame",
                        false => "relative error of a frequency in the frame at rest",
                    };
                    at_most("spinning-disk", what, (value / exact - 1.0).abs(), 1e-6);
                };
                close(row(0).rotating_frame_hz, "f_rot_m0");
                close(row(1).rotating_frame_hz, "f_rot_m1");
                close(row(0).forward_hz, "f_fwd_m0");
                close(row(0).backward_hz, "f_bwd_m0");
            }
        }
    }
    assert_digest("reference spinning_disk", &found);
}

#[test]
fn membrane_stress_is_the_closed_form() {
    let stress = MembraneStress::new(&reference_disk());
    for row in reference("spinning_disk.json")["membrane_stress_5400"]
        .as_array()
        .unwrap()
    {
        let (radial, hoop) = stress.at(number(&row["r"]));
        let scale = 5e5;
        for (what, found, key) in [
            ("error of the radial stress, of 0.5 MPa", radial, "sigma_r"),
            ("error of the hoop stress, of 0.5 MPa", hoop, "sigma_t"),
        ] {
            at_most(
                "membrane-stress",
                what,
                (found - number(&row[key])).abs() / scale,
                1e-6,
            );
        }
    }
}

/// The speed at which the backward wave of n diameters stands still in space, rpm.
fn critical_speed_rpm(n: usize) -> Option<f64> {
    let excess = |rpm: f64| {
        let disk = DiskParameters {
            spin_rad_per_s: rad_per_s_from_rpm(rpm),
            ..reference_disk()
        };
        let basis =
            DiskBasis::build(&disk, &resolution(24, 40e3), &[], None, Harmonics::All).unwrap();
        lambda_squared(&basis, n, 0) - n as f64 * disk.spin_rad_per_s
    };
    let (mut low, mut high) = (0.0, 2e5);
    if excess(high) > 0.0 {
        return None;
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}

#[test]
fn critical_speeds_are_those_of_the_reference() {
    for row in reference("spinning_disk.json")["critical"]
        .as_array()
        .unwrap()
        .iter()
        .take(4)
    {
        let n = row["n"].as_u64().unwrap() as usize;
        match (row["rpm"].as_f64(), critical_speed_rpm(n)) {
            (Some(exact), Some(found)) => {
                at_most(
                    "critical-speeds",
                    "relative error of a critical speed",
                    (found / exact - 1.0).abs(),
                    1e-5,
                );
            }
            (None, None) => {}
            other => panic!("n {n}: {other:?}"),
        }
    }
}

/// First modes of the default disk at rest, as its parameters are documented.
#[test]
fn the_drive_disk_has_its_documented_frequencies() {
    let disk = DiskParameters {
        spin_rad_per_s: 0.0,
        ..drive_disk()
    };
    let basis = DiskBasis::build(&disk, &resolution(24, 20e3), &[], None, Harmonics::All).unwrap();
    for (n, circles, hz) in [
        (0, 0, 1037.0),
        (1, 0, 1024.0),
        (2, 0, 1236.0),
        (3, 0, 2036.0),
        (0, 1, 6647.0),
    ] {
        let found = lambda_squared(&basis, n, circles) / TAU;
        assert!((found - hz).abs() < 0.51, "({circles},{n}): {found}");
    }
}

/// Four steps finer than the preset `fine` a disk would have 448 elements, more than it may. Bending waves
/// far above the first modes have wave numbers pi / (outer - inner) apart, whatever holds the edges.
#[test]
fn the_finest_disk_a_refinement_asks_for_is_built_and_carries_waves_to_its_cut() {
    let named = scene(
        "fig13-stiffness",
        "rigid",
        3.0,
        &[("resolution.preset", "fine")],
    );
    let mut finest = named.at_levels(Levels::NONE.changed(Discretisation::DiskModes, 4));
    finest.disk_resolution.n_harmonics = 1;
    let disk = DiskParameters {
        spin_rad_per_s: 0.0,
        ..finest.disk
    };
    let resolution = &finest.disk_resolution;
    let basis = DiskBasis::build(&disk, resolution, &[], None, Harmonics::All).unwrap();
    let flexural = disk.youngs_modulus_pa * disk.thickness_m.powi(2)
        / (12.0 * (1.0 - disk.poisson.powi(2)) * disk.density_kg_per_m3);
    let waves: Vec<f64> = basis
        .modes
        .iter()
        .filter(|mode| mode.nodal_diameters == 1 && mode.nodal_circles.is_some())
        .map(|mode| mode.omega_rad_per_s.sqrt() / flexural.powf(0.25))
        .collect();
    let apart = std::f64::consts::PI / (disk.outer_radius_m - disk.inner_radius_m);
    assert!(
        *waves.last().unwrap() + 1.01 * apart
            > (TAU * named.disk_resolution.cut_hz * 16.0).sqrt() / flexural.powf(0.25)
    );
    for pair in waves[waves.len() / 2..].windows(2) {
        let found = (pair[1] - pair[0]) / apart;
        assert!((found - 1.0).abs() < 1e-3, "{found}");
    }
}
