//! A base that vibrates: stiff and heavy limits, Duhamel's integral, direct integration, balances of energy and
//! momentum, both methods, a hub on it, what contact does to it.

use std::f64::consts::TAU;

use opshock_solver::disk::{Harmonics, HubParameters};
use opshock_solver::linalg::SquareMatrix;
use opshock_solver::modal::{CoupledModes, CoupledSystem};
use opshock_solver::ramp::{ArmMode, Arms, NoRamp, RampBody, RigidRamp};
use opshock_solver::scene::Window;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::shock::{BaseMode, BaseMotion, ObliqueShock, Pulse, PulseShape};
use opshock_solver::simulation::Model;
use opshock_solver::structure::{StructureError, StructureModel, StructureRun};
use opshock_tests::pairs::{coarse, run as run_scene};
use opshock_tests::scenes;
use opshock_tests::sheet::at_most;
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

pub(super) fn arms() -> RampBody {
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

pub(super) fn on(base: &[BaseMode], model: impl Into<RampBody>) -> Structure {
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
        let what = match mode.damping_ratio > 0.0 {
            true => "error of a mode's displacement, of its largest",
            false => "the same, undamped at its own rate",
        };
        at_most("duhamel", what, share, allowed);
        // b = a − ü, ü from the velocities.
        let t = 2.1e-3;
        let h = 1e-7;
        let rate = |t: f64| motion.displacement(t)[1];
        let load = motion.load(t, pulse.value(t));
        let wanted = pulse.value(t) - (rate(t + h) - rate(t - h)) / (2.0 * h);
        assert!((load - wanted).abs() < 1e-6, "{load} {wanted}");
    }
}

/// Through contact with mounts that move against one another, by exact flow and by Moreau-Jean steps.
#[test]
fn energy_is_balanced_through_contact_with_moving_mounts() {
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

/// Hub and base together: each in the limit of the other one stiff, and the balances of both.
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
    let balances = [
        run.hub.expect("a hub").momentum,
        run.base.expect("a base").momentum,
    ];
    println!("{:.1e}, {balances:?}", run.energy.closure);
    assert!(run.energy.closure < 1e-9);
    for balance in balances {
        assert!(
            balance.closure < 1e-9 && balance.contact_n_s != 0.0,
            "{balance:?}"
        );
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
