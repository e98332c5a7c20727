//! Flow, loss and forced response against direct integration and the single oscillator.

use super::*;
use crate::linalg::SquareMatrix;
use crate::modal::{FirstOrderResponse, ForcedResponse, Oscillator, Phase};
use nalgebra::Complex;

fn matrix(rows: &[&[f64]]) -> SquareMatrix {
    let mut a = SquareMatrix::zeros(rows.len());
    for (i, row) in rows.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            a.add(i, j, *value);
        }
    }
    a
}

/// Two coordinates with everything: mass coupling, damping of one, gyroscopic and cross terms.
fn whirling() -> CoupledSystem {
    CoupledSystem {
        mass: matrix(&[&[2.0, 0.4], &[0.4, 1.0]]),
        damping: matrix(&[&[0.3, 0.0], &[0.0, 0.05]]),
        gyroscopic: matrix(&[&[0.9, 0.2], &[0.2, 0.5]]),
        stiffness: matrix(&[&[5.0, 0.0], &[0.0, 30.0]]),
        cross_stiffness: matrix(&[&[0.2, 0.0], &[0.0, 0.1]]),
        scale: vec![5.0, 31.0],
        elements: Vec::new(),
    }
}

fn real() -> CoupledSystem {
    let mut system = whirling();
    system.gyroscopic = SquareMatrix::zeros(2);
    system.cross_stiffness = SquareMatrix::zeros(2);
    system
}

/// q, q̇ and the energy lost by the classical Runge-Kutta rule in small steps.
fn integrate(system: &CoupledSystem, start: &Coordinates, h_s: f64) -> (Coordinates, f64) {
    let i = Complex::new(0.0, 1.0);
    let m = &system.mass;
    let det = m.get(0, 0) * m.get(1, 1) - m.get(0, 1) * m.get(1, 0);
    let rate = |at: &Coordinates| {
        let pulled = |a: usize| -> Complex<f64> {
            let pairs = system.elements.iter().zip(&at.y);
            let own = pairs.filter(|(e, _)| e.coordinate == a);
            own.map(|(e, y)| y * e.stiffness).sum()
        };
        let force: Vec<Complex<f64>> = (0..2)
            .map(|a| {
                (0..2)
                    .map(|b| {
                        let d = i * system.gyroscopic.get(a, b) + system.damping.get(a, b);
                        let k = i * system.cross_stiffness.get(a, b) + system.stiffness.get(a, b);
                        -(d * at.v[b]) - k * at.q[b]
                    })
                    .sum::<Complex<f64>>()
                    - pulled(a)
            })
            .collect();
        Coordinates {
            y: (system.elements.iter().zip(&at.y))
                .map(|(e, y)| at.v[e.coordinate] - y / e.time_s)
                .collect(),
            q: at.v.clone(),
            v: vec![
                (force[0] * m.get(1, 1) - force[1] * m.get(0, 1)) / det,
                (force[1] * m.get(0, 0) - force[0] * m.get(1, 0)) / det,
            ],
        }
    };
    let step = |at: &Coordinates, by: &Coordinates, f: f64| Coordinates {
        q: (0..2).map(|j| at.q[j] + by.q[j] * f).collect(),
        v: (0..2).map(|j| at.v[j] + by.v[j] * f).collect(),
        y: at.y.iter().zip(&by.y).map(|(y, by)| y + by * f).collect(),
    };
    let n = 20_000;
    let dt = h_s / f64::from(n);
    let (mut at, mut lost) = (start.clone(), 0.0);
    for _ in 0..n {
        let k1 = rate(&at);
        let mid = step(&at, &k1, dt / 2.0);
        let k2 = rate(&mid);
        let mid2 = step(&at, &k2, dt / 2.0);
        let k3 = rate(&mid2);
        let end = step(&at, &k3, dt);
        let k4 = rate(&end);
        let l = [&at, &mid, &mid2, &end].map(|x| system.loss_rate(x));
        lost += dt / 6.0 * (l[0] + 2.0 * l[1] + 2.0 * l[2] + l[3]);
        for (k, w) in [(&k1, 1.0), (&k2, 2.0), (&k3, 2.0), (&k4, 1.0)] {
            at = step(&at, k, dt * w / 6.0);
        }
    }
    (at, lost)
}

