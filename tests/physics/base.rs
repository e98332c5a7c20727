//! A base that vibrates: stiff limit, Duhamel's integral, direct integration, books, both methods, the
//! price of leaving out what contact does to it.

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector};
use opshock_solver::disk::{DiskBasis, DiskMotion, Harmonics};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{ArmMode, RampModel};
use opshock_solver::scene::Window;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::shock::{BaseMode, BaseMotion, Mount, Pulse, PulseShape};
use opshock_solver::simulation::Model;
use opshock_solver::structure::{StructureError, StructureModel, StructureRun, StructureWarning};
use opshock_tests::pairs::{coarse, run as run_scene};
use opshock_tests::scenes;
use opshock_tests::structures::{Structure, half_sine};

use super::hub::{distance, drive, largest, run, spindle};

pub(super) const BASE: [BaseMode; 2] = [
    BaseMode {
        frequency_hz: 900.0,
        damping_ratio: 0.02,
        participation_sqrt_kg: 0.25,
        spindle_per_sqrt_kg: 0.5,
        ramp_per_sqrt_kg: 1.1,
        pivot_per_sqrt_kg: 0.5,
    },
    BaseMode {
        frequency_hz: 2300.0,
        damping_ratio: 0.01,
        participation_sqrt_kg: -0.1,
        spindle_per_sqrt_kg: 0.6,
        ramp_per_sqrt_kg: -1.4,
        pivot_per_sqrt_kg: 0.9,
    },
];

fn arms() -> RampModel {
    let mode = |frequency_hz: f64, participation: f64| ArmMode {
        frequency_hz,
        mass_kg: 2e-5,
        participation,
        damping_ratio: 0.02,
    };
    RampModel::Deformable {
        top: vec![mode(3100.0, 0.8)],
        bottom: vec![mode(2700.0, 0.7), mode(9000.0, 0.1)],
    }
}

fn on(base: &[BaseMode], model: RampModel) -> Structure {
    let mut structure = drive(None).with_ramp(model);
    structure.base = base.to_vec();
    structure
}

#[test]
fn a_stiff_base_is_the_rigid_base_to_a_billionth() {
    let stiff = BASE.map(|mode| BaseMode {
        frequency_hz: 1e5 * mode.frequency_hz,
        ..mode
    });
    let stiffer = stiff.map(|mode| BaseMode {
        frequency_hz: 1e15,
        ..mode
    });
    for (base, model, amplitude_g) in [
        (&stiff, RampModel::Rigid, 300.0),
        (&stiff, arms(), 300.0),
        (&stiff, arms(), -400.0),
        (&stiffer, arms(), 300.0),
    ] {
        let [a, b] = [&base[..], &[]].map(|base| {
            let mut structure = on(base, model.clone());
            structure.window = Window::Fixed { length_s: 1e-3 };
            run(&structure, amplitude_g)
        });
        assert!(b.first_touch_s.is_some());
        let [x, y] = [&a, &b].map(|run| run.columns.as_ref().expect("recorded"));
        for (name, x, y) in [
            ("slider", &x.disk_slider_m, &y.disk_slider_m),
            ("ramp", &x.disk_ramp_m, &y.disk_ramp_m),
            ("pitch", &x.disk_pitch_rad, &y.disk_pitch_rad),
            ("top", &x.ramp_top_m, &y.ramp_top_m),
        ] {
            let share = distance(x, y) / largest(y).max(1e-6);
            println!("{amplitude_g} G {name}: {share:.1e}");
            assert!(share < 1e-9, "{name}: {share:e}");
        }
    }
}

