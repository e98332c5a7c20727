//! Disk on a hub with a fluid-dynamic bearing: limits, whirl of a rigid rotor, balances, both methods.

use std::f64::consts::{PI, TAU};

use opshock_solver::disk::{
    DiskBasis, DiskDamping, DiskParameters, DiskResolution, Harmonics, HubParameters,
};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{NoRamp, RigidRamp};
use opshock_solver::scene::Window;
use opshock_solver::structure::{HubModeRow, StructureRun, StructureWarning, Workspace, modes};
use opshock_tests::runge_kutta;
use opshock_tests::sheet::at_most;
use opshock_tests::structures::{Structure, paper};

/// A spindle of a 2.5-inch drive: 15 g on a bearing of 8 N/um and 300 N m/rad.
pub(super) fn spindle() -> HubParameters {
    HubParameters {
        mass_kg: 15e-3,
        transverse_inertia_kg_m2: 4e-7,
        polar_inertia_kg_m2: 6e-7,
        axial_stiffness_n_per_m: 8e6,
        axial_damping_n_s_per_m: 50.0,
        tilt_stiffness_n_m_per_rad: 300.0,
        tilt_damping_n_m_s_per_rad: 2e-3,
        cross_stiffness_n_m_per_rad: 1.0,
        cross_damping_n_m_s_per_rad: 1e-4,
        centre_height_m: 1.5e-3,
    }
}

/// The drive of Fig. 13 with a rigid ramp and modes to 12 kHz, 2 ms of it.
pub(super) fn drive(hub: Option<HubParameters>) -> Structure {
    let mut structure = paper(2e-3, RigidRamp);
    structure.disk.hub = hub;
    structure.disk_resolution.cut_hz = 12e3;
    structure.resolution.step_s = 1e-6;
    structure.window = Window::Fixed { length_s: 2e-3 };
    structure
}

pub(super) fn run(structure: &Structure, amplitude_g: f64) -> StructureRun {
    let model = structure.build();
    let run = model.run(amplitude_g * G, true, &mut Workspace::default());
    run.expect("runs")
}

pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(b);
    pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

pub(super) fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// Without contact n = 0 is compared, through contact both harmonics and its impulses.
#[test]
fn a_stiff_bearing_is_the_clamped_disk_to_a_billionth() {
    let stiff = HubParameters {
        axial_stiffness_n_per_m: 1e18,
        tilt_stiffness_n_m_per_rad: 3e12,
        ..spindle()
    };
    for amplitude_g in [100.0, 300.0] {
        let [on_hub, clamped] = [Some(stiff), None].map(|hub| {
            let mut structure = drive(hub);
            structure.window = Window::Fixed { length_s: 1e-3 };
            run(&structure, amplitude_g)
        });
        assert_eq!(clamped.first_touch_s.is_some(), amplitude_g > 200.0);
        let [a, b] = [&on_hub, &clamped].map(|run| run.columns.as_ref().expect("recorded"));
        for (x, y) in [
            (&a.disk_slider_m, &b.disk_slider_m),
            (&a.disk_ramp_m, &b.disk_ramp_m),
            (&a.disk_rim_m, &b.disk_rim_m),
            (&a.disk_pitch_rad, &b.disk_pitch_rad),
            (&a.disk_roll_rad, &b.disk_roll_rad),
        ] {
            let share = match largest(y) {
                0.0 => largest(x),
                most => distance(x, y) / most,
            };
            at_most(
                "stiff-bearing",
                "distance of any column from the clamped disk's, of its largest",
                share,
                1e-9,
            );
        }
        let impulses = [&on_hub, &clamped].map(|run| run.top.impulse_n_s);
        println!("impulses {impulses:?}");
        assert!((impulses[0] - impulses[1]).abs() <= 1e-8 * impulses[1]);
    }
}

/// A disk so stiff that only the rotor moves.
fn rigid_disk() -> (DiskParameters, DiskResolution) {
    let mut structure = drive(None);
    structure.disk.youngs_modulus_pa *= 1e10;
    structure.disk.damping = DiskDamping::ModalRatio(0.0);
    structure.disk_resolution.n_harmonics = 1;
    (structure.disk, structure.disk_resolution)
}

