//! Hard cases B of disk and ramp: sticking, resting, both arms, light and heavy arms, signs.

use super::check::{Check, largest};
use super::naive;
use super::scenes::noted::note;
use super::scenes::structures::{Structure, s1, s1_arms};
use super::structure::{run, slider_distance};
use opshock_solver::disk::{DiskDamping, DiskMotion, Harmonics};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{NoRamp, RampBody, RampError, RigidRamp};
use opshock_solver::structure::{
    StructureError, StructureModel, StructureRun, StructureWarning, Window, Workspace,
};
use std::f64::consts::PI;

/// The four cases of set S1 with the default modes, and their amplitudes.
fn cases() -> Vec<(Structure, f64)> {
    [
        (RampBody::from(RigidRamp), 2e-3, 400.0),
        (s1_arms(), 2e-3, 400.0),
        (RigidRamp.into(), 5e-4, 200.0),
        (s1_arms(), 5e-4, 200.0),
    ]
    .into_iter()
    .map(|(model, width, g)| {
        let mut structure = s1(width, model).with_cut(20e3);
        structure.disk_resolution.static_correction = true;
        (structure, g * G)
    })
    .collect()
}

pub(super) fn b1() -> Vec<Check> {
    let mut runs = Vec::new();
    for (structure, amplitude) in cases() {
        for restitution in [0.0, 0.5] {
            let mut structure = structure.clone();
            structure.ramp.restitution = restitution;
            runs.push(run(&structure, amplitude));
        }
    }
    vec![
        Check::new(
            "most negative impulse of the ramp, N s",
            largest(runs.iter().map(|r| -r.complementarity.min_multiplier_n_s)),
            0.0,
        )
        .against(
            "gap held at zero by an equation, a mode of 1 kg at 1 kHz pushed and pulled by 1 N",
            naive::contact::held_by_an_equation(1e-6),
        ),
        Check::new(
            "largest penetration, m",
            largest(runs.iter().map(|r| r.complementarity.max_penetration_m)),
            1e-7,
        ),
        Check::new(
            "largest impulse x gap, N s m",
            largest(runs.iter().map(|r| r.complementarity.max_product_n_s_m)),
            1e-13,
        ),
    ]
}

pub(super) fn b7() -> Vec<Check> {
    let mut structure = s1(40e-3, RigidRamp).with_cut(10e3).with_step(2e-6);
    structure.disk_resolution.static_correction = true;
    structure.disk.damping = DiskDamping::ModalRatio(0.3);
    structure.window = Window::Fixed { length_s: 45e-3 };
    let run = run(&structure, 800.0 * G);
    let force = &run.columns.as_ref().expect("recorded").contact_top_n;
    let peak = largest(force.iter().copied());
    // After the vibration of the first impact has decayed: the disk leans, the force follows the pulse.
    let from = (12e-3 / 2e-6) as usize;
    let variation: f64 = force[from..].windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    let leaning = largest(force[from..].iter().copied());
    let longest = largest(run.top.episodes.iter().map(|e| e.off_s - e.on_s));
    vec![
        Check::new(
            "variation of the force, of a rise and a fall",
            variation / (2.0 * leaning),
            1.05,
        )
        .against(
            "stop as a condition on displacements under Newmark, a mode at 1 kHz",
            naive::contact::leaning_under_newmark(),
        ),
        Check::new("spells with the ramp", run.top.episodes.len() as f64, 3.0),
        Check::new("longest spell short of 25 ms, s", 25e-3 - longest, 0.0),
        Check::none("contacts that carry nothing", usize::from(peak < 0.5)),
    ]
}

pub(super) fn b8() -> Vec<Check> {
    let (mut held, mut unequal, mut penetration, mut silent) = (0.0_f64, 0, 0.0_f64, 0);
    for clearance in [0.0, 1e-12] {
        for model in [RampBody::from(RigidRamp), s1_arms()] {
            let rigid = model.modes().is_empty();
            let mut structure = s1(2e-3, model).with_cut(20e3);
            structure.ramp.clearance_top_m = clearance;
            structure.ramp.clearance_bottom_m = clearance;
            let (plus, minus) = (run(&structure, 400.0 * G), run(&structure, -400.0 * G));
            unequal += usize::from(plus.top.impulse_n_s != minus.bottom.impulse_n_s);
            penetration = penetration.max(plus.complementarity.max_penetration_m);
            if rigid {
                held = held.max(plus.disk.ramp_max_m.max(-plus.disk.ramp_min_m));
                let reported = plus.warnings.contains(&StructureWarning::BothArmsOnePoint);
                silent += usize::from(clearance == 0.0 && !reported);
            }
        }
    }
    vec![
        Check::new("motion of a point held from both sides, m", held, 2e-8),
        Check::none("impulses that are not each other's mirror", unequal).against(
            "an equation an arm: impulses that are no numbers",
            naive::contact::held_from_both_sides(2.0, 0.1)
                .iter()
                .filter(|p| !p.is_finite())
                .count() as f64,
        ),
        Check::new("largest penetration, m", penetration, 1e-7),
        Check::none("rank deficiency not reported", silent),
    ]
}