/// q = p/ω_d ∫ e^{−γ(t−s)} sin ω_d(t−s) a(s) ds by Simpson's rule between the pulse's kinks.
fn duhamel(mode: &BaseMode, pulse: &Pulse, time_s: f64, kinks: &[f64]) -> f64 {
    let omega = TAU * mode.frequency_hz;
    let gamma = mode.damping_ratio * omega;
    let swing = (omega * omega - gamma * gamma).sqrt();
    let value = |s: f64| {
        let t = time_s - s;
        mode.participation_sqrt_kg / swing * (-gamma * t).exp() * (swing * t).sin() * pulse.value(s)
    };
    let mut sum = 0.0;
    for ends in kinks.windows(2) {
        let (from, to) = (ends[0], ends[1].min(time_s));
        if to <= from {
            continue;
        }
        let n = 4000;
        let h = (to - from) / n as f64;
        for i in 0..n {
            let left = from + i as f64 * h;
            sum += h / 6.0 * (value(left) + 4.0 * value(left + 0.5 * h) + value(left + h));
        }
    }
    sum
}

fn alone(mode: &BaseMode, pulse: &Pulse) -> BaseMotion {
    let stretches = pulse.stretches().expect("stretches");
    BaseMotion::new(&[*mode], &[], &stretches, 1e-6).expect("a motion")
}

#[test]
fn a_mode_of_the_base_moves_by_duhamels_integral() {
    let width_s = 1.3e-3;
    let trapezoid = PulseShape::Trapezoid { rise_share: 0.2 };
    let damped = PulseShape::DampedSine {
        frequency_hz: 1500.0,
        decay_per_s: 800.0,
    };
    let rise = 0.2 * width_s;
    // The half-sine that meets an undamped mode at its own rate too.
    let resonant = BaseMode {
        frequency_hz: 0.5 / width_s,
        damping_ratio: 0.0,
        ..BASE[0]
    };
    for (shape, kinks, mode, allowed) in [
        (PulseShape::HalfSine, vec![0.0, width_s], BASE[0], 1e-12),
        (PulseShape::Haversine, vec![0.0, width_s], BASE[1], 1e-12),
        (
            trapezoid,
            vec![0.0, rise, width_s - rise, width_s],
            BASE[0],
            1e-12,
        ),
        (damped, vec![0.0, width_s], BASE[0], 1e-12),
        (PulseShape::HalfSine, vec![0.0, width_s], resonant, 5e-5),
    ] {
        let pulse = Pulse { shape, width_s };
        let motion = alone(&mode, &pulse);
        let times = (1..40).map(|k| 1e-4 * f64::from(k));
        let [found, wanted]: [Vec<f64>; 2] = [true, false].map(|ours| {
            let at = |t: f64| match ours {
                true => motion.displacement(Mount::Ramp, t)[0],
                false => mode.ramp_per_sqrt_kg * duhamel(&mode, &pulse, t, &kinks),
            };
            times.clone().map(at).collect()
        });
        let share = distance(&found, &wanted) / largest(&wanted);
        println!("{:?}: {share:.1e}", pulse.shape);
        assert!(share < allowed, "{share:e}");
        // b = a − ü, ü from the velocities.
        let t = 2.1e-3;
        let h = 1e-7;
        let rate = |t: f64| motion.displacement(Mount::Ramp, t)[1];
        let load = motion.load(Mount::Ramp, t, pulse.value(t));
        let wanted = pulse.value(t) - (rate(t + h) - rate(t - h)) / (2.0 * h);
        assert!((load - wanted).abs() < 1e-6, "{load} {wanted}");
    }
}

/// Base, disk and arms as one chain of oscillators by the classical Runge-Kutta rule.
struct Chain {
    base: Vec<BaseMode>,
    /// ω, γ, participation, mount.
    oscillators: Vec<OnMount>,
    pulse: Pulse,
    /// Whether what stands on the base pushes back.
    reacts: bool,
}

fn shape(mode: &BaseMode, mount: Mount) -> f64 {
    match mount {
        Mount::Spindle => mode.spindle_per_sqrt_kg,
        Mount::Ramp => mode.ramp_per_sqrt_kg,
        Mount::Pivot => mode.pivot_per_sqrt_kg,
    }
}

