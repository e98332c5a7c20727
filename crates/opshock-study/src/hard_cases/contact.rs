//! B: disk and ramp in contact.

use super::Check;
use super::naive;
use super::scenes::bodies::Body;
use super::scenes::noted::note;
use super::scenes::structures::{Structure, paper, paper_arms, s1, s1_arms};
use super::structure::{run, slider_distance};
use opshock_solver::complementarity::{ImpactLaw, ImpulseKind};
use opshock_solver::disk::{DiskDamping, DiskMotion, Harmonics};
use opshock_solver::linalg::{SquareMatrix, dense};
use opshock_solver::modal::Oscillator;
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{NoRamp, RampBody, RampError, RigidRamp};
use opshock_solver::structure::{
    StructureError, StructureModel, StructureRun, StructureWarning, Window, Workspace,
};
use std::f64::consts::PI;

fn law(restitution: f64) -> ImpactLaw {
    ImpactLaw {
        restitution,
        gap_tolerance_m: 1e-12,
        max_impacts_per_step: 8,
    }
}

/// The four cases of set S1 with the modes a user gets, and their amplitudes.
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

fn largest(figures: impl IntoIterator<Item = f64>) -> f64 {
    figures.into_iter().fold(0.0, f64::max)
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

pub(super) fn b2() -> Vec<Check> {
    let omega = 2.0 * PI;
    let (mut late, mut slow) = (0.0_f64, 0.0_f64);
    for e in [1.0, 0.8_f64] {
        let mut mass = Body::point(1.0, omega, 0.0, 0.0);
        mass.v[0] = 1.0;
        while mass.time_s < 50.3 {
            mass.advance(0.01, &law(e));
        }
        let impacts = mass.impulses.iter().filter(|i| i.1 > 0.0);
        let mut count = 0;
        for (impact, k) in impacts.zip(1..) {
            late = late.max((impact.0 - f64::from(k) * PI / omega).abs());
            slow = slow.max((impact.3 - e.powi(k - 1)).abs());
            count = k;
        }
        if count != 100 {
            late = f64::INFINITY;
        }
    }
    vec![
        Check::new("times of 100 impacts, of the period", late, 1e-9).against(
            "looked at step ends only, steps of 0.01",
            naive::contact::impacts_at_step_ends(0.010_03),
        ),
        Check::new("speeds of 100 impacts against e^k", slow, 1e-9),
    ]
}

pub(super) fn b3() -> Vec<Check> {
    // The stop is an arm of hardly any mass on a spring of 1 MN/m.
    let (mass, arm) = (100.0_f64, 1e-4_f64);
    let mut body = Body::new(
        vec![
            Oscillator::fixed(10.0, 0.0),
            Oscillator::fixed((1e6 / arm).sqrt(), 0.0),
        ],
        vec![-1.0 / mass.sqrt(), 1.0 / arm.sqrt()],
        vec![0.0, 0.0],
        0.0,
    );
    body.v[0] = mass.sqrt();
    let mut deepest = 0.0_f64;
    while body.time_s < 0.05 {
        body.advance(1e-6, &law(0.0));
        deepest = deepest.max(body.x[0] / mass.sqrt());
    }
    let strong: Vec<f64> = body
        .impulses
        .iter()
        .filter(|i| i.1 > 1e-6)
        .map(|i| i.0)
        .collect();
    let span = strong
        .last()
        .zip(strong.first())
        .map_or(f64::NAN, |(b, a)| b - a);
    // Means over 100 steps of 1 us.
    let force = body
        .impulses
        .windows(100)
        .map(|w| w.iter().map(|i| i.1).sum::<f64>() / 1e-4)
        .fold(0.0, f64::max);
    let impulse: f64 = body.impulses.iter().map(|i| i.1).sum();
    let of = |found: f64, exact: f64| (found / exact - 1.0).abs();
    vec![
        Check::new("peak displacement", of(deepest, 9.950_371_902e-3), 1e-3),
        Check::new("peak force of the stop", of(force, 9_950.371_902), 1e-3),
        Check::new("impulse of the stop", of(impulse, 198.019_802_0), 1e-3),
        Check::new(
            "duration of contact, s",
            (span - 31.260_015_27e-3).abs(),
            3.1e-5,
        ),
        Check::new("energy gained", body.energy_j() / 50.0 - 1.0, 1e-12).against(
            "explicit steps of 18 ms",
            naive::contact::penalty_energy_gain(0.018) - 1.0,
        ),
    ]
}

/// Free bar of 100 linear elements with consistent mass, as modes; contact at its lower end.
fn bar() -> Body {
    let (n, l) = (101, 0.1);
    let (mut k, mut m) = (SquareMatrix::zeros(n), SquareMatrix::zeros(n));
    for e in 0..n - 1 {
        for (a, b, stiff, mass) in [
            (0, 0, 1.0, 2.0),
            (0, 1, -1.0, 1.0),
            (1, 0, -1.0, 1.0),
            (1, 1, 1.0, 2.0),
        ] {
            k.add(e + a, e + b, stiff * 900.0 / l);
            m.add(e + a, e + b, mass * l / 6.0);
        }
    }
    let pairs = dense::modes_of_free_body(&k, &m).expect("a bar has modes");
    let largest = pairs.values[n - 1];
    let rigid = |v: f64| v < 1e-9 * largest;
    let oscillators = pairs
        .values
        .iter()
        .map(|&v| Oscillator::fixed(if rigid(v) { 0.0 } else { v.sqrt() }, 0.0))
        .collect();
    let shape: Vec<f64> = pairs.vectors.iter().map(|x| x[0]).collect();
    let mut body = Body::new(oscillators, shape, vec![0.0; n], 5.0);
    // Uniform velocity of -10: the rigid mode alone carries it.
    for (j, &v) in pairs.values.iter().enumerate() {
        if rigid(v) {
            body.v[j] = -10.0 * 10.0_f64.sqrt() * body.shape[j].signum();
        }
    }
    body
}

pub(super) fn b4() -> Vec<Check> {
    let transit = 0.1 / 30.0;
    let (on, off) = (0.5, 0.5 + 20.0 / 30.0);
    let (mut gain, mut lost, mut mean_error, mut rms, mut momentum) =
        (f64::MIN, 0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let mut ends = 0.0_f64;
    for ratio in [0.5, 1.0, 2.0] {
        let mut body = bar();
        let start = body.energy_j();
        while body.time_s < 2.0 {
            body.advance(ratio * transit, &law(0.0));
            gain = gain.max(body.energy_j() / start - 1.0);
        }
        lost = lost.max(1.0 - body.energy_j() / start);
        let total: f64 = body.impulses.iter().map(|i| i.1).sum();
        momentum = momentum.max((total / 200.0 - 1.0).abs());
        // A push: at least a hundredth of what the plateau's force of 300 gives in a step.
        let least = 0.01 * 300.0 * ratio * transit;
        let pushes = || body.impulses.iter().filter(|i| i.1 > least);
        for (impulse, exact) in [(pushes().next(), on), (pushes().next_back(), off)] {
            let at = impulse.map_or(f64::NAN, |i| i.0);
            // Elements tell times apart no better than their transit, steps than their length.
            let apart = (at - exact).abs() / (ratio.max(1.0) * transit);
            ends = if apart.is_nan() {
                apart
            } else {
                ends.max(apart)
            };
        }
        let window = 8.0 * transit;
        let force = |from: f64| {
            let inside = body
                .impulses
                .iter()
                .filter(|i| i.0 >= from - 1e-9 && i.0 < from + window - 1e-9);
            inside.map(|i| i.1).sum::<f64>() / window / 300.0
        };
        let plateau: Vec<f64> = (1..)
            .map(|k| on + f64::from(k) * window)
            .take_while(|t| t + 3.0 * window < off)
            .map(force)
            .collect();
        let n = plateau.len() as f64;
        mean_error = mean_error.max((plateau.iter().sum::<f64>() / n - 1.0).abs());
        rms = rms.max((plateau.iter().map(|f| (f - 1.0).powi(2)).sum::<f64>() / n).sqrt());
    }
    vec![
        Check::new("energy above the start", gain, 1e-12).against(
            "Newmark with the constraint on displacements, half a transit a step",
            naive::contact::newmark_bar_energy(0.5) - 1.0,
        ),
        Check::new("energy lost", lost, 0.02),
        Check::new(
            "mean force on the plateau against v0 sqrt(E rho)",
            mean_error,
            0.01,
        ),
        Check::new("rms of the force over 8 transits", rms, 0.05),
        Check::new(
            "first and last push against 0.5 s and 2 L/c later, steps or elements",
            ends,
            2.0,
        ),
        Check::new("momentum of the rebound", momentum, 0.03),
    ]
}

pub(super) fn b5() -> Vec<Check> {
    let (omega, gap) = (2.0 * PI * 1000.0, 1e-4);
    let small = ImpactLaw {
        gap_tolerance_m: 1e-15,
        ..law(0.0)
    };
    // g = gap - x, thrown so that x peaks at gap (1 + excess).
    let throw = |excess: f64| {
        let mut mass = Body::new(
            vec![Oscillator::fixed(omega, 0.0)],
            vec![-1.0],
            vec![0.0],
            gap,
        );
        mass.v[0] = omega * gap * (1.0 + excess);
        let (mut steps, mut ends) = (0_u32, 0_u32);
        while mass.time_s < 0.6e-3 {
            let before = mass.gap_m();
            mass.advance(1.037e-6, &small);
            steps += 1;
            ends += u32::from(before > 0.0 && mass.gap_m() < 0.0);
        }
        (mass, steps, ends)
    };
    let (mut speed_error, mut early, mut more) = (0.0_f64, 0, 0.0_f64);
    for excess in [1e-9, 1e-6, 1e-3] {
        let (above, steps, _) = throw(excess);
        let (below, plain, _) = throw(-excess);
        early += below.impulses.len();
        let peak = gap * (1.0 + excess);
        let exact = omega * ((peak - gap) * (peak + gap)).sqrt();
        let found = above.impulses.first().map_or(f64::NAN, |i| i.3);
        speed_error = speed_error.max((found / exact - 1.0).abs());
        more = more.max(f64::from(steps) / f64::from(plain));
    }
    // The dip of 1e-9 lasts 28 ns: between two ends of a step of 1 us nothing is seen of it.
    let dip_s = 2.0 * (2e-9_f64).sqrt() / omega;
    let mut workspace = Workspace::default();
    let drive = paper(0.5e-3, paper_arms());
    let model = drive.build();
    let onset = model.touch_amplitude_m_per_s2(true).unwrap_or(f64::NAN);
    let mut wrong = 0;
    for excess in [1e-9, 1e-6, 1e-3] {
        for (sign, touches) in [(-1.0, false), (1.0, true)] {
            let amplitude = onset * (1.0 + sign * excess);
            note(&drive, amplitude);
            let run = model.run(amplitude, false, &mut workspace);
            wrong += usize::from(run.map_or(true, |run| run.first_touch_s.is_some() != touches));
        }
    }
    vec![
        Check::new(
            "speed at contact against w sqrt(xp^2 - g^2)",
            speed_error,
            1e-6,
        )
        .against(
            "looked at ends of 1 us steps: share of contacts missed",
            1.0 - dip_s / 1.037e-6,
        ),
        Check::none("contacts below the threshold", early),
        Check::new("steps, of the run without contact", more, 2.0),
        Check::none(
            "wrong verdicts of the drive at onset x (1 +- 1e-9 to 1e-3)",
            wrong,
        ),
    ]
}

pub(super) fn b6() -> Vec<Check> {
    let (mut rest, mut impulse, mut impacts, mut sunk) = (0.0_f64, 0.0_f64, 0, 0.0_f64);
    let mut accumulated = 0.0_f64;
    for (e, zeno) in [(0.3, 0.838_543_9), (0.5, 1.354_570_9), (0.8, 4.063_712_8)] {
        let mut ball = Body::point(1.0, 0.0, -9.81, 1.0);
        let mut settled = 0.0_f64;
        while ball.time_s < 6.0 {
            ball.advance(1e-3, &law(e));
            if ball.time_s > zeno + 0.1 {
                settled = settled.max(-ball.gap_m());
            }
        }
        sunk = sunk.max(settled);
        let bounces = ball.impulses.iter().filter(|i| i.2 == ImpulseKind::Impact);
        let last = bounces.map(|i| i.0).fold(0.0, f64::max);
        accumulated = accumulated.max((last - zeno).abs());
        rest = rest.max(ball.gap_m().abs());
        let total: f64 = ball.impulses.iter().map(|i| i.1).sum();
        impulse = impulse.max((total / (9.81 * ball.time_s) - 1.0).abs());
        impacts = impacts.max(
            ball.impulses
                .iter()
                .filter(|i| i.2 == ImpulseKind::Impact)
                .count(),
        );
    }
    vec![
        Check::new("height 6 s after the drop, m", rest, 0.5 * 9.81 * 1e-6).against(
            "time not reached by 10000 exact bounces, s",
            6.0 - naive::contact::event_driven_time(0.5, 10_000),
        ),
        Check::new("impulse against weight x time", impulse, 2e-3),
        Check::new("impacts", impacts as f64, 200.0),
        Check::new(
            "last bounce against the time of accumulation, s",
            accumulated,
            2e-2,
        ),
        Check::new(
            "depth at rest beyond the fall of a step, m",
            sunk - 0.5 * 9.81e-6,
            1e-9,
        )
        .against(
            "bounced at every node with e = 0.3, 5000 steps",
            naive::contact::bounced_at_nodes(9.81, 0.3, 1e-3, 5000),
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
    // After the first blow has rung down: the disk leans, the force follows the pulse.
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
                let told = plus.warnings.contains(&StructureWarning::BothArmsOnePoint);
                silent += usize::from(clearance == 0.0 && !told);
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
        Check::none("rank deficiency not told", silent),
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

pub(super) fn b10() -> Vec<Check> {
    let (disk, arm) = (1.0_f64, 0.25_f64);
    let mut pair = Body::new(
        vec![Oscillator::default(), Oscillator::default()],
        vec![-1.0 / disk.sqrt(), 1.0 / arm.sqrt()],
        vec![0.0, 0.0],
        0.1,
    );
    pair.v[0] = disk.sqrt();
    let start = pair.energy_j();
    while pair.time_s < 0.3 {
        pair.advance(1e-2, &law(0.0));
    }
    let total: f64 = pair.impulses.iter().map(|i| i.1).sum();
    let speeds = [pair.v[0] / disk.sqrt(), pair.v[1] / arm.sqrt()];
    vec![
        Check::new("impulse against 0.2 v", (total - 0.2).abs(), 1e-12)
            .against("ramp taken as fixed: the disk stops dead", 1.0 - 0.2),
        Check::new(
            "speeds against 0.8 v",
            largest(speeds.map(|v| (v - 0.8).abs())),
            1e-12,
        ),
        Check::new(
            "kinetic energy against 0.8",
            (pair.energy_j() / start - 0.8).abs(),
            1e-12,
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
        Check::new("energy book, 1e-9 to 1e+9", closure, 1e-9),
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

pub(super) fn b13() -> Vec<Check> {
    let mut ball = Body::point(1.0, 0.0, -9.81, 1.0);
    let start = ball.energy_j();
    let report = ball.advance(1.2, &law(0.5));
    vec![
        Check::new(
            "impacts found in one step, short of 3",
            3.0 - f64::from(report.impacts),
            0.0,
        ),
        Check::new("energy gained", (ball.energy_j() - start) / 9.81, 0.0),
        Check::new("penetration, m", -ball.gap_m(), 1e-9).against(
            "looked at the end of the step",
            0.5 * 9.81 * 1.2_f64.powi(2) - 1.0,
        ),
    ]
}

pub(super) fn b14() -> Vec<Check> {
    // Spells open and close between nodes, so the order shows in the mean of the cases.
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

pub(super) fn b15() -> Vec<Check> {
    let mut mass = Body::new(
        vec![Oscillator::default(), Oscillator::fixed(3000.0, 0.01)],
        vec![1.0, 0.5],
        vec![-9.81, -2.0],
        0.0,
    );
    mass.v[0] = -1e-3;
    let step = 1e-5;
    let mut halves = [0.0_f64; 2];
    for k in 0..100_000 {
        mass.advance(step, &law(0.0));
        let half = &mut halves[k / 50_000];
        *half = half.max(-mass.gap_m());
    }
    vec![
        Check::new(
            "depth in 100000 steps, m",
            halves[0].max(halves[1]),
            1e-3 * step + 1e-8,
        )
        .against(
            "velocity set to zero at every node",
            naive::contact::stopped_at_nodes(9.81, step, 100_000),
        ),
        Check::new("deeper in the second half, m", halves[1] - halves[0], 1e-9),
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
        Check::new("energy book of arms let go while bent", closure, 1e-9)
            .against("book without what contact takes: least of three", dropped),
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