#[test]
fn flow_and_loss_of_damped_whirling_modes_agree_with_direct_integration() {
    for system in [whirling(), real()] {
        let modes = CoupledModes::new(system.clone()).unwrap();
        let b = [Complex::new(0.7, 0.0), Complex::new(-0.3, 0.0)];
        let mut state = modes.at_rest();
        state.add(&modes.entrance(&b), 1.0);
        let mut start = modes.coordinates();
        modes.read(&state, &mut start);
        // An impulse sets velocities M⁻¹ b and moves nothing.
        assert!(start.q.iter().all(|q| q.norm() < 1e-14));
        let mv = system.mass.get(0, 0) * start.v[0] + system.mass.get(0, 1) * start.v[1];
        assert!((mv - 0.7).norm() < 1e-14);
        for h_s in [1e-3, 0.3, 2.5] {
            let (wanted, lost) = integrate(&system, &start, h_s);
            let mut flow = CoupledFlow::default();
            modes.set_flow(h_s, &mut flow);
            let (mut after, mut at) = (modes.at_rest(), modes.coordinates());
            flow.apply(&state, &mut after);
            modes.read(&after, &mut at);
            for j in 0..2 {
                assert!((at.q[j] - wanted.q[j]).norm() < 1e-12, "{h_s}");
                assert!((at.v[j] - wanted.v[j]).norm() < 1e-12, "{h_s}");
            }
            for (y, wanted) in at.y.iter().zip(&wanted.y) {
                assert!((y - wanted).norm() < 1e-12, "{h_s}");
            }
            let balanced = state.form(&modes.loss_form(h_s));
            assert!((balanced - lost).abs() < 1e-12, "{h_s}: {balanced} {lost}");
            let h = |x: &Coordinates| {
                let (kinetic, elastic) = system.energies(x);
                kinetic + elastic
            };
            assert!((h(&start) - h(&at) - balanced).abs() < 1e-12);
        }
    }
}

#[test]
fn one_oscillator_moves_as_the_oscillator_does_under_every_part_of_a_pulse() {
    let sigma = Complex::new(-0.3, 2.0);
    let phase = Phase {
        constant: 0.4,
        slope_per_s: -0.7,
        wave: Complex::new(0.2, -1.1),
    };
    for (omega, ratio) in [(3.0, 0.02), (40.0, 0.01), (3.0, 4.0)] {
        let mut system = CoupledSystem::zeros(vec![omega * omega]);
        system.mass.add(0, 0, 1.0);
        system.stiffness.add(0, 0, omega * omega);
        system.damping.add(0, 0, 2.0 * ratio * omega);
        let modes = CoupledModes::new(system).unwrap();
        let point = modes.readout(&[Complex::from(1.0)]);
        let w = modes.entrance(&[Complex::from(1.0)]);
        for h_s in [1e-6, 0.01, 1.0, 3.0] {
            let mut state = modes.at_rest();
            for (k, s) in modes.rates_per_s().iter().enumerate() {
                let response = FirstOrderResponse::new(*s, sigma, h_s).increment(&phase);
                let z = Complex::new(w.re[k], w.im[k]) * response;
                (state.re[k], state.im[k]) = (z.re, z.im);
            }
            let (x, v) = point.read(&state);
            let oscillator = Oscillator::fixed(omega, ratio);
            let (wanted_x, wanted_v) =
                ForcedResponse::new(&oscillator, sigma, h_s).increments(&phase);
            assert!((x - wanted_x).abs() < 1e-12 * h_s, "{omega} {ratio} {h_s}");
            assert!((v - wanted_v).abs() < 1e-12, "{omega} {ratio} {h_s}");
        }
    }
}