impl Chain {
    /// (velocities, accelerations) of base modes, then oscillators.
    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let n = self.base.len() + self.oscillators.len();
        let a = self.pulse.value(t);
        let (x, v) = y.split_at(n);
        let (speed, force) = out.split_at_mut(n);
        speed.copy_from_slice(v);
        let n_base = self.base.len();
        for (i, (omega, gamma, gain, _)) in self.oscillators.iter().enumerate() {
            let j = n_base + i;
            force[j] = gain * a - 2.0 * gamma * v[j] - omega * omega * x[j];
        }
        // [1, cᵀ; c, 1] of base and riders: the riders taken out leave 1 − Σ c cᵀ of the base.
        let mut mass = DMatrix::identity(n_base, n_base);
        let mut pull = DVector::zeros(n_base);
        for (k, mode) in self.base.iter().enumerate() {
            let omega = TAU * mode.frequency_hz;
            let damping = 2.0 * mode.damping_ratio * omega;
            pull[k] = mode.participation_sqrt_kg * a - damping * v[k] - omega * omega * x[k];
        }
        if self.reacts {
            let own = self.oscillators.iter().enumerate();
            for (i, (.., gain, _)) in own.filter(|(_, o)| o.3 == Mount::Spindle) {
                let c = DVector::from_iterator(
                    n_base,
                    self.base.iter().map(|mode| gain * mode.spindle_per_sqrt_kg),
                );
                pull -= &c * force[n_base + i];
                mass -= &c * c.transpose();
            }
        }
        let moved = mass
            .lu()
            .solve(&pull)
            .expect("a base heavier than its disk");
        force[..n_base].copy_from_slice(moved.as_slice());
        for (i, (.., gain, mount)) in self.oscillators.iter().enumerate() {
            for (k, mode) in self.base.iter().enumerate() {
                force[n_base + i] -= gain * shape(mode, *mount) * force[k];
            }
        }
    }

    /// Positions at k × `step_s`, k = 0 ..= `n`, with `parts` steps of the rule in each.
    fn march(&self, step_s: f64, n: usize, parts: usize) -> Vec<Vec<f64>> {
        let size = 2 * (self.base.len() + self.oscillators.len());
        self.march_from(vec![0.0; size], step_s, n, parts)
    }

    fn march_from(&self, mut y: Vec<f64>, step_s: f64, n: usize, parts: usize) -> Vec<Vec<f64>> {
        let size = y.len();
        let h = step_s / parts as f64;
        let mut k = vec![vec![0.0; size]; 4];
        let mut all = vec![y[..size / 2].to_vec()];
        let mut at = vec![0.0; size];
        for i in 0..n * parts {
            let t = i as f64 * h;
            for (stage, share) in [0.0, 0.5, 0.5, 1.0].into_iter().enumerate() {
                at.copy_from_slice(&y);
                if stage > 0 {
                    for (at, k) in at.iter_mut().zip(&k[stage - 1]) {
                        *at += share * h * k;
                    }
                }
                let mut out = std::mem::take(&mut k[stage]);
                self.rates(t + share * h, &at, &mut out);
                k[stage] = out;
            }
            for (j, y) in y.iter_mut().enumerate() {
                *y += h / 6.0 * (k[0][j] + 2.0 * k[1][j] + 2.0 * k[2][j] + k[3][j]);
            }
            if (i + 1) % parts == 0 {
                all.push(y[..size / 2].to_vec());
            }
        }
        all
    }
}

/// Angular frequency, half its damping rate, gain and mount of an oscillator.
type OnMount = (f64, f64, f64, Mount);

