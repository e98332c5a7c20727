//! A base that vibrates: stiff and heavy limits, Duhamel's integral, direct integration, books of energy and
//! momentum, both methods, a hub on it, what contact does to it.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use opshock_solver::disk::{DiskBasis, DiskMotion, DiskPose, Harmonics, HubParameters};
use opshock_solver::head::{HeadWorkspace, ShockLoad};
use opshock_solver::linalg::SquareMatrix;
use opshock_solver::modal::{CoupledModes, CoupledSystem};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{ArmMode, Arms, NoRamp, RampBody, RigidRamp};
use opshock_solver::scene::Window;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::shock::{BaseMode, BaseMotion, ObliqueShock, Pulse, PulseShape};
use opshock_solver::simulation::Model;
use opshock_solver::structure::{StructureError, StructureModel, StructureRun};
use opshock_tests::pairs::{coarse, run as run_scene};
use opshock_tests::runge_kutta;
use opshock_tests::scenes;
use opshock_tests::structures::Structure;

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

fn arms() -> RampBody {
    let mode = |frequency_hz: f64, participation: f64| ArmMode {
        frequency_hz,
        mass_kg: 2e-5,
        participation,
        damping_ratio: 0.02,
    };
    Arms {
        top: vec![mode(3100.0, 0.8)],
        bottom: vec![mode(2700.0, 0.7), mode(9000.0, 0.1)],
    }
    .into()
}

fn on(base: &[BaseMode], model: impl Into<RampBody>) -> Structure {
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
        (&stiff, RigidRamp.into(), 300.0),
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
        for (name, x, y, allowed) in [
            ("slider", &x.disk_slider_m, &y.disk_slider_m, 1e-9),
            ("ramp", &x.disk_ramp_m, &y.disk_ramp_m, 1e-9),
            ("pitch", &x.disk_pitch_rad, &y.disk_pitch_rad, 1e-8),
            ("top", &x.ramp_top_m, &y.ramp_top_m, 1e-9),
        ] {
            let share = distance(x, y) / largest(y).max(1e-6);
            println!("{amplitude_g} G {name}: {share:.1e}");
            assert!(share < allowed, "{name}: {share:e}");
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
    let omega = TAU * mode.frequency_hz;
    let one = |x: f64| {
        let mut matrix = SquareMatrix::zeros(1);
        matrix.add(0, 0, x);
        matrix
    };
    let modes = CoupledModes::new(CoupledSystem {
        mass: one(1.0),
        damping: one(2.0 * mode.damping_ratio * omega),
        stiffness: one(omega * omega),
        ..CoupledSystem::zeros(vec![omega * omega])
    });
    let modes = modes.expect("one mode");
    let entrance = modes.entrance(&[mode.participation_sqrt_kg.into()]);
    let pivot = modes.readout(&[mode.pivot_per_sqrt_kg.into()]);
    BaseMotion::new(modes.rates_per_s(), &entrance, &pivot, &stretches)
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
                true => motion.displacement(t)[0],
                false => mode.pivot_per_sqrt_kg * duhamel(&mode, &pulse, t, &kinks),
            };
            times.clone().map(at).collect()
        });
        let share = distance(&found, &wanted) / largest(&wanted);
        println!("{:?}: {share:.1e}", pulse.shape);
        assert!(share < allowed, "{share:e}");
        // b = a − ü, ü from the velocities.
        let t = 2.1e-3;
        let h = 1e-7;
        let rate = |t: f64| motion.displacement(t)[1];
        let load = motion.load(t, pulse.value(t));
        let wanted = pulse.value(t) - (rate(t + h) - rate(t - h)) / (2.0 * h);
        assert!((load - wanted).abs() < 1e-6, "{load} {wanted}");
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Mount {
    Spindle,
    Ramp,
    Pivot,
}

