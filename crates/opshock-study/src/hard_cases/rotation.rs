//! Hard cases A of a turning disk: split of its waves, critical speed, instability above it, axial symmetry.

use super::check::Check;
use super::naive;
use super::scenes::noted::note;
use super::scenes::structures::{Structure, s1};
use super::structure::run;
use opshock_solver::disk::{DiskDamping, DiskResolution};
use opshock_solver::modal::Oscillator;
use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2 as G, rad_per_s_from_rpm};
use opshock_solver::ramp::{NoRamp, RigidRamp};
use opshock_solver::structure::{
    Activation, StructureRun, StructureWarning, Window, Workspace, modes,
};
use std::f64::consts::TAU;

pub(super) fn a7() -> Vec<Check> {
    let resolution = DiskResolution {
        n_harmonics: 6,
        cut_hz: 20e3,
        n_elements: 24,
        static_correction: false,
    };
    let base = s1(1e-3, NoRamp);
    let (mut worst, mut without, mut signs) = (0.0_f64, 0.0_f64, 0);
    for sense in [1.0, -1.0] {
        let mut disk = base.disk.clone();
        disk.spin_rad_per_s *= sense;
        let turn_hz = disk.spin_rad_per_s.abs() / TAU;
        let table = modes(&disk, &resolution, &base.ramp).expect("modes");
        for row in table.disk {
            let n = row.nodal_diameters as f64;
            let split = row.forward_hz - row.backward_hz;
            worst = worst.max((split - 2.0 * n * turn_hz).abs() / row.rotating_frame_hz);
            if n > 1.0 {
                without = without.max((split - 2.0 * turn_hz).abs() / row.rotating_frame_hz);
            }
        }
        // Motion of a pair seen at a point fixed in space: the rotation in the oscillator's own solution.
        let n = 3.0;
        let pair = Oscillator {
            turn_rad_per_s: n * disk.spin_rad_per_s,
            ..Oscillator::fixed(TAU * 2000.0, 0.0)
        };
        let mut rates: Vec<f64> = pair.roots().iter().map(|root| root.im).collect();
        rates.sort_by(f64::total_cmp);
        signs += usize::from(rates.len() != 2);
        let beat = pair.flow(1e-6);
        signs += usize::from((beat.qq.im > 0.0) != (sense > 0.0));
    }
    vec![
        Check::new("split against 2 n f, of the frequency", worst, 1e-8)
            .against("factor n left out", without),
        Check::none("senses of rotation that do not turn the pair", signs),
    ]
}

/// Set S1 with a rigid ramp at another speed.
fn at_speed(rpm: f64) -> Structure {
    let mut structure = s1(5e-4, RigidRamp).with_cut(15e3).with_step(1e-6);
    structure.disk.spin_rad_per_s = rad_per_s_from_rpm(rpm);
    structure.window = Window::Fixed { length_s: 2e-3 };
    structure
}

/// Lowest frequency with `n` nodal diameters in the rotating frame, rad/s.
fn omega(structure: &Structure, n: usize) -> f64 {
    let resolution = DiskResolution {
        n_harmonics: n,
        ..structure.disk_resolution.clone()
    };
    let table = modes(&structure.disk, &resolution, &structure.ramp).expect("modes");
    let of_n = table.disk.iter().filter(|row| row.nodal_diameters == n);
    of_n.map(|row| row.rotating_frame_hz)
        .fold(f64::MAX, f64::min)
        * TAU
}