/// n = 0 of the disk as oscillators on the spindle, and their shapes under the slider.
fn disk_modes(structure: &Structure, radius_m: f64) -> (Vec<OnMount>, Vec<f64>) {
    let disk = &structure.disk;
    let radii = [radius_m];
    let resolution = &structure.disk_resolution;
    let basis = DiskBasis::build(disk, resolution, &radii, None, Harmonics::Symmetric);
    let modes = basis.expect("basis").modes;
    let own = modes.iter().filter(|mode| mode.nodal_circles.is_some());
    own.map(|mode| {
        let omega = mode.omega_rad_per_s;
        let gamma = mode.damping_ratio * omega + 0.5 * disk.space_fixed_damping_per_s;
        let gain = mode.participation;
        ((omega, gamma, gain, Mount::Spindle), mode.shape[0].0)
    })
    .unzip()
}

/// Before contact, one step of the grid and a half-sine that ends on it.
#[test]
fn disk_and_ramp_move_as_the_chain_integrated_directly() {
    let structure = on(&BASE, arms());
    let found = run(&structure, 60.0);
    assert_eq!(found.first_touch_s, None);
    let (mut oscillators, shapes) = disk_modes(&structure, structure.slider.radius_m);
    let n_disk = oscillators.len();
    let RampModel::Deformable { top, .. } = arms() else {
        unreachable!("arms")
    };
    let omega = TAU * top[0].frequency_hz;
    let gain = top[0].mass_kg.sqrt() * top[0].participation;
    oscillators.push((omega, top[0].damping_ratio * omega, gain, Mount::Ramp));
    let chain = Chain {
        base: BASE.to_vec(),
        oscillators,
        pulse: structure.pulse.clone(),
        reacts: true,
    };
    let columns = found.columns.expect("recorded");
    let n = columns.time_s.len() - 1;
    let step_s = columns.time_s[1];
    let states = chain.march(step_s, n, 8);
    let a = 60.0 * G;
    let moved = |state: &Vec<f64>, mount: Mount| -> f64 {
        BASE.iter()
            .zip(state)
            .map(|(m, q)| shape(m, mount) * q)
            .sum()
    };
    let disk = |state: &Vec<f64>| -> f64 {
        let own = shapes.iter().zip(&state[BASE.len()..]);
        own.map(|(shape, x)| shape * x).sum::<f64>() + moved(state, Mount::Spindle)
    };
    let slider: Vec<f64> = states.iter().map(|s| a * disk(s)).collect();
    let ramp: Vec<f64> = states
        .iter()
        .map(|s| {
            let own = s[BASE.len() + n_disk] / top[0].mass_kg.sqrt();
            a * (own + moved(s, Mount::Ramp))
        })
        .collect();
    let over_pivot: Vec<f64> = states
        .iter()
        .map(|s| a * (disk(s) - moved(s, Mount::Pivot)))
        .collect();
    let history: Vec<f64> = columns
        .time_s
        .iter()
        .map(|&t| found.history.pose(t).displacement_m)
        .collect();
    for (name, found, wanted) in [
        ("slider", &columns.disk_slider_m, &slider),
        ("ramp", &columns.ramp_top_m, &ramp),
        ("over the pivot", &history, &over_pivot),
    ] {
        let share = distance(found, wanted) / largest(wanted);
        println!("{name}: {share:.1e}");
        assert!(share < 1e-8, "{name}: {share:e}");
    }
    assert!(found.energy.closure < 1e-9, "{:e}", found.energy.closure);
}

