//! Base, disk and arms before contact against one chain of oscillators integrated directly.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use opshock_solver::disk::{DiskBasis, DiskMotion, Harmonics};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;

use opshock_solver::shock::{BaseMode, Pulse};
use opshock_tests::runge_kutta;
use opshock_tests::structures::Structure;

use super::base::{BASE, arms, on};
use super::hub::{distance, largest, run};

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
