//! The production contact scheme on bodies with exact solutions.

use opshock_solver::complementarity::{ImpactLaw, ImpulseKind, UnilateralSystem};
use opshock_solver::linalg::{SquareMatrix, dense};
use opshock_solver::modal::Oscillator;
use opshock_tests::bodies::Body;
use opshock_tests::{number, reference};
use std::f64::consts::PI;

fn law(restitution: f64) -> ImpactLaw {
    ImpactLaw {
        restitution,
        gap_tolerance_m: 1e-12,
        max_impacts_per_step: 8,
    }
}

/// Free bar of linear elements with consistent mass, as modes; contact at its lower end.
fn bar(n_elements: usize, clearance: f64, gravity: f64) -> Body {
    let (modulus, density, length) = (900.0, 1.0, 10.0);
    let l = length / n_elements as f64;
    let n = n_elements + 1;
    let (mut k, mut m) = (SquareMatrix::zeros(n), SquareMatrix::zeros(n));
    for e in 0..n_elements {
        for (a, b, stiff, mass) in [
            (0, 0, 1.0, 2.0),
            (0, 1, -1.0, 1.0),
            (1, 0, -1.0, 1.0),
            (1, 1, 1.0, 2.0),
        ] {
            k.add(e + a, e + b, stiff * modulus / l);
            m.add(e + a, e + b, mass * density * l / 6.0);
        }
    }
    let pairs = dense::modes_of_free_body(&k, &m).unwrap();
    let largest = pairs.values[n - 1];
    let oscillators = pairs
        .values
        .iter()
        .map(|&v| Oscillator::fixed(if v < 1e-9 * largest { 0.0 } else { v.sqrt() }, 0.0))
        .collect();
    let ones = vec![1.0; n];
    let uniform: Vec<f64> = pairs.vectors.iter().map(|x| m.form(x, &ones)).collect();
    let shape = pairs.vectors.iter().map(|x| x[0]).collect();
    let force = uniform.iter().map(|u| -gravity * u).collect();
    let mut body = Body::new(oscillators, shape, force, clearance);
    body.x.fill(0.0);
    body
}

fn throw(body: &mut Body, speed: f64) {
    // Uniform velocity: the rigid-body mode alone carries it.
    let mass = 10.0_f64;
    for (v, o) in body.v.iter_mut().zip(&body.oscillators) {
        if o.omega_rad_per_s == 0.0 {
            *v = speed * mass.sqrt();
        }
    }
    let sign = body.shape[body
        .oscillators
        .iter()
        .position(|o| o.omega_rad_per_s == 0.0)
        .unwrap()]
    .signum();
    body.v.iter_mut().for_each(|v| *v *= sign);
}

/// Hard case B4: bar thrown at a wall, steps of half, one and two element transit times.
#[test]
fn hard_b4_elastic_bar_at_a_wall() {
    let exact = &reference("elastic_bar.json")["no_gravity"];
    let (on, off) = (number(&exact["contact"][0]), number(&exact["contact"][1]));
    let transit = 0.1 / 30.0;
    for ratio in [0.5, 1.0, 2.0] {
        let step = ratio * transit;
        let mut body = bar(100, number(&exact["gap"]), 0.0);
        throw(&mut body, number(&exact["v0"]));
        let start = body.energy_j();
        let mut peak = start;
        while body.time_s < 2.0 {
            body.advance(step, &law(0.0));
            peak = peak.max(body.energy_j());
        }
        assert!(
            peak <= start * (1.0 + 1e-12),
            "ratio {ratio}: {}",
            peak / start
        );
        assert!(
            body.energy_j() > 0.985 * start,
            "ratio {ratio}: {}",
            body.energy_j() / start
        );
        let strong: Vec<_> = body.impulses.iter().filter(|i| i.1 > 1e-3).collect();
        let (first, last) = (strong[0].0, strong[strong.len() - 1].0);
        assert!((first - on).abs() < 1e-9, "{first}");
        assert!(
            (last - off).abs() < 3.0 * step.max(transit),
            "ratio {ratio}: {last}"
        );
        let total: f64 = body.impulses.iter().map(|i| i.1).sum();
        assert!(
            (total / number(&exact["impulse"]) - 1.0).abs() < 0.015,
            "ratio {ratio}: {total}"
        );
        // Plateau: means over 8 element transits, away from the smeared front at both ends.
        let window = 8.0 * transit;
        let mut squares = Vec::new();
        let mut t = on + window;
        while t + 3.0 * window < off {
            let inside = body
                .impulses
                .iter()
                .filter(|i| i.0 >= t - 1e-9 && i.0 < t + window - 1e-9);
            let force = inside.map(|i| i.1).sum::<f64>() / window;
            squares.push((force / 300.0 - 1.0).powi(2));
            t += window;
        }
        let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        assert!(rms < 0.01, "ratio {ratio}: {rms}");
        let held = strong
            .iter()
            .filter(|i| i.0 > on + window && i.0 < off - window);
        let (sum, span) = (held.map(|i| i.1).sum::<f64>(), off - on - 2.0 * window);
        assert!(
            (sum / span / 300.0 - 1.0).abs() < 0.01,
            "ratio {ratio}: {}",
            sum / span
        );
    }
}

