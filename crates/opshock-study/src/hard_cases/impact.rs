//! Hard cases B of one body against a stop or another: impacts whose times, speeds and impulses are known.

use super::check::{Check, largest};
use super::naive;
use super::scenes::bodies::Body;
use super::scenes::noted::note;
use super::scenes::structures::{paper, paper_arms};
use opshock_solver::complementarity::{ImpactLaw, ImpulseKind};
use opshock_solver::linalg::{SquareMatrix, dense};
use opshock_solver::modal::Oscillator;
use opshock_solver::structure::Workspace;
use std::f64::consts::PI;

fn law(restitution: f64) -> ImpactLaw {
    ImpactLaw {
        restitution,
        gap_tolerance_m: 1e-12,
        max_impacts_per_step: 8,
    }
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
            // Elements resolve times no better than their transit time, steps no better than their length.
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
    // g = gap - x, released so that x peaks at gap (1 + excess).
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
    // The dip of 1e-9 lasts 28 ns: at the two ends of a step of 1 us it is not seen.
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
