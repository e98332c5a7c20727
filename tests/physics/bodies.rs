//! The production contact scheme on bodies with exact solutions.

use opshock_solver::complementarity::{ImpactLaw, ImpulseKind};
use opshock_solver::linalg::{SquareMatrix, dense};
use opshock_solver::modal::Oscillator;
use opshock_tests::bodies::Body;
use opshock_tests::sheet::at_most;
use opshock_tests::{number, reference};

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
    at_most(
        "elastic-bar",
        "error of the lower end's position until the first rebound, of the height of fall",
        largest / 5.0,
        0.03,
    );
    let impulse_until =
        |t: f64| -> f64 { body.impulses.iter().filter(|i| i.0 < t).map(|i| i.1).sum() };
    let each = number(&data["gravity"]["impulse_each"]);
    at_most(
        "elastic-bar",
        "relative error of the first impulse",
        (impulse_until(2.5) / each - 1.0).abs(),
        0.01,
    );
    at_most(
        "elastic-bar",
        "relative error of both impulses",
        (impulse_until(5.0) / (2.0 * each) - 1.0).abs(),
        0.01,
    );
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
        at_most(
            "bouncing-ball",
            "error of the time of an impact (s)",
            (found.0 - number(time)).abs(),
            1e-9,
        );
        at_most(
            "bouncing-ball",
            "error of an impulse, of 0.02 N s",
            (found.1 - number(impulse)).abs() / 0.02,
            1e-9,
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
    at_most(
        "bouncing-ball",
        "relative error of the impulse that holds it at rest",
        (held / expected - 1.0).abs(),
        0.01,
    );
    for e in [0.5, 0.8] {
        let mut ball = Body::point(1.0, 0.0, -9.81, 1.0);
        while ball.time_s < 5.0 {
            ball.advance(2e-3, &law(e));
        }
        assert!(ball.gap_m().abs() < 1e-4 && ball.v[0].abs() < 0.05, "e {e}");
    }
}

/// Grazing oscillator: touch time, closing speed and loss near the touch threshold.
#[test]
fn hard_b5_grazing_oscillator_is_exact_above_the_threshold() {
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
            at_most(
                "grazing-oscillator",
                "relative error of the closing speed",
                (speed / number(&row["v_contact"]) - 1.0).abs(),
                1e-6,
            );
            at_most(
                "grazing-oscillator",
                "error of the time of touch (s)",
                (time - number(&row["t_contact"])).abs(),
                1e-12,
            );
            let lost = start - mass.energy_j();
            let expected = number(&row["energy_lost_per_mass_e0"]);
            at_most(
                "grazing-oscillator",
                "relative error of the energy lost",
                (lost / expected - 1.0).abs(),
                1e-6,
            );
        } else {
            assert!(mass.impulses.is_empty());
        }
    }
}