/// The same bar bouncing under gravity: two contacts, equal impulses, periodic motion.
#[test]
fn elastic_bar_under_gravity() {
    let data = reference("elastic_bar.json");
    let parameters = &data["parameters"];
    let mut body = bar(100, number(&parameters["h0"]), number(&parameters["g"]));
    let step = 0.5 * 0.1 / 30.0;
    let start = body.energy_j();
    let samples = data["gravity"]["samples_t_ubottom_pressureMid"]
        .as_array()
        .unwrap();
    let mut largest = 0.0_f64;
    for sample in samples {
        let t = number(&sample[0]);
        while body.time_s < t - 0.5 * step {
            body.advance(step, &law(0.0));
            assert!(body.energy_j() <= start + 1e-9 * start.abs() + 1e-9);
        }
        if t < 3.0 {
            largest = largest.max((body.gap_m() - number(&sample[1])).abs());
        }
    }
    // 100 elements smear the front by some lengths: the rebound is late by that much.
    assert!(largest < 0.03 * 5.0, "{largest}");
    let impulse_until =
        |t: f64| -> f64 { body.impulses.iter().filter(|i| i.0 < t).map(|i| i.1).sum() };
    let each = number(&data["gravity"]["impulse_each"]);
    assert!((impulse_until(2.5) / each - 1.0).abs() < 0.01);
    assert!((impulse_until(5.0) / (2.0 * each) - 1.0).abs() < 0.01);
}

/// Hard case B6: bounces accumulate; impact times and impulses of the exact ball, then rest.
#[test]
fn hard_b6_zeno_ball() {
    let data = &reference("ball_and_grazing.json")["zeno_ball"];
    let (g, m, e) = (number(&data["g"]), number(&data["m"]), number(&data["e"]));
    let mut ball = Body::point(m, 0.0, -m * g, number(&data["h"]));
    let step = 1e-3;
    for _ in 0..1000 {
        ball.advance(step, &law(e));
    }
    let impacts: Vec<_> = ball
        .impulses
        .iter()
        .filter(|i| i.2 == ImpulseKind::Impact)
        .collect();
    let times = data["impact_times"].as_array().unwrap();
    let impulses = data["impulses"].as_array().unwrap();
    for (found, (time, impulse)) in impacts.iter().zip(times.iter().zip(impulses)) {
        assert!((found.0 - number(time)).abs() < 1e-9, "{} {time}", found.0);
        assert!(
            (found.1 - number(impulse)).abs() < 1e-9 * 0.02,
            "{} {impulse}",
            found.1
        );
    }
    assert!(
        impacts.len() >= times.len() && impacts.len() < 60,
        "{}",
        impacts.len()
    );
    // After the accumulation: at rest, held against its weight.
    assert!(ball.gap_m().abs() <= 0.5 * g * step * step);
    let zeno = number(&data["zeno_time"]);
    let held: f64 = ball
        .impulses
        .iter()
        .filter(|i| i.0 > zeno + step && i.0 <= 0.95)
        .map(|i| i.1)
        .sum();
    let expected = m * g * (0.95 - zeno - step);
    assert!((held / expected - 1.0).abs() < 0.01, "{held} {expected}");
    for e in [0.5, 0.8] {
        let mut ball = Body::point(1.0, 0.0, -9.81, 1.0);
        while ball.time_s < 5.0 {
            ball.advance(2e-3, &law(e));
        }
        assert!(ball.gap_m().abs() < 1e-4 && ball.v[0].abs() < 0.05, "e {e}");
    }
}

/// Hard case B2: an oscillator on a stop at its rest position, exact half periods.
#[test]
fn hard_b2_bouncing_oscillator_hundred_impacts() {
    let omega = 2.0 * PI;
    for e in [1.0, 0.8] {
        let mut mass = Body::point(1.0, omega, 0.0, 0.0);
        mass.v[0] = 1.0;
        while mass.time_s < 50.3 {
            mass.advance(0.01, &law(e));
        }
        let impacts: Vec<_> = mass.impulses.iter().filter(|i| i.1 > 0.0).collect();
        assert_eq!(impacts.len(), 100);
        for (k, impact) in impacts.iter().enumerate() {
            let count = k as i32 + 1;
            assert!(
                (impact.0 - f64::from(count) * PI / omega).abs() < 1e-9,
                "{k}: {}",
                impact.0
            );
            let speed = e.powi(count - 1);
            assert!((impact.3 - speed).abs() < 1e-9, "{k}: {} {speed}", impact.3);
        }
    }
}