/// Base, disk and arms as one chain of oscillators by the classical Runge-Kutta rule.
struct Chain {
    base: Vec<BaseMode>,
    /// ω, γ, participation, mount.
    oscillators: Vec<OnMount>,
    pulse: Pulse,
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
        for (i, (.., gain, mount)) in self.oscillators.iter().enumerate() {
            let c = DVector::from_iterator(
                n_base,
                self.base.iter().map(|mode| gain * shape(mode, *mount)),
            );
            pull -= &c * force[n_base + i];
            mass -= &c * c.transpose();
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
        let h = step_s / parts as f64;
        let rate = |t: f64, y: &[f64]| {
            let mut out = vec![0.0; y.len()];
            self.rates(t, y, &mut out);
            out
        };
        let mut y = vec![0.0; size];
        let mut all = vec![y[..size / 2].to_vec()];
        for i in 0..n * parts {
            y = runge_kutta::step(i as f64 * h, h, &y, rate);
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
    let arms = arms();
    oscillators.extend(arms.modes().iter().map(|mode| {
        let omega = TAU * mode.frequency_hz;
        let gain = mode.mass_kg.sqrt() * mode.participation;
        (omega, mode.damping_ratio * omega, gain, Mount::Ramp)
    }));
    let chain = Chain {
        base: BASE.to_vec(),
        oscillators,
        pulse: structure.pulse.clone(),
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
            let own = s[BASE.len() + n_disk] / arms.modes()[0].mass_kg.sqrt();
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
    for (model, amplitude_g) in [(RigidRamp.into(), 350.0), (arms(), 450.0), (arms(), -350.0)] {
        let structure = on(&BASE, model);
        let exact = run(&structure, amplitude_g);
        let steps = run(&structure.with_step(2.5e-7).with_moreau_jean(), amplitude_g);
        for run in [&exact, &steps] {
            assert!(run.first_touch_s.is_some());
            println!("{amplitude_g} G: {:.1e}", run.energy.closure);
            assert!(run.energy.closure < 1e-9, "{:e}", run.energy.closure);
            assert!(run.energy.impact_loss_j >= 0.0);
            let momentum = run.base.expect("a base").momentum;
            println!("momentum {momentum:?}");
            // Midpoint steps take the supports' impulse by the midpoint rule.
            let allowed = if run.steps == exact.steps { 1e-9 } else { 1e-6 };
            assert!(momentum.closure < allowed, "{momentum:?}");
            assert!(momentum.contact_n_s.abs() > 1e-6 * momentum.shock_n_s.abs());
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

/// A heavy base that moves all mounts alike is a rigid base under another shock: b(t), here as a table.
#[test]
fn a_base_that_moves_as_one_is_another_shock_for_the_whole_drive() {
    let alike = BaseMode {
        frequency_hz: 700.0,
        damping_ratio: 0.1,
        participation_sqrt_kg: 500.0,
        spindle_per_sqrt_kg: 1.6e-3,
        ramp_per_sqrt_kg: 1.6e-3,
        pivot_per_sqrt_kg: 1.6e-3,
    };
    let mut scene = coarse(scenes::scene("fig13-stiffness", "rigid", 0.5, &[]));
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
        .map(|&t| motion.load(t, scene.pulse.value(t)))
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

/// A disk at a given height, under a suspension whose pivot moves.
struct MovedPivot {
    /// Height of the disk and motion of the pivot at a time.
    disk_m: fn(f64) -> [f64; 2],
    pivot_m: fn(f64) -> [f64; 2],
    events_s: Vec<f64>,
}

impl DiskMotion for MovedPivot {
    fn pose(&self, time_s: f64) -> DiskPose {
        DiskPose {
            displacement_m: (self.disk_m)(time_s)[0],
            ..DiskPose::default()
        }
    }

    fn pose_rate(&self, time_s: f64) -> DiskPose {
        DiskPose {
            displacement_m: (self.disk_m)(time_s)[1],
            ..DiskPose::default()
        }
    }

    fn events_s(&self) -> &[f64] {
        &self.events_s
    }

    fn pivot(&self, time_s: f64) -> [f64; 2] {
        (self.pivot_m)(time_s)
    }
}

/// Period of the pivot's swing, s.
const SWING_S: f64 = 2.5e-4;

/// (1 − cos) swings of 3 um from 0.1 ms on, (displacement, velocity).
fn swung(time_s: f64) -> [f64; 2] {
    let omega = TAU / SWING_S;
    let t = (time_s - 1e-4).max(0.0);
    [
        1.5e-6 * (1.0 - (omega * t).cos()),
        1.5e-6 * omega * (omega * t).sin(),
    ]
}

/// A blow that gives the pivot 4 mm/s from 0.2 ms on, for 0.1 ms.
fn struck(time_s: f64) -> [f64; 2] {
    let speed = 4e-3;
    let t = (time_s - 2e-4).clamp(0.0, 1e-4);
    let is_moving = (2e-4..3e-4).contains(&time_s);
    [speed * t, if is_moving { speed } else { 0.0 }]
}

/// The pivot's motion told as such, or as a load −ü and a disk that moves the other way: the same clearance.
/// A blow, for which there is no load, is told as one of 10 ns.
#[test]
fn a_pivot_that_moves_is_a_load_and_a_jump_of_its_velocity_a_short_one() {
    let mut scene = coarse(scenes::scene("fig13-stiffness", "none", 0.5, &[]));
    scene.head_resolution.tolerance = 1e-3;
    let plan = Plan::new(&[Output::MinClearance], Mode::Auto);
    let model = Model::assemble(&scene, &plan, None).expect("builds");
    let head = model.head().expect("a head");
    let rest = |_: f64| [0.0; 2];
    let run = |motion: &MovedPivot, pulse: &Pulse, amplitude_m_per_s2: f64| {
        let load = ShockLoad {
            pulse,
            amplitude_m_per_s2,
            base: None,
        };
        let mut workspace = HeadWorkspace::new(head);
        let run = head.run(motion, &load, 5e-4, false, true, &mut workspace);
        (run.min_clearance_m, run.dimple.min_force_n)
    };
    let table = |time_s: Vec<f64>, relative: Vec<f64>| Pulse {
        width_s: time_s[time_s.len() - 1],
        shape: PulseShape::Table { time_s, relative },
    };
    // ü of the swings, and of a blow as triangles of 10 ns.
    let omega = TAU / SWING_S;
    let fine: Vec<f64> = (0..=2000).map(|k| 2.5e-7 * f64::from(k)).collect();
    let swings = fine.iter().map(|&t| match t < 1e-4 {
        true => 0.0,
        false => -1.5e-6 * omega * omega * (omega * (t - 1e-4)).cos(),
    });
    let swings = table(fine.clone(), swings.collect());
    let around = |at: f64| [at - 1e-8, at, at + 1e-8];
    let times = [&[0.0][..], &around(2e-4), &around(3e-4)].concat();
    let blow = table(times, vec![0.0, 0.0, -4e5, 0.0, 0.0, 4e5, 0.0]);
    let against: [fn(f64) -> [f64; 2]; 2] = [|t| swung(t).map(|x| -x), |t| struck(t).map(|x| -x)];
    let quiet = run(
        &MovedPivot {
            disk_m: rest,
            pivot_m: rest,
            events_s: vec![0.0],
        },
        &swings,
        0.0,
    );
    let told: [fn(f64) -> [f64; 2]; 2] = [swung, struck];
    for (k, (pulse, allowed)) in [(&swings, 5e-3), (&blow, 5e-2)].into_iter().enumerate() {
        let events_s = vec![0.0, 1e-4, 2e-4, 3e-4];
        let moved = MovedPivot {
            disk_m: rest,
            pivot_m: told[k],
            events_s: events_s.clone(),
        };
        let shaken = MovedPivot {
            disk_m: against[k],
            pivot_m: rest,
            events_s,
        };
        let (a, b) = (run(&moved, pulse, 0.0), run(&shaken, pulse, 1.0));
        println!("still {quiet:?}, moved {a:?}, shaken {b:?}");
        // In changes from rest, of the clearance and of the dimple's force.
        let change = (quiet.0 - b.0, quiet.1 - b.1);
        assert!(change.0 > 0.04 * quiet.0 && change.1 > 0.02 * quiet.1);
        assert!((a.0 - b.0).abs() < allowed * change.0);
        assert!((a.1 - b.1).abs() < allowed * change.1);
    }
}

/// What contact and the disk do to a base falls with the base's mass: by s at participations times 1/√s.
#[test]
fn a_heavier_base_feels_contact_less_in_proportion() {
    let of = |share: f64| {
        let factor = share.sqrt();
        let base = BASE.map(|mode| BaseMode {
            participation_sqrt_kg: mode.participation_sqrt_kg / factor,
            spindle_per_sqrt_kg: mode.spindle_per_sqrt_kg * factor,
            ramp_per_sqrt_kg: mode.ramp_per_sqrt_kg * factor,
            pivot_per_sqrt_kg: mode.pivot_per_sqrt_kg * factor,
            ..mode
        });
        // A spring of the contact: no impact instants that a small change would move.
        let mut structure = on(&base, arms());
        structure.ramp.contact_stiffness_n_per_m = Some(1e6);
        structure.window = Window::Fixed { length_s: 1.5e-3 };
        let run = run(&structure, 350.0);
        assert!(run.first_touch_s.is_some());
        run.columns.expect("recorded")
    };
    let heavy = of(1e-6);
    let [light, heavier] = [1e-1, 1e-2].map(|share| {
        let run = of(share);
        [
            distance(&run.disk_slider_m, &heavy.disk_slider_m) / largest(&heavy.disk_slider_m),
            distance(&run.base_ramp_m, &heavy.base_ramp_m) / largest(&heavy.base_ramp_m),
        ]
    });
    println!("disk and ramp's mount: {light:?} at 10 times the mass, {heavier:?} at 100 times it");
    assert!(light[1] > 1e-4 && (light[1] / heavier[1] / 10.0 - 1.0).abs() < 0.01);
    // The disk after contact also differs by where in a step its contacts fall.
    assert!(light[0] < 1e-3 && heavier[0] < 0.5 * light[0]);
}

/// Hub and base together: each in the limit of the other one stiff, and the books of both.
#[test]
fn a_hub_on_a_base_has_the_limits_of_each_alone() {
    let stiff_hub = HubParameters {
        axial_stiffness_n_per_m: 1e18,
        tilt_stiffness_n_m_per_rad: 3e12,
        ..spindle()
    };
    let stiff_base = BASE.map(|mode| BaseMode {
        frequency_hz: 1e5 * mode.frequency_hz,
        ..mode
    });
    let built = |hub: Option<HubParameters>, base: &[BaseMode]| {
        let mut structure = on(base, arms());
        structure.disk.hub = hub;
        structure.window = Window::Fixed { length_s: 1e-3 };
        run(&structure, 350.0)
    };
    for (both, alone) in [
        (built(Some(stiff_hub), &BASE), built(None, &BASE)),
        (
            built(Some(spindle()), &stiff_base),
            built(Some(spindle()), &[]),
        ),
    ] {
        assert!(alone.first_touch_s.is_some());
        let [x, y] = [&both, &alone].map(|run| run.columns.as_ref().expect("recorded"));
        for (name, x, y, allowed) in [
            ("slider", &x.disk_slider_m, &y.disk_slider_m, 1e-9),
            ("pitch", &x.disk_pitch_rad, &y.disk_pitch_rad, 1e-8),
            ("top", &x.ramp_top_m, &y.ramp_top_m, 1e-9),
        ] {
            let share = distance(x, y) / largest(y);
            println!("{name}: {share:.1e}");
            assert!(share < allowed, "{name}: {share:e}");
        }
    }
    let run = built(Some(spindle()), &BASE);
    let books = [
        run.hub.expect("a hub").momentum,
        run.base.expect("a base").momentum,
    ];
    println!("{:.1e}, {books:?}", run.energy.closure);
    assert!(run.energy.closure < 1e-9);
    for book in books {
        assert!(book.closure < 1e-9 && book.contact_n_s != 0.0, "{book:?}");
    }
}

#[test]
fn a_base_that_cannot_be_is_refused() {
    let build = |structure: &Structure| {
        StructureModel::build(&structure.parameters(), Harmonics::All).map(|_| ())
    };
    let mut structure = on(&BASE, NoRamp);
    assert_eq!(build(&structure), Ok(()));
    structure.disk.hub = Some(spindle());
    assert_eq!(build(&structure), Ok(()));
    structure.oblique = Some(ObliqueShock::default());
    assert_eq!(build(&structure), Err(StructureError::Base));
    (structure.disk.hub, structure.oblique) = (None, None);
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
    // 5 g of disk on a base of 4 g.
    structure.base = BASE.to_vec();
    structure.base[0].spindle_per_sqrt_kg = 16.0;
    assert_eq!(build(&structure), Err(StructureError::Base));
}