fn of_motion(rows: &[HubModeRow], motion: &str) -> Vec<HubModeRow> {
    let own = rows.iter().filter(|row| row.motion == motion);
    own.copied().collect()
}

#[test]
fn tilt_splits_into_the_forward_and_backward_whirl_of_a_rigid_rotor() {
    let hub = HubParameters {
        axial_damping_n_s_per_m: 0.0,
        tilt_damping_n_m_s_per_rad: 0.0,
        cross_stiffness_n_m_per_rad: 0.0,
        cross_damping_n_m_s_per_rad: 0.0,
        ..spindle()
    };
    let (mut disk, resolution) = rigid_disk();
    let ramp = drive(None).ramp;
    let (a, b) = (disk.inner_radius_m, disk.outer_radius_m);
    let areal = disk.density_kg_per_m3 * disk.thickness_m;
    let disk_mass = PI * areal * (b * b - a * a);
    let disk_inertia = 0.25 * PI * areal * (b.powi(4) - a.powi(4));
    // A disk is thin: its polar inertia is twice the transverse one.
    let inertia = hub.transverse_inertia_kg_m2 + disk_inertia;
    let polar = hub.polar_inertia_kg_m2 + 2.0 * disk_inertia;
    for rpm in [0.0, 5400.0, 15000.0, -5400.0] {
        disk.spin_rad_per_s = rpm * TAU / 60.0;
        disk.hub = Some(hub);
        let rows = modes(&disk, &resolution, &ramp).expect("modes").hub;
        let moment = polar * disk.spin_rad_per_s.abs();
        let root = (moment * moment + 4.0 * inertia * hub.tilt_stiffness_n_m_per_rad).sqrt();
        let wanted = [
            ("forward", (root + moment) / (2.0 * inertia)),
            ("backward", (root - moment) / (2.0 * inertia)),
            (
                "axial",
                (hub.axial_stiffness_n_per_m / (hub.mass_kg + disk_mass)).sqrt(),
            ),
        ];
        for (motion, wanted) in wanted {
            let found = of_motion(&rows, motion);
            if rpm == 0.0 && motion != "axial" {
                // At rest both senses are one.
                let all = of_motion(&rows, "forward");
                assert_eq!(all.len(), 1);
                assert!((all[0].frequency_hz * TAU / wanted - 1.0).abs() < 1e-9);
                continue;
            }
            // Axial motion of the disk itself, 1e5 times faster, is beyond the cut.
            assert_eq!(found.len(), 1, "{motion}");
            let share = found[0].frequency_hz * TAU / wanted - 1.0;
            at_most(
                "rigid-rotor",
                &format!("relative error of the frequency, {motion}"),
                share.abs(),
                1e-8,
            );
        }
    }
}