pub(super) fn b9() -> Vec<Check> {
    let mut structure = s1(2e-3, RigidRamp).with_cut(20e3);
    structure.ramp.clearance_top_m = 0.0;
    let touching = run(&structure, 1.0);
    let kick = touching.history.pose_rate(0.0).displacement_m.abs();
    structure.ramp.clearance_top_m = -1e-6;
    let refused = StructureModel::build(&structure.parameters(), Harmonics::All).err();
    let expected = StructureError::Ramp(RampError::Overlap {
        side: "top",
        amount_m: 1e-6,
    });
    vec![
        Check::new("velocity of a touching start, m/s", kick, 1e-12).against(
            "1 um of overlap pushed out in a step of 0.5 us",
            1e-6 / 0.5e-6,
        ),
        Check::none(
            "overlaps not refused with side and amount",
            usize::from(refused != Some(expected)),
        ),
    ]
}

pub(super) fn b11() -> Vec<Check> {
    let base = s1(5e-4, RigidRamp).with_cut(15e3);
    let amplitude = 200.0 * G;
    let scaled = |factor: f64, keep_stiffness: bool| {
        let mut arms = s1_arms();
        for mode in arms.contacts.iter_mut().flatten() {
            mode.mass_kg *= factor;
            mode.participation = 0.0;
            if keep_stiffness {
                mode.frequency_hz /= factor.sqrt();
            }
        }
        base.with_ramp(arms)
    };
    let none = run(&base.with_ramp(NoRamp), amplitude);
    let rigid = run(&base, amplitude);
    let travel = none.disk.slider_max_m;
    let light = run(&scaled(1e-9, false), amplitude);
    let heavy = [false, true].map(|keep| run(&scaled(1e9, keep), amplitude));
    let (mut closure, mut gain) = (0.0_f64, f64::MIN);
    for exponent in [-9, -6, -3, 0, 3, 6, 9] {
        for keep in [false, true] {
            let energy = run(&scaled(10_f64.powi(exponent), keep), amplitude).energy;
            closure = closure.max(energy.closure);
            gain = gain.max(energy.algorithmic_j / energy.h_peak_j);
        }
    }
    vec![
        Check::new(
            "1e-9: distance to no ramp",
            slider_distance(&light, &none) / travel,
            1e-6,
        ),
        Check::new(
            "1e+9: distance to the rigid ramp",
            largest(heavy.iter().map(|h| slider_distance(h, &rigid) / travel)),
            1e-6,
        ),
        Check::new("energy balance, 1e-9 to 1e+9", closure, 1e-9),
        Check::new("energy made by the scheme, of the peak", gain, 1e-15).against(
            "central differences, first mode of the arm of 1e-9, 0.5 us, 5 steps",
            naive::time::central_differences_gain(2.0 * PI * 904.7 * 1e9_f64.sqrt() * 0.5e-6, 5)
                - 1.0,
        ),
    ]
}

pub(super) fn b12() -> Vec<Check> {
    let impulse = |cut: f64, restitution: f64| {
        let mut structure = s1(2e-3, RigidRamp).with_cut(cut);
        structure.disk_resolution.static_correction = true;
        structure.ramp.restitution = restitution;
        run(&structure, 400.0 * G).top.impulse_n_s
    };
    let cuts = [2.5e3, 5e3, 10e3, 20e3, 40e3];
    let spread = cuts.map(|cut| (impulse(cut, 1.0) / impulse(cut, 0.0) - 1.0).abs());
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    vec![
        Check::new(
            "impulse, e = 1 against e = 0, modes to 40 kHz",
            spread[4],
            0.03,
        )
        .against("modes to 2.5 kHz", spread[0]),
        Check::new(
            "mean of the three finer, of the three coarser cuts",
            mean(&spread[2..]) / mean(&spread[..3]),
            0.7,
        ),
    ]
}

