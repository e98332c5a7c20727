//! Oblique shocks: shares in the plane of the disk and rotations of the base tilt the disk on its hub.

use std::f64::consts::PI;

use nalgebra::Complex;
use opshock_solver::disk::{DiskBasis, Harmonics};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::NoRamp;
use opshock_solver::shock::ObliqueShock;
use opshock_tests::runge_kutta;
use opshock_tests::structures::Structure;

use super::hub::{distance, drive, largest, run, spindle};

const OBLIQUE: ObliqueShock = ObliqueShock {
    in_plane: [0.4, -0.7],
    rotation_per_m: [9.0, 14.0],
};

fn shaken(oblique: Option<ObliqueShock>) -> Structure {
    let mut structure = drive(Some(spindle()));
    structure.oblique = oblique;
    structure
}

/// Shares of nothing are a straight shock, in every column.
#[test]
fn an_oblique_shock_without_shares_is_the_straight_one() {
    let none = ObliqueShock::default();
    let [a, b] = [Some(none), None].map(|oblique| run(&shaken(oblique), 300.0));
    assert!(a.first_touch_s.is_some());
    let [x, y] = [&a, &b].map(|run| run.columns.as_ref().expect("recorded"));
    assert_eq!(distance(&x.disk_slider_m, &y.disk_slider_m), 0.0);
    assert_eq!(distance(&x.disk_roll_rad, &y.disk_roll_rad), 0.0);
    assert_eq!(distance(&x.ramp_top_m, &y.ramp_top_m), 0.0);
    assert_eq!(a.top, b.top);
}

/// n = 1 in an inertial frame, where the base turns under the rotor, by the classical Runge-Kutta
/// rule: no felt loads, no modes of first order.
#[test]
fn the_disk_tilts_as_a_rotor_on_a_base_that_turns_and_is_pushed_aside() {
    let hub = spindle();
    let mut structure = shaken(Some(OBLIQUE)).with_ramp(NoRamp);
    structure.slider.angle_rad = 1.1;
    let found = run(&structure, 100.0).columns.expect("recorded");
    // The axial part is that of the straight shock.
    structure.oblique = None;
    let axial = run(&structure, 100.0).columns.expect("recorded");

    let disk = &structure.disk;
    let (radius, alpha) = (structure.slider.radius_m, structure.slider.angle_rad);
    let resolution = &structure.disk_resolution;
    let basis = DiskBasis::build(disk, resolution, &[radius], None, Harmonics::Tilting);
    let mut modes = basis.expect("basis").modes;
    modes.retain(|m| m.nodal_diameters == 1);
    let areal = disk.density_kg_per_m3 * disk.thickness_m;
    let (a, b) = (disk.inner_radius_m, disk.outer_radius_m);
    let mass = hub.mass_kg + PI * areal * (b * b - a * a);
    let of_disk = 0.25 * PI * areal * (b.powi(4) - a.powi(4));
    let inertia = of_disk + hub.transverse_inertia_kg_m2;
    let carried: f64 = modes.iter().map(|m| m.participation.powi(2)).sum();
    let spin = disk.spin_rad_per_s;
    let width = structure.pulse.width_s;
    let sigma = PI / width;
    let i = Complex::new(0.0, 1.0);
    // The base turns by the rotation vector −ρ ∫∫ a: z = φx y − φy x = r Re(β e^{iθ}).
    let share = Complex::new(OBLIQUE.rotation_per_m[1], OBLIQUE.rotation_per_m[0]);
    let peak = 100.0 * G;
    let base = |t: f64| -> (Complex<f64>, Complex<f64>) {
        let u = if t < width {
            (1.0 - (sigma * t).cos()) / sigma
        } else {
            2.0 / sigma
        };
        let x = if t < width {
            t / sigma - (sigma * t).sin() / (sigma * sigma)
        } else {
            width / sigma + 2.0 / sigma * (t - width)
        };
        (share * (peak * x), share * (peak * u))
    };
    let n = modes.len() + 1;
    // Absolute tilt of the hub, then modes relative to it.
    let rate = |t: f64, y: &[Complex<f64>]| -> Vec<Complex<f64>> {
        let pull = if t < width {
            peak * (sigma * t).sin()
        } else {
            0.0
        };
        let (beta, beta_rate) = base(t);
        let (x, v) = y.split_at(n);
        // Push on the centre of mass, at its height, about the tilting centre: it leans with the load.
        let [px, py] = OBLIQUE.in_plane;
        let moment = Complex::new(-px, py) * (mass * hub.centre_height_m * pull);
        let turned: Complex<f64> = modes
            .iter()
            .zip(&v[1..])
            .map(|(m, v)| v * m.participation)
            .sum();
        let gyroscopic =
            i * spin * ((2.0 * of_disk + hub.polar_inertia_kg_m2) * v[0] + turned * 2.0);
        let bearing = Complex::new(
            hub.tilt_stiffness_n_m_per_rad,
            hub.cross_stiffness_n_m_per_rad,
        ) * (x[0] - beta)
            + Complex::new(
                hub.tilt_damping_n_m_s_per_rad,
                hub.cross_damping_n_m_s_per_rad,
            ) * (v[0] - beta_rate);
        let on_hub = moment - gyroscopic - bearing;
        let on_mode: Vec<Complex<f64>> = modes
            .iter()
            .enumerate()
            .map(|(j, m)| {
                let omega = m.omega_rad_per_s;
                let (q, r) = (x[j + 1], v[j + 1]);
                -q * (omega * omega - spin * spin)
                    - (r + i * spin * q) * (2.0 * m.damping_ratio * omega)
                    - i * (2.0 * spin) * (r + v[0] * m.participation)
            })
            .collect();
        let shared: Complex<f64> = modes
            .iter()
            .zip(&on_mode)
            .map(|(m, f)| f * m.participation)
            .sum();
        let tilt = (on_hub - shared) / (inertia - carried);
        let mut out = v.to_vec();
        out.push(tilt);
        out.extend(
            modes
                .iter()
                .zip(&on_mode)
                .map(|(m, f)| f - tilt * m.participation),
        );
        out
    };
    let grid_s = found.time_s[1];
    let parts = (grid_s / 100e-9).ceil();
    let dt = grid_s / parts;
    let mut y = vec![Complex::from(0.0); 2 * n];
    let (mut t, mut wanted) = (0.0, [Vec::new(), Vec::new(), Vec::new()]);
    for _ in &found.time_s {
        let turn = (i * alpha).exp();
        let tilt = y[0] - base(t).0;
        let pairs = || modes.iter().zip(&y[1..n]);
        let w: Complex<f64> =
            tilt * radius + pairs().map(|(m, q)| q * m.shape[0].0).sum::<Complex<f64>>();
        let slope: Complex<f64> =
            tilt + pairs().map(|(m, q)| q * m.shape[0].1).sum::<Complex<f64>>();
        wanted[0].push((turn * w).re);
        // Without skew x runs along the disk's velocity: pitch −w_θ/r, roll w_r.
        wanted[1].push(-(i * turn * w).re / radius);
        wanted[2].push((turn * slope).re);
        for _ in 0..parts as usize {
            y = runge_kutta::step(t, dt, &y, rate);
            t += dt;
        }
    }
    for (name, a, b, wanted) in [
        (
            "displacement",
            &found.disk_slider_m,
            &axial.disk_slider_m,
            &wanted[0],
        ),
        (
            "pitch",
            &found.disk_pitch_rad,
            &axial.disk_pitch_rad,
            &wanted[1],
        ),
        (
            "roll",
            &found.disk_roll_rad,
            &axial.disk_roll_rad,
            &wanted[2],
        ),
    ] {
        let tilting: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
        let share = distance(&tilting, wanted) / largest(wanted);
        println!("{name}: {share:.1e} of {:.3e}", largest(wanted));
        assert!(share < 1e-8, "{name}: {share:e}");
    }
}

