//! Craig-Bampton reduction of a ramp against its full model.

use opshock_solid::material::Material;
use opshock_solid::ramp::{
    Extent, Mount, RampGeometry, SolidRamp, SolidRampError, contact_columns,
};
use opshock_solid::reduction::PointMode;
use opshock_solid::sparse::{damped_response, dot};
use std::f64::consts::TAU;

fn ramp(cut_hz: f64) -> SolidRamp {
    SolidRamp {
        geometry: RampGeometry::mobile_drive(),
        material: Material::by_name("POM").unwrap(),
        mount: Mount::Bolted,
        mesh_size_m: 3e-3,
        cut_hz,
    }
}

/// Excitation of a mode.
type Input = fn(&PointMode) -> f64;
type Change = fn(&mut SolidRamp);

/// Σ output × input / (ω_k² (1 + i η) − ω²).
fn modal(modes: &[PointMode], out: usize, input: Input, omega: f64) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for mode in modes {
        let square = (TAU * mode.frequency_hz).powi(2);
        let (re, im) = (square - omega * omega, LOSS * square);
        let size = mode.shape[out] * input(mode) / (re * re + im * im);
        sum[0] += size * re;
        sum[1] -= size * im;
    }
    sum
}

const LOSS: f64 = 0.04;

/// Motion of both contacts under a force on the top one and under base acceleration, damped, by a
/// complex LU of the full model: within 0.5 % up to half the cut.
#[test]
fn contact_response_is_that_of_the_full_model_below_half_the_cut() {
    let cut_hz = 60e3;
    let ramp = ramp(cut_hz);
    let (mesh, system) = ramp.system(Extent::Half).unwrap();
    let columns = contact_columns(&mesh, &system);
    let reduced = ramp.reduce(&mesh, &system).unwrap();
    let modes = reduced.point_modes().unwrap();
    let loads: [(&[f64], Input); 2] = [
        (&columns[0], |m| m.shape[0]),
        (&system.base_load_kg[2], |m| m.participation),
    ];
    let mut worst = 0.0_f64;
    for hz in [1e3, 3.1e3, 6e3, 12e3, 20.4e3, 23.5e3, 30e3] {
        let omega = TAU * hz;
        for (load, input) in loads {
            let full = damped_response(&system.stiffness, &system.mass, omega, LOSS, load).unwrap();
            for (out, column) in columns.iter().enumerate() {
                let exact = [0, 1].map(|part| {
                    column
                        .iter()
                        .zip(&full)
                        .map(|(w, x)| w * x[part])
                        .sum::<f64>()
                });
                let found = modal(&modes, out, input, omega);
                let size = exact[0].hypot(exact[1]);
                let error = (found[0] - exact[0]).hypot(found[1] - exact[1]) / size;
                worst = worst.max(error);
                assert!(error < 5e-3, "{hz} Hz, contact {out}: {error:e}");
            }
        }
    }
    // The comparison is between two different models.
    assert!(worst > 1e-8, "{worst:e}");
}

/// Static motion of the contacts under forces on them and under steady acceleration is exact for any cut: here without
/// a single fixed-interface mode.
#[test]
fn static_answers_are_exact_for_any_cut() {
    let ramp = ramp(1.0);
    let (mesh, system) = ramp.system(Extent::Half).unwrap();
    let columns = contact_columns(&mesh, &system);
    let modes = ramp.reduce(&mesh, &system).unwrap().point_modes().unwrap();
    // Two contacts and three corrections.
    assert_eq!(modes.len(), 5);
    let mut answers = vec![
        columns[0].clone(),
        columns[1].clone(),
        system.base_load_kg[2].clone(),
    ];
    system.stiffness.cholesky().unwrap().solve(&mut answers);
    let inputs: [Input; 3] = [|m| m.shape[0], |m| m.shape[1], |m| m.participation];
    for (answer, input) in answers.iter().zip(inputs) {
        for (out, column) in columns.iter().enumerate() {
            let exact = dot(column, answer);
            let found: f64 = modes
                .iter()
                .map(|m| m.shape[out] * input(m) / (TAU * m.frequency_hz).powi(2))
                .sum();
            assert!((found / exact - 1.0).abs() < 1e-9, "{found:e} {exact:e}");
        }
    }
}