/// The undamped modes of the flexible disk on its hub are the roots of the hub's dynamic stiffness,
/// a scalar equation: an independent way to the same numbers.
#[test]
fn modes_with_the_hub_are_the_roots_of_its_dynamic_stiffness() {
    let hub = HubParameters {
        axial_damping_n_s_per_m: 0.0,
        tilt_damping_n_m_s_per_rad: 0.0,
        cross_stiffness_n_m_per_rad: 0.0,
        cross_damping_n_m_s_per_rad: 0.0,
        ..spindle()
    };
    let mut structure = drive(Some(hub));
    structure.disk.damping = DiskDamping::ModalRatio(0.0);
    let (disk, resolution) = (&structure.disk, &structure.disk_resolution);
    let rows = modes(disk, resolution, &structure.ramp).expect("modes").hub;
    let basis = DiskBasis::build(disk, resolution, &[], None, Harmonics::All).expect("basis");
    let (a, b) = (disk.inner_radius_m, disk.outer_radius_m);
    let areal = disk.density_kg_per_m3 * disk.thickness_m;
    let disk_mass = PI * areal * (b * b - a * a);
    let disk_inertia = 0.25 * PI * areal * (b.powi(4) - a.powi(4));
    let spin = disk.spin_rad_per_s;
    // (inertia load of the disk at the hub) for a motion e^{-iλt} in the fixed frame, μ = (λ − nΩ)² − n²Ω².
    let load = |n: usize, rigid: f64, mu: f64| {
        let turn = n as f64 * spin;
        let own = basis.modes.iter().filter(|m| m.nodal_diameters == n);
        let of_modes: f64 = own
            .map(|m| {
                let stiffness = m.omega_rad_per_s.powi(2) - turn * turn;
                m.participation.powi(2) / (stiffness - mu)
            })
            .sum();
        mu * rigid + mu * mu * of_modes
    };
    let axial = |l: f64| {
        let rigid = hub.axial_stiffness_n_per_m - hub.mass_kg * l * l;
        rigid - load(0, disk_mass, l * l)
    };
    let tilt = |l: f64| {
        let rigid = hub.tilt_stiffness_n_m_per_rad - hub.transverse_inertia_kg_m2 * l * l
            + hub.polar_inertia_kg_m2 * spin * l;
        rigid - load(1, disk_inertia, (l - spin).powi(2) - spin * spin)
    };
    let mut seen = [0; 3];
    for row in rows.iter().filter(|row| row.frequency_hz < 12e3) {
        let l = TAU * row.frequency_hz;
        let (kind, crosses) = match row.motion {
            "axial" => (0, axial(l * (1.0 - 1e-9)) * axial(l * (1.0 + 1e-9)) < 0.0),
            "forward" => (1, tilt(l * (1.0 - 1e-9)) * tilt(l * (1.0 + 1e-9)) < 0.0),
            _ => (2, tilt(-l * (1.0 - 1e-9)) * tilt(-l * (1.0 + 1e-9)) < 0.0),
        };
        println!("{} {:.3} Hz", row.motion, row.frequency_hz);
        assert!(crosses, "{row:?}");
        seen[kind] += 1;
    }
    assert!(seen.iter().all(|&n| n >= 3), "{seen:?}");
}

/// n = 0 on its hub by the classical Runge-Kutta rule: other matrices, other method, every 50 ns.
#[test]
fn a_flexible_disk_on_its_hub_answers_a_half_sine_as_direct_integration_does() {
    let hub = spindle();
    let structure = drive(Some(hub)).with_ramp(NoRamp);
    let run = run(&structure, 100.0);
    let (disk, radius) = (&structure.disk, structure.slider.radius_m);
    let symmetric = Harmonics::Symmetric;
    let basis = DiskBasis::build(disk, &structure.disk_resolution, &[radius], None, symmetric);
    let modes = basis.expect("basis").modes;
    let areal = disk.density_kg_per_m3 * disk.thickness_m;
    let (a, b) = (disk.inner_radius_m, disk.outer_radius_m);
    let mass = hub.mass_kg + PI * areal * (b * b - a * a);
    let carried: f64 = modes.iter().map(|m| m.participation.powi(2)).sum();
    let n = modes.len() + 1;
    let width = structure.pulse.width_s;
    // (u, q..., u', q'...)
    let rate = |t: f64, y: &[f64]| -> Vec<f64> {
        let pull = if t < width {
            100.0 * G * (PI * t / width).sin()
        } else {
            0.0
        };
        let (x, v) = y.split_at(n);
        let mut out = v.to_vec();
        let on_hub =
            mass * pull - hub.axial_stiffness_n_per_m * x[0] - hub.axial_damping_n_s_per_m * v[0];
        let on_mode: Vec<f64> = modes
            .iter()
            .enumerate()
            .map(|(j, m)| {
                let omega = m.omega_rad_per_s;
                m.participation * pull
                    - omega * omega * x[j + 1]
                    - 2.0 * m.damping_ratio * omega * v[j + 1]
            })
            .collect();
        let shared: f64 = modes
            .iter()
            .zip(&on_mode)
            .map(|(m, f)| m.participation * f)
            .sum();
        let u = (on_hub - shared) / (mass - carried);
        out.push(u);
        out.extend(
            modes
                .iter()
                .zip(&on_mode)
                .map(|(m, f)| f - m.participation * u),
        );
        out
    };
    let columns = run.columns.expect("recorded");
    let grid_s = columns.time_s[1];
    let parts = (grid_s / 50e-9).ceil();
    let dt = grid_s / parts;
    let mut y = vec![0.0; 2 * n];
    let (mut error, mut t) = (0.0_f64, 0.0);
    for w in &columns.disk_slider_m {
        let shapes = modes.iter().zip(&y[1..n]);
        let wanted = y[0] + shapes.map(|(m, q)| m.shape[0].0 * q).sum::<f64>();
        error = error.max((w - wanted).abs());
        for _ in 0..parts as usize {
            y = runge_kutta::step(t, dt, &y, rate);
            t += dt;
        }
    }
    let peak = largest(&columns.disk_slider_m);
    println!("{:.1e} of {:.3} um", error / peak, 1e6 * peak);
    assert!(error < 1e-8 * peak, "{error:e} of {peak:e}");
}