#[test]
fn balances_close_under_an_oblique_shock_through_contact_by_both_methods() {
    let mut structure = shaken(Some(OBLIQUE));
    structure.ramp.contact_stiffness_n_per_m = None;
    let mut spindle_work = Vec::new();
    for structure in [structure.clone(), structure.with_moreau_jean()] {
        let run = run(&structure, 700.0);
        let hub = run.hub.expect("a hub");
        println!("{:?} {hub:?}", run.energy);
        assert!(run.first_touch_s.is_some());
        assert!(run.energy.closure < 1e-9, "{:?}", run.energy);
        // The reference method takes the pulse at the middle of its steps.
        assert!(hub.momentum.closure < 1e-5, "{hub:?}");
        assert!(hub.tilt_max_rad > 1e-5);
        assert!(run.energy.impact_loss_j >= 0.0);
        spindle_work.push(run.energy.spindle_work_j);
    }
    assert!(
        (spindle_work[0] / spindle_work[1] - 1.0).abs() < 0.05,
        "{spindle_work:?}"
    );
}

/// What a turning base adds to the axial load: the arm's length times the angular acceleration.
#[test]
fn a_turning_base_shakes_a_place_by_its_arm() {
    let about_x = ObliqueShock {
        rotation_per_m: [20.0, 0.0],
        ..ObliqueShock::default()
    };
    for (angle, wanted) in [(0.0, 1.0), (0.5 * PI, 1.6), (PI, 1.0), (-0.5 * PI, 0.4)] {
        assert!((about_x.axial_at(0.03, angle) - wanted).abs() < 1e-15);
    }
}

#[test]
fn an_oblique_shock_on_a_clamped_disk_is_refused() {
    let mut structure = drive(None);
    structure.oblique = Some(OBLIQUE);
    let refused =
        opshock_solver::structure::StructureModel::build(&structure.parameters(), Harmonics::All);
    assert!(refused.is_err_and(|error| error.to_string().contains("hub")));
}