/// On springs all mass is driven: Σ p² over all modes is the ramp's mass, and the modes below a high cut contain nearly
/// all of it.
#[test]
fn participations_add_up_to_the_mass_on_an_elastic_mount() {
    let mut ramp = ramp(100e3);
    ramp.mount = Mount::Elastic {
        normal_n_per_m: 2e6,
        tangential_n_per_m: 1e6,
    };
    let modes = ramp.modes().unwrap();
    let expected = RampGeometry::mobile_drive().volume_m3() * 1410.0;
    assert!((modes.mass_kg / expected - 1.0).abs() < 1e-12);
    let share = |below_hz: f64| {
        let below = modes.modes.iter().filter(|m| m.frequency_hz < below_hz);
        below.map(|m| m.participation.powi(2)).sum::<f64>() / expected
    };
    // Momentum cannot exceed the mass; the rest lies above the cut.
    assert!(
        share(f64::MAX) < 1.0 && share(f64::MAX) > 0.95,
        "{}",
        share(f64::MAX)
    );
    // Steady acceleration: the springs carry the whole weight, however the ramp bends.
    let (mesh, system) = ramp.system(Extent::Half).unwrap();
    let mut answer = vec![system.base_load_kg[2].clone()];
    system.stiffness.cholesky().unwrap().solve(&mut answer);
    let foot = mesh.mesh.face_weights(&mesh.bolted);
    let weights: Vec<(usize, f64)> = foot
        .nodes
        .iter()
        .map(|&(a, w)| (a, w / foot.area_m2))
        .collect();
    let sag = dot(&system.column(&weights, 2), &answer[0]);
    assert!((2e6 * sag / expected - 1.0).abs() < 1e-9);
}

/// Half a ramp with a plane of symmetry has every driven mode of the whole one.
#[test]
fn half_a_ramp_moves_as_the_whole() {
    let ramp = ramp(40e3);
    let modes = [Extent::Half, Extent::Whole].map(|extent| {
        let (mesh, system) = ramp.system(extent).unwrap();
        let all = ramp.reduce(&mesh, &system).unwrap().point_modes().unwrap();
        // Modes of the whole that are odd in y do not move the contacts.
        all.into_iter()
            .filter(|m| m.shape[0].hypot(m.shape[1]) > 1e-3)
            .collect::<Vec<_>>()
    });
    assert_eq!(modes[0].len(), modes[1].len());
    for (half, whole) in modes[0].iter().zip(&modes[1]) {
        assert!((half.frequency_hz / whole.frequency_hz - 1.0).abs() < 1e-9);
        assert!((half.participation / whole.participation - 1.0).abs() < 1e-6);
        for (a, b) in half.shape.iter().zip(&whole.shape) {
            assert!((a / b - 1.0).abs() < 1e-6);
        }
    }
}

/// The mesh of the default size agrees within a few thousandths with a finer one, and frequencies fall with refinement.
#[test]
fn frequencies_fall_towards_those_of_a_finer_mesh() {
    let modes = [1.4e-3, 0.7e-3].map(|mesh_size_m| {
        let ramp = SolidRamp {
            mesh_size_m,
            ..ramp(40e3)
        };
        ramp.modes().unwrap().modes
    });
    for (coarse, fine) in modes[0].iter().zip(&modes[1]).take(4) {
        let excess = coarse.frequency_hz / fine.frequency_hz - 1.0;
        assert!(excess > 0.0 && excess < 0.012, "{excess:e}");
    }
}

/// A very stiff mount approaches a bolted one.
#[test]
fn an_ever_stiffer_mount_becomes_a_bolted_one() {
    let bolted = ramp(20e3).modes().unwrap().modes[0].frequency_hz;
    let mut before = f64::MAX;
    for stiffness in [1e8, 1e10, 1e12] {
        let mut elastic = ramp(20e3);
        elastic.mount = Mount::Elastic {
            normal_n_per_m: stiffness,
            tangential_n_per_m: stiffness,
        };
        let gap = 1.0 - elastic.modes().unwrap().modes[0].frequency_hz / bolted;
        assert!(gap > -1e-9 && gap < before, "{stiffness:e}: {gap:e}");
        before = gap;
    }
    assert!(before < 1e-3, "{before:e}");
}

#[test]
fn bad_numbers_are_refused_by_name() {
    let cases: [(&str, Change); 4] = [
        ("mesh_size", |r| r.mesh_size_m = 0.0),
        ("cut", |r| r.cut_hz = f64::INFINITY),
        ("mount normal stiffness", |r| {
            r.mount = Mount::Elastic {
                normal_n_per_m: 0.0,
                tangential_n_per_m: 1.0,
            };
        }),
        ("mount tangential stiffness", |r| {
            r.mount = Mount::Elastic {
                normal_n_per_m: 1.0,
                tangential_n_per_m: f64::NAN,
            };
        }),
    ];
    for (expected, change) in cases {
        let mut bad = ramp(1e4);
        change(&mut bad);
        match bad.modes() {
            Err(SolidRampError::Parameter { name, .. }) => assert_eq!(name, expected),
            other => panic!("{expected}: {other:?}"),
        }
    }
}