#[test]
fn momentum_and_energy_balances_close_through_contact() {
    for amplitude_g in [100.0, 400.0, -400.0] {
        let run = run(&drive(Some(spindle())), amplitude_g);
        let hub = run.hub.expect("a hub");
        println!("{amplitude_g} G: {hub:?} {:?}", run.energy);
        assert_eq!(run.first_touch_s.is_some(), amplitude_g.abs() > 200.0);
        assert!(hub.momentum.closure < 1e-9, "{hub:?}");
        assert!(run.energy.closure < 1e-9, "{:?}", run.energy);
        assert!(run.energy.impact_loss_j >= 0.0 && run.energy.algorithmic_j <= 1e-15);
        // The impulse of the shock is the rotor's mass times the velocity the base took.
        let disk = &drive(None).disk;
        let areal = disk.density_kg_per_m3 * disk.thickness_m;
        let (a, b) = (disk.inner_radius_m, disk.outer_radius_m);
        let mass = spindle().mass_kg + PI * areal * (b * b - a * a);
        let wanted = mass * amplitude_g * G * 2e-3 * 2.0 / PI;
        assert!((hub.momentum.shock_n_s / wanted - 1.0).abs() < 1e-12);
        assert_eq!(hub.tilt_max_rad > 0.0, run.first_touch_s.is_some());
    }
}

#[test]
fn both_contact_methods_carry_a_disk_on_a_hub_to_the_same_end() {
    let mut structure = drive(Some(spindle()));
    structure.ramp.contact_stiffness_n_per_m = None;
    structure.resolution.step_s = 0.25e-6;
    let exact = run(&structure, 300.0);
    let other = run(&structure.with_moreau_jean(), 300.0);
    let [a, b] = [&exact, &other].map(|run| run.columns.as_ref().expect("recorded"));
    let apart = distance(&a.disk_slider_m, &b.disk_slider_m);
    println!(
        "{:.4} um apart of {:.1}",
        1e6 * apart,
        1e6 * largest(&a.disk_slider_m)
    );
    assert!(apart > 0.0 && apart < 0.2e-6, "{apart:e}");
    for run in [&exact, &other] {
        let hub = run.hub.expect("a hub");
        assert!(run.energy.closure < 1e-9, "{:?}", run.energy);
        assert!(hub.momentum.closure < 1e-6, "{hub:?}");
    }
    let [x, y] = [&exact, &other].map(|run| run.hub.expect("a hub"));
    assert!((x.momentum.contact_n_s / y.momentum.contact_n_s - 1.0).abs() < 1e-2);
}

#[test]
fn a_bearing_whose_cross_stiffness_outweighs_its_damping_is_named() {
    let driven = HubParameters {
        cross_stiffness_n_m_per_rad: 200.0,
        ..spindle()
    };
    let growth = run(&drive(Some(driven)), 10.0)
        .warnings
        .iter()
        .find_map(|w| match w {
            StructureWarning::HubInstability {
                nodal_diameters: 1,
                growth_per_s,
            } => Some(*growth_per_s),
            _ => None,
        });
    assert!(growth.is_some_and(|g| g > 0.0), "{growth:?}");
    assert!(run(&drive(Some(spindle())), 10.0).warnings.is_empty());
}

/// Where a hub gives way the disk takes longer to bend: softer is slower and wider.
#[test]
fn a_softer_bearing_lets_the_disk_move_further() {
    let mut last = 0.0;
    for stiffness in [1e8, 1e7, 3e6] {
        let hub = HubParameters {
            axial_stiffness_n_per_m: stiffness,
            ..spindle()
        };
        let free = drive(Some(hub)).with_ramp(NoRamp);
        let reach = run(&free, 100.0).disk.slider_max_m;
        assert!(reach > last, "{stiffness:e}: {reach:e}");
        last = reach;
    }
}