pub(super) fn a8() -> Vec<Check> {
    // Secant steps onto ω = 3 Ω: the centrifugal stiffness makes ω² all but linear in Ω².
    let mut rpm = 50_741.0;
    for _ in 0..12 {
        rpm *= omega(&at_speed(rpm), 3) / (3.0 * rad_per_s_from_rpm(rpm));
    }
    let ratio = 3.0 * rad_per_s_from_rpm(rpm) / omega(&at_speed(rpm), 3);
    let slow = run(&at_speed(5400.0), 1500.0 * G);
    let run = run(&at_speed(rpm), 1500.0 * G);
    vec![
        Check::new("distance to the critical speed", (ratio - 1.0).abs(), 1e-6),
        Check::new(
            "travel of the rim, of that at 5400 rpm",
            run.disk.rim_max_m / slow.disk.rim_max_m,
            10.0,
        )
        .against(
            "static solve in the fixed frame, of its own at rest",
            naive::plate::static_amplification(ratio),
        ),
        Check::new("energy balance there", run.energy.closure, 1e-9),
        Check::new(
            "largest penetration there, m",
            run.complementarity.max_penetration_m,
            1e-7,
        ),
        Check::none("contacts missed", usize::from(run.first_touch_s.is_none())),
    ]
}

fn growth(run: &StructureRun, n: usize) -> Option<f64> {
    run.warnings.iter().find_map(|warning| match *warning {
        StructureWarning::PhysicalInstability {
            nodal_diameters,
            growth_per_s,
        } if nodal_diameters == n => Some(growth_per_s),
        _ => None,
    })
}

pub(super) fn a9() -> Vec<Check> {
    let (n, c) = (3, 900.0);
    let structure = at_speed(1.2 * 50_741.0);
    let turning = run(&structure, 1500.0 * G);
    let mut fixed = structure.clone();
    fixed.disk.space_fixed_damping_per_s = c;
    fixed.disk.damping = DiskDamping::ModalRatio(1e-4);
    let omega = omega(&fixed, n);
    let spin = n as f64 * structure.disk.spin_rad_per_s;
    let expected = 0.5 * c * (spin / omega - 1.0) - 1e-4 * omega;
    let fixed = run(&fixed, 1500.0 * G);
    let found = growth(&fixed, n).unwrap_or(f64::NAN);
    let mut slow = at_speed(20_000.0);
    slow.disk.space_fixed_damping_per_s = c;
    let calm = [growth(&turning, n), growth(&run(&slow, 1500.0 * G), n)];
    vec![
        Check::new(
            "growth by damping fixed in space, against theory",
            (found / expected - 1.0).abs(),
            0.01,
        )
        .against(
            "implicit Euler at the same step damps it away",
            (naive::time::implicit_euler_growth(expected, omega, 1e-6) / expected - 1.0).abs(),
        ),
        Check::none(
            "growth named where there is none",
            calm.iter().flatten().count(),
        ),
        Check::new(
            "energy balance of the growing run",
            fixed.energy.closure,
            1e-9,
        ),
    ]
}

pub(super) fn a10() -> Vec<Check> {
    let structure = s1(5e-4, RigidRamp).with_cut(20e3);
    let mut free = structure.with_ramp(NoRamp);
    free.window = structure.window;
    let alone = run(&free, 200.0 * G);
    // Every harmonic marched from the onset, not from the first touch.
    note(&structure, 200.0 * G);
    let marched = structure
        .build()
        .with_activation(Activation::AtOnset)
        .run(200.0 * G, true, &mut Workspace::default())
        .expect("a named structure runs");
    let touch = marched.first_touch_s.unwrap_or(0.0);
    let before = (touch / marched.history.step_s()) as usize;
    let nodes = |run: &StructureRun| run.history.nodes()[..before].to_vec();
    let differing = nodes(&marched)
        .iter()
        .zip(nodes(&alone))
        .filter(|(a, b)| **a != *b)
        .count();
    let tilted = nodes(&marched)
        .iter()
        .filter(|p| p.pitch_rad != 0.0)
        .count();
    vec![
        Check::none("nodes before the touch that differ from no ramp", differing),
        Check::none("nodes before the touch tilted along the track", tilted).against(
            "uniform load summed over 360 sectors: harmonics 1 to 64 it drives",
            naive::plate::harmonics_of_a_uniform_load(64) as f64,
        ),
        Check::none("cases without a touch", usize::from(before < 100)),
    ]
}