pub(super) fn b14() -> Vec<Check> {
    // Spells of contact begin and end between time steps, so the order shows in the mean of the cases.
    let mut order = 0.0;
    for (mut structure, amplitude) in cases() {
        structure.disk_resolution.static_correction = false;
        let fine = run(&structure.with_step(0.0625e-6), amplitude);
        let error = |h: f64| slider_distance(&run(&structure.with_step(h), amplitude), &fine);
        order += 0.25 * (error(2e-6) / error(0.25e-6)).log2() / 3.0;
    }
    let mut coarse = cases().remove(2);
    coarse.0.window = Window::Fixed { length_s: 2e-3 };
    let truth = run(&coarse.0.with_step(0.125e-6), coarse.1);
    let exact = slider_distance(&run(&coarse.0, coarse.1), &truth);
    let moreau = slider_distance(&run(&coarse.0.with_moreau_jean(), coarse.1), &truth);
    vec![
        Check::new("mean order across contacts, short of 1.5", 1.5 - order, 0.0),
        Check::new("error at 0.5 us, m", exact, 2e-9)
            .against("Moreau-Jean steps of 0.5 us", moreau),
    ]
}

pub(super) fn b16() -> Vec<Check> {
    let (mut closure, mut open, mut dropped) = (0.0_f64, 0, f64::INFINITY);
    for (width, g) in [(5e-4, 200.0), (5e-4, -300.0), (2e-3, 400.0)] {
        let run: StructureRun = run(&s1(width, s1_arms()).with_cut(20e3), g * G);
        closure = closure.max(run.energy.closure);
        dropped = dropped.min(run.energy.impact_loss_j / run.energy.h_peak_j);
        open += usize::from(run.top.episodes.len() + run.bottom.episodes.len() < 2);
    }
    vec![
        Check::new("energy balance of arms let go while bent", closure, 1e-9).against(
            "balance without what contact takes: least of three",
            dropped,
        ),
        Check::none("runs without contact and release", open),
    ]
}

pub(super) fn b17() -> Vec<Check> {
    let (mut differing, mut touched) = (0, 0);
    for (structure, amplitude) in cases() {
        let (plus, minus) = (run(&structure, amplitude), run(&structure, -amplitude));
        let pairs = plus.history.nodes().iter().zip(minus.history.nodes());
        differing += pairs
            .filter(|(a, b)| {
                a.displacement_m != -b.displacement_m
                    || a.pitch_rad != -b.pitch_rad
                    || a.roll_rad != -b.roll_rad
            })
            .count();
        differing += usize::from(plus.top != minus.bottom || plus.bottom != minus.top);
        touched += usize::from(plus.first_touch_s.is_some());
    }
    let one_by_one = naive::contact::one_after_the_other(2.0, 1.0, [0.1, 0.1]);
    vec![
        Check::none("nodes that are not the mirror to the last bit", differing).against(
            "both arms closing at 0.1 m/s, one after the other: impulses that differ",
            f64::from(u8::from(one_by_one[0] != one_by_one[1])),
        ),
        Check::none("cases without contact", 4 - touched),
    ]
}

pub(super) fn b18() -> Vec<Check> {
    let mut workspace = Workspace::default();
    let structures =
        [RampBody::from(NoRamp), RigidRamp.into(), s1_arms()].map(|m| s1(5e-4, m).with_cut(20e3));
    let models = structures.each_ref().map(Structure::build);
    let onsets = models[1..]
        .iter()
        .filter_map(|m| m.touch_amplitude_m_per_s2(true));
    let onset = onsets.fold(f64::MAX, f64::min);
    let mut differing = 0;
    for amplitude in [0.999 * onset, -0.5 * onset] {
        structures.iter().for_each(|s| note(s, amplitude));
        let runs = models
            .each_ref()
            .map(|m| m.run(amplitude, false, &mut workspace).expect("runs"));
        for other in &runs[1..] {
            let pairs = runs[0].history.nodes().iter().zip(other.history.nodes());
            differing += pairs.filter(|(a, b)| a != b).count();
        }
    }
    vec![
        Check::none(
            "nodes that differ among none, rigid and deformable",
            differing,
        )
        .against(
            "steps halved where there is a ramp: of 10000 nodes of a mode at 1150 Hz",
            naive::time::nodes_moved_by_half_steps(10_000) as f64,
        ),
    ]
}