/// Grazing oscillator: touch time, closing speed and loss near the touch threshold.
#[test]
fn grazing_oscillator_is_exact_above_the_threshold() {
    let data = &reference("ball_and_grazing.json")["grazing"];
    let (omega, gap) = (number(&data["omega"]), number(&data["gap"]));
    for row in data["rows"].as_array().unwrap() {
        let excess = number(&row["eps"]);
        if excess == 0.0 {
            continue; // a matter of rounding by the reference's own remark
        }
        // g = gap - x: shape -1.
        let mut mass = Body::new(
            vec![Oscillator::fixed(omega, 0.0)],
            vec![-1.0],
            vec![0.0],
            gap,
        );
        mass.v[0] = number(&row["v0"]);
        let start = mass.energy_j();
        let small = ImpactLaw {
            gap_tolerance_m: 1e-15,
            ..law(0.0)
        };
        while mass.time_s < 0.6e-3 {
            mass.advance(1e-6, &small);
        }
        if row["contact"].as_bool().unwrap() {
            let (time, _, _, speed) = mass.impulses[0];
            assert!(
                (speed - number(&row["v_contact"])).abs() < 1e-6 * speed,
                "{excess}: {speed}"
            );
            assert!(
                (time - number(&row["t_contact"])).abs() < 1e-12,
                "{excess}: {time}"
            );
            let lost = start - mass.energy_j();
            let expected = number(&row["energy_lost_per_mass_e0"]);
            assert!(
                (lost / expected - 1.0).abs() < 1e-6,
                "{excess}: {lost:e} {expected:e}"
            );
        } else {
            assert!(mass.impulses.is_empty());
        }
    }
}

/// Hard case B15: a hundred thousand steps of resting contact, with no trend.
#[test]
fn hard_b15_resting_contact_does_not_sink() {
    let mut mass = Body::point(1.0, 0.0, -9.81, 0.0);
    mass.oscillators.push(Oscillator::fixed(3000.0, 0.01));
    mass.shape.push(0.5);
    mass.force.push(-2.0);
    for part in [&mut mass.x, &mut mass.v] {
        part.push(0.0);
    }
    let mut mass = {
        let mut fresh = Body::new(mass.oscillators, mass.shape, mass.force, 0.0);
        fresh.v[0] = -1e-3;
        fresh
    };
    let step = 1e-5;
    let mut halves = [0.0_f64; 2];
    for k in 0..100_000 {
        mass.advance(step, &law(0.0));
        let half = &mut halves[usize::from(k >= 50_000)];
        *half = half.max(-mass.gap_m());
    }
    assert!(halves[0] < 1e-3 * step + 1e-8, "{halves:?}");
    assert!(halves[1] <= halves[0] + 1e-9, "sinks: {halves:?}");
}

/// Hard case B10 in one body: a plastic hit on a free mass behind a spring of no stiffness.
#[test]
fn hard_b10_plastic_hit_shares_momentum() {
    // Disk mass 1 with velocity 1 (g falls), ramp mass 0.25 at rest; g = d + ramp - disk.
    let (disk, ramp) = (1.0_f64, 0.25_f64);
    let mut pair = Body::new(
        vec![Oscillator::default(), Oscillator::default()],
        vec![-1.0 / disk.sqrt(), 1.0 / ramp.sqrt()],
        vec![0.0, 0.0],
        0.1,
    );
    pair.v[0] = disk.sqrt();
    let start = pair.energy_j();
    while pair.time_s < 0.3 {
        pair.advance(1e-2, &law(0.0));
    }
    let total: f64 = pair.impulses.iter().map(|i| i.1).sum();
    assert!((total - 0.2).abs() < 1e-12, "{total}");
    assert!((pair.energy_j() / start - 0.8).abs() < 1e-12);
    assert!(
        (pair.v[0] / disk.sqrt() - 0.8).abs() < 1e-12
            && (pair.v[1] / ramp.sqrt() - 0.8).abs() < 1e-12
    );
}

/// Hard case B13: several impacts inside one long step are found, energy never rises.
#[test]
fn hard_b13_several_impacts_in_one_step() {
    let mut ball = Body::point(1.0, 0.0, -9.81, 1.0);
    let start = ball.energy_j();
    let report = ball.advance(1.2, &law(0.5));
    assert!(report.impacts >= 3, "{report:?}");
    assert!(ball.energy_j() < start && ball.gap_m() > -1e-9);
    let (now, _) = (ball.gaps()[0], ());
    assert!(now.rate_m_per_s.is_finite());
}
