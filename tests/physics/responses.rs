//! Harmonic responses of disk, ramp and film: closed forms, static limits, whirl, differences.

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, Matrix4, Vector4};
use opshock_solver::air_bearing::Attitude;
use opshock_solver::air_bearing::impedance::SmallMotion;
use opshock_solver::air_bearing::steady::fixed_attitude;
use opshock_solver::disk::Harmonics;
use opshock_solver::ramp::{Arms, NoRamp, RampBody, RigidRamp};
use opshock_solver::structure::{Source, StructureModel, modes};
use opshock_tests::heads::default_film;
use opshock_tests::sheet::at_most;
use opshock_tests::structures::{Structure, s1};

fn build(structure: &Structure) -> StructureModel {
    StructureModel::build(&structure.parameters(), Harmonics::All).unwrap()
}

/// Arms of one mode, pushed and shaken, against 1/(m (ω0² − ω² + 2 i ζ ω0 ω)).
#[test]
fn responses_of_an_arm_of_one_mode() {
    let structure = s1(1e-3, one_mode());
    let model = build(&structure);
    let (m, omega0, zeta, participation) = (MASS_KG, TAU * 900.0, 0.03, 0.4);
    for hz in [0.0, 300.0, 890.0, 900.0, 2500.0] {
        let omega = TAU * hz;
        let below = Complex::new(omega0 * omega0 - omega * omega, 2.0 * zeta * omega0 * omega);
        let pushed = model.response(omega, Source::TopArm).unwrap().unwrap();
        let expected = (below * m).inv();
        at_most(
            "arm-response",
            "relative error of the response to a force",
            (pushed.arms_m[0] / expected - 1.0).norm(),
            1e-12,
        );
        assert_eq!(pushed.arms_m[1], Complex::default());
        assert_eq!(pushed.ramp_m, Complex::default());
        let shaken = model.response(omega, Source::Shock).unwrap().unwrap();
        let expected = below.inv() * participation;
        for arm in shaken.arms_m {
            at_most(
                "arm-response",
                "relative error of the response to a shock",
                (arm / expected - 1.0).norm(),
                1e-12,
            );
        }
    }
}

const MASS_KG: f64 = 5e-5;

fn one_mode() -> RampBody {
    let arm = vec![opshock_solver::ramp::ArmMode {
        frequency_hz: 900.0,
        mass_kg: MASS_KG,
        participation: 0.4,
        damping_ratio: 0.03,
    }];
    Arms {
        top: arm.clone(),
        bottom: arm,
    }
    .into()
}

/// Static limit of the shock: deflection of a clamped, free annulus under its own weight, from
/// D ∇⁴w = ρ h with w = q r⁴/(64 D) + A + B ln r + C r² + E r² ln r.
#[test]
fn responses_static_limit_is_the_plates_deflection() {
    let mut structure = s1(1e-3, NoRamp);
    structure.disk.spin_rad_per_s = 0.0;
    let disk = &structure.disk;
    let (a, b, h, nu) = (
        disk.inner_radius_m,
        disk.outer_radius_m,
        disk.thickness_m,
        disk.poisson,
    );
    let d = disk.youngs_modulus_pa * h.powi(3) / (12.0 * (1.0 - nu * nu));
    let q = disk.density_kg_per_m3 * h / (64.0 * d);
    // Rows: w(a), w'(a), M_r(b) = 0 as w'' + ν w'/r, V(b) = 0 as (w'' + w'/r)'.
    let matrix = Matrix4::new(
        1.0,
        a.ln(),
        a * a,
        a * a * a.ln(),
        0.0,
        1.0 / a,
        2.0 * a,
        a * (2.0 * a.ln() + 1.0),
        0.0,
        (nu - 1.0) / (b * b),
        2.0 * (1.0 + nu),
        2.0 * b.ln() + 3.0 + nu * (2.0 * b.ln() + 1.0),
        0.0,
        0.0,
        0.0,
        4.0 / b,
    );
    let right = -Vector4::new(
        q * a.powi(4),
        4.0 * q * a.powi(3),
        (12.0 + 4.0 * nu) * q * b * b,
        32.0 * q * b,
    );
    let c = matrix.lu().solve(&right).unwrap();
    let w = |r: f64| q * r.powi(4) + c[0] + c[1] * r.ln() + c[2] * r * r + c[3] * r * r * r.ln();
    let radii = [structure.ramp.radius_m, b, structure.slider.radius_m];
    let answer = build(&structure)
        .response(0.0, Source::Shock)
        .unwrap()
        .unwrap();
    let found = [answer.ramp_m, answer.rim_m, answer.slider[0]];
    for (found, r) in found.into_iter().zip(radii) {
        at_most(
            "plate-deflection",
            "relative error of the deflection at ramp, rim and slider",
            (found.re / w(r) - 1.0).abs(),
            2e-4,
        );
        assert_eq!(found.im, 0.0);
    }
}