/// Through contact with mounts that move against one another, by exact flow and by Moreau-Jean steps.
#[test]
fn energy_is_booked_through_contact_with_moving_mounts() {
    for (model, amplitude_g) in [(RampModel::Rigid, 350.0), (arms(), 450.0), (arms(), -350.0)] {
        let structure = on(&BASE, model);
        let exact = run(&structure, amplitude_g);
        let steps = run(&structure.with_step(2.5e-7).with_moreau_jean(), amplitude_g);
        for run in [&exact, &steps] {
            assert!(run.first_touch_s.is_some());
            println!("{amplitude_g} G: {:.1e}", run.energy.closure);
            assert!(run.energy.closure < 1e-9, "{:e}", run.energy.closure);
            assert!(run.energy.impact_loss_j >= 0.0);
        }
        assert!(exact.energy.algorithmic_j <= 0.0);
        let top = [&exact, &steps].map(|run| run.top.impulse_n_s + run.bottom.impulse_n_s);
        let motion = [&exact, &steps].map(|run| run.disk.slider_max_m - run.disk.slider_min_m);
        println!("impulses {top:?}, travel {motion:?}");
        assert!((motion[0] - motion[1]).abs() < 1e-6, "{motion:?}");
        assert!((top[0] / top[1] - 1.0).abs() < 0.05, "{top:?}");
        // The same shock without a base that moves is another one.
        let rigid = run(&on(&[], structure.ramp.model.clone()), amplitude_g);
        let of = |run: &StructureRun| run.top.impulse_n_s + run.bottom.impulse_n_s;
        assert!((of(&rigid) / of(&exact) - 1.0).abs() > 0.05);
    }
}

/// A base that moves all mounts alike is a rigid base under another shock: b(t), here as a table.
#[test]
fn a_base_that_moves_as_one_is_another_shock_for_the_whole_drive() {
    let alike = BaseMode {
        frequency_hz: 700.0,
        damping_ratio: 0.1,
        participation_sqrt_kg: 0.5,
        spindle_per_sqrt_kg: 1.6,
        ramp_per_sqrt_kg: 1.6,
        pivot_per_sqrt_kg: 1.6,
    };
    let mut scene = coarse(scenes::scene("fig13", "rigid", 0.5, &[]));
    scene.base = vec![alike];
    scene.head_resolution.tolerance = 1e-3;
    let model = Model::assemble(
        &scene,
        &Plan::new(&[Output::MinClearance], Mode::Auto),
        None,
    );
    let model = model.expect("builds");
    let motion = model.structure().base_motion().expect("a base");
    let plan = Plan::new(&[Output::MinClearance], Mode::Auto);
    let mut other = scene.clone();
    other.base.clear();
    let time_s: Vec<f64> = (0..=1600).map(|k| 5e-7 * f64::from(k)).collect();
    let relative = time_s
        .iter()
        .map(|&t| motion.load(Mount::Pivot, t, scene.pulse.value(t)))
        .collect();
    other.pulse = Pulse {
        width_s: time_s[1600],
        shape: PulseShape::Table { time_s, relative },
    };
    let mut rigid = scene.clone();
    rigid.base.clear();
    for amplitude_g in [150.0, 230.0, -150.0] {
        let [moving, felt, without] =
            [&scene, &other, &rigid].map(|scene| run_scene(scene, &plan, amplitude_g, None).1);
        let clearance = [&moving, &felt, &without].map(|run| run.min_clearance_m.expect("a head"));
        println!("{amplitude_g} G: {clearance:?}");
        assert!((clearance[0] - clearance[1]).abs() < 1e-3 * clearance[0].max(1e-9));
        assert!(moving.effects.contains(&"base.modes"));
        let impulse = [&moving, &felt].map(|run| run.top.impulse_n_s);
        assert!((impulse[0] - impulse[1]).abs() <= 1e-4 * impulse[1]);
    }
}

