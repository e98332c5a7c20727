//! The disk near and above a critical speed, with damping that turns and damping fixed in space.

use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2 as G, rad_per_s_from_rpm};
use opshock_solver::ramp::RampModel;
use opshock_solver::structure::{StructureRun, StructureWarning, Workspace, modes};
use opshock_tests::structures::{Structure, s1};
use std::f64::consts::TAU;

/// Set S1 with a rigid ramp at another speed.
fn at_speed(rpm: f64) -> Structure {
    let mut structure = s1(5e-4, RampModel::Rigid).with_cut(15e3).with_step(1e-6);
    structure.disk.spin_rad_per_s = rad_per_s_from_rpm(rpm);
    structure
}

/// Lowest rotating-frame frequency with `n` nodal diameters, rad/s.
fn omega(structure: &Structure, n: usize) -> f64 {
    let table = modes(&structure.disk, &structure.disk_resolution, &structure.ramp).unwrap();
    let row = table
        .disk
        .iter()
        .find(|row| row.nodal_diameters == n)
        .unwrap();
    row.rotating_frame_hz * TAU
}

fn run(structure: &Structure, g: f64) -> StructureRun {
    structure
        .build()
        .run(g * G, false, &mut Workspace::default())
        .unwrap()
}

/// Hard case A8: a wave that stands still in space is no singularity.
#[test]
fn hard_a8_at_the_critical_speed() {
    let n = 3;
    let (mut low, mut high) = (40_000.0, 60_000.0);
    while high - low > 1e-9 * high {
        let middle = 0.5 * (low + high);
        let structure = at_speed(middle);
        if omega(&structure, n) > n as f64 * structure.disk.spin_rad_per_s {
            low = middle;
        } else {
            high = middle;
        }
    }
    let run = run(&at_speed(low), 1500.0);
    assert!(
        run.first_touch_s.is_some() && run.energy.closure < 1e-9,
        "{:?}",
        run.energy
    );
    assert!(run.complementarity.max_penetration_m < 1e-7);
}

/// Hard case A9. Of a disk, unlike of a shaft, the restoring force turns with the material. So
/// damping that turns too only ever takes energy, and damping fixed in space drives a wave which
/// the spin carries forward faster than it travels back: growth c (nΩ/ω − 1)/2 − ζω.
#[test]
fn hard_a9_above_the_critical_speed() {
    let mut structure = at_speed(1.2 * 50_741.0);
    let spin = structure.disk.spin_rad_per_s;
    let turning = run(&structure, 1500.0);
    let unstable = |run: &StructureRun| {
        run.warnings
            .iter()
            .filter(|w| matches!(w, StructureWarning::PhysicalInstability { .. }))
            .count()
    };
    assert_eq!(unstable(&turning), 0);
    assert!(turning.energy.closure < 1e-9);

    let (n, c) = (3, 900.0);
    structure.disk.space_fixed_damping_per_s = c;
    structure.disk.damping = opshock_solver::disk::DiskDamping::ModalRatio(1e-4);
    let omega = omega(&structure, n);
    let expected = 0.5 * c * (n as f64 * spin / omega - 1.0) - 1e-4 * omega;
    assert!(expected > 0.0, "above critical: {expected}");
    let fixed = run(&structure, 1500.0);
    let growth = fixed
        .warnings
        .iter()
        .find_map(|w| match *w {
            StructureWarning::PhysicalInstability {
                nodal_diameters,
                growth_per_s,
            } if nodal_diameters == n => Some(growth_per_s),
            _ => None,
        })
        .expect("named as physical");
    assert!(
        (growth / expected - 1.0).abs() < 0.01,
        "{growth} {expected}"
    );
    assert!(fixed.energy.closure < 1e-9, "{:?}", fixed.energy);

    // The same damping below the critical speed only damps.
    let mut slow = at_speed(20_000.0);
    slow.disk.space_fixed_damping_per_s = c;
    assert_eq!(unstable(&run(&slow, 1500.0)), 0);
}