/// A force at the ramp moves the disk under the slider as one there moves it at the ramp, when the disk
/// stands and, of a spinning one, when the spin is reversed; each whirl has its peak where the modes say.
#[test]
fn responses_are_reciprocal_and_peak_at_the_whirls() {
    let mut structure = s1(1e-3, RigidRamp);
    for spin in [0.0, structure.disk.spin_rad_per_s] {
        structure.disk.spin_rad_per_s = spin;
        let model = build(&structure);
        structure.disk.spin_rad_per_s = -spin;
        let mirrored = build(&structure);
        for hz in [0.0, 400.0, 1100.0, 3000.0] {
            let omega = TAU * hz;
            let there = model.response(omega, Source::DiskAtRamp).unwrap().unwrap();
            let back = mirrored
                .response(omega, Source::DiskAtSlider)
                .unwrap()
                .unwrap();
            let error = (there.slider[0] / back.ramp_m - 1.0).norm();
            assert!(error < 1e-9, "{spin} {hz}: {error}");
        }
        structure.disk.spin_rad_per_s = spin;
    }
    let model = build(&structure);
    let rows = modes(&structure.disk, &structure.disk_resolution, &structure.ramp).unwrap();
    let row = rows
        .disk
        .iter()
        .find(|m| (m.nodal_diameters, m.nodal_circles) == (3, 0));
    let row = row.unwrap();
    for peak_hz in [row.forward_hz, row.backward_hz] {
        let size = |hz: f64| {
            model
                .response(TAU * hz, Source::DiskAtRamp)
                .unwrap()
                .unwrap()
                .ramp_m
                .norm()
        };
        let at = |share: f64| size(peak_hz * (1.0 + share));
        assert!(at(0.0) > at(2e-3) && at(0.0) > at(-2e-3), "{peak_hz}");
        assert!(at(0.0) > 3.0 * at(0.03), "{peak_hz}");
    }
}

/// The film's static stiffness is the difference of forces of films held higher, pitched, rolled.
#[test]
fn responses_film_stiffness_is_the_difference_of_held_films() {
    let (film, flight) = default_film(500);
    let mut motion = SmallMotion::new(&film, &flight.psi, &flight.attitude);
    let z = motion.impedance(0.0).unwrap();
    let steps = [1e-12, 2e-9, 3e-9];
    for (q, step) in steps.into_iter().enumerate() {
        let held = |sign: f64| {
            let by = |k: usize| if k == q { sign * step } else { 0.0 };
            let attitude = Attitude {
                centre_height_m: flight.attitude.centre_height_m + by(0),
                pitch_rad: flight.attitude.pitch_rad + by(1),
                roll_rad: flight.attitude.roll_rad + by(2),
            };
            fixed_attitude(&film, &attitude).unwrap().force
        };
        let (up, down) = (held(1.0), held(-1.0));
        for f in 0..3 {
            let slope = -(up[f] - down[f]) / (2.0 * step);
            let scale = (flight.stiffness[f][f] * flight.stiffness[q][q]).sqrt();
            let error = (z[(f, q)].re - slope).abs() / scale;
            assert!(error < 1e-5, "{f} {q}: {error}");
        }
    }
    assert!(
        z.iter()
            .all(|value| value.im.abs() <= 1e-12 * value.re.abs().max(PI))
    );
}