/// An impulse of the ramp on the disk moves the base as well, by its share of the base's mass, and is left
/// out; so would be the whole of the disk's pull, were base and disk not coupled before contact.
#[test]
fn what_is_left_out_of_the_base_is_in_proportion_to_the_disks_share_of_it() {
    let structure = drive(None);
    let (oscillators, shapes) = disk_modes(&structure, structure.slider.radius_m);
    let (_, at_ramp) = disk_modes(&structure, structure.ramp.radius_m);
    let disk = &structure.disk;
    let area = PI * (disk.outer_radius_m.powi(2) - disk.inner_radius_m.powi(2));
    let mass = disk.density_kg_per_m3 * disk.thickness_m * area;
    for frequency_hz in [300.0, 900.0, 2300.0] {
        let mut lost = Vec::new();
        for share in [1e-3, 1e-2, 5e-2] {
            let phi = f64::sqrt(share / mass);
            let base = BaseMode {
                frequency_hz,
                spindle_per_sqrt_kg: phi,
                ramp_per_sqrt_kg: 1.4 * phi,
                participation_sqrt_kg: 0.5 / phi,
                ..BASE[0]
            };
            let difference = |is_shock: bool| -> f64 {
                let marches = [true, false].map(|reacts| {
                    let mut pulse = half_sine(2e-3);
                    // Nothing but the impulse.
                    let impulse = if is_shock { 0.0 } else { 1.0 };
                    if !is_shock {
                        pulse.width_s = 1e-9;
                    }
                    let chain = Chain {
                        base: vec![base],
                        oscillators: oscillators.clone(),
                        pulse,
                        reacts,
                    };
                    let mut start = vec![0.0; 2 * (1 + oscillators.len())];
                    let n = 1 + oscillators.len();
                    for (v, shape) in start[n + 1..].iter_mut().zip(&at_ramp) {
                        *v = impulse * shape;
                    }
                    if reacts {
                        // M v = (φ_s − φ_r, φ) P.
                        let c = |i: usize| phi * oscillators[i].2;
                        let moved: f64 = (0..n - 1).map(|i| c(i) * start[n + 1 + i]).sum();
                        let effective = 1.0 - (0..n - 1).map(|i| c(i) * c(i)).sum::<f64>();
                        let v = (impulse * (phi - base.ramp_per_sqrt_kg) - moved) / effective;
                        start[n] = v;
                        for i in 0..n - 1 {
                            start[n + 1 + i] -= c(i) * v;
                        }
                    }
                    let states = chain.march_from(start, 1e-6, 2000, 4);
                    let disk = |s: &Vec<f64>| -> f64 {
                        shapes.iter().zip(&s[1..]).map(|(shape, x)| shape * x).sum()
                    };
                    states.iter().map(disk).collect::<Vec<f64>>()
                });
                distance(&marches[0], &marches[1]) / largest(&marches[0])
            };
            let [shock, impulse] = [true, false].map(difference);
            println!(
                "{frequency_hz} Hz, share {share}: uncoupled {shock:.1e}, impulse {impulse:.1e}"
            );
            lost.push(impulse / share);
            assert!(impulse < 20.0 * share, "{impulse:e}");
        }
        assert!((lost[0] / lost[1] - 1.0).abs() < 0.2, "{lost:?}");
    }
}

#[test]
fn a_base_that_cannot_be_is_refused_and_a_light_one_is_told() {
    let build = |structure: &Structure| {
        StructureModel::build(&structure.parameters(), Harmonics::All).map(|_| ())
    };
    let mut structure = on(&BASE, RampModel::None);
    assert_eq!(build(&structure), Ok(()));
    structure.disk.hub = Some(spindle());
    assert_eq!(build(&structure), Err(StructureError::Base));
    structure.disk.hub = None;
    for spoil in [
        |mode: &mut BaseMode| mode.frequency_hz = 0.0,
        |mode: &mut BaseMode| mode.damping_ratio = 1.0,
        |mode: &mut BaseMode| mode.pivot_per_sqrt_kg = f64::NAN,
    ] {
        structure.base = BASE.to_vec();
        spoil(&mut structure.base[1]);
        assert_eq!(build(&structure), Err(StructureError::Base));
    }
    structure.base = vec![BASE[0]; 17];
    assert_eq!(build(&structure), Err(StructureError::Base));
    structure.base = BASE.to_vec();
    let is_told = |structure: &Structure| {
        let warns = |w: &StructureWarning| matches!(w, StructureWarning::BaseReaction { .. });
        run(structure, 10.0).warnings.iter().any(warns)
    };
    assert!(!is_told(&structure));
    structure.base[0].spindle_per_sqrt_kg = 4.0;
    assert!(is_told(&structure));
}
