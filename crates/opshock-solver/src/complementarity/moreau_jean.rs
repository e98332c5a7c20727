//! Reference method for unilateral contact: Moreau-Jean time stepping with θ = ½ on linear modes.
//!
//! It shares neither the flow nor the impulses of the production scheme, and both tend to the same motion as the step
//! goes to 0.
//!
//! ```text
//! q₁ = q₀ + Δt (r₀ + r₁)/2
//! r₁ = r₀ − Δt [k (q₀ + q₁)/2 + d (r₀ + r₁)/2 − f] + B P
//! g₀ + ½ Δt v₀ ≤ 0   ⇒   0 ≤ v₁ + e v₀ ⟂ P ≥ 0,    else P = 0
//! ```
//!
//! f is the force at the middle of the step. The constraint is on velocity level, so gaps drift
//! by O(Δt); energy never rises. Source: Jean, The non-smooth contact dynamics method, Comput.
//! Methods Appl. Mech. Engrg. 177 (1999); Acary and Brogliato (2008), ch. 10.

use super::lcp;
use crate::modal::{CoupledState, PointReadout};
use nalgebra::Complex;

/// q̈ + d q̇ + k q = f of one mode of unit mass, complex in a rotating frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearMode {
    /// k, 1/s².
    pub stiffness_per_s2: Complex<f64>,
    /// d, 1/s.
    pub damping_per_s: Complex<f64>,
}

/// Modes of first order, η̇ = s η + w f, of coupled oscillators. The implicit midpoint rule is the same for them, since
/// it does not depend on the coordinates.
#[derive(Clone, Debug)]
pub struct FirstOrderModes {
    /// s, 1/s.
    pub rates_per_s: Vec<Complex<f64>>,
    /// Row that reads each contact's gap.
    pub gaps: [PointReadout; 2],
    /// w of an impulse that opens each contact.
    pub entrances: [CoupledState; 2],
    /// w of the driving force, if it drives these modes.
    pub drive: Option<CoupledState>,
    /// η.
    pub state: CoupledState,
}

/// A linear system with up to two contacts under Moreau-Jean steps.
#[derive(Clone, Debug)]
pub struct MoreauJean {
    modes: Vec<LinearMode>,
    /// Gap per amplitude of each mode (real part), one column per contact.
    shapes: Vec<Vec<f64>>,
    clearance_m: Vec<f64>,
    restitution: f64,
    step_s: f64,
    /// Amplitudes q.
    pub amplitude: Vec<Complex<f64>>,
    /// Velocities r.
    pub velocity: Vec<Complex<f64>>,
    /// Velocities of the step without contact.
    free: Vec<Complex<f64>>,
    /// Coupled oscillators beside the modes.
    pub coupled: Vec<FirstOrderModes>,
}

impl MoreauJean {
    /// A system at rest; `shapes` holds one column over the modes per contact (at most 2).
    ///
    /// # Panics
    /// When columns differ in length.
    pub fn new(
        modes: Vec<LinearMode>,
        shapes: Vec<Vec<f64>>,
        clearance_m: Vec<f64>,
        restitution: f64,
        step_s: f64,
    ) -> Self {
        assert!(shapes.len() <= 2 && shapes.len() == clearance_m.len());
        assert!(shapes.iter().all(|s| s.len() == modes.len()));
        let zero = vec![Complex::from(0.0); modes.len()];
        Self {
            modes,
            shapes,
            clearance_m,
            restitution,
            step_s,
            amplitude: zero.clone(),
            free: zero.clone(),
            velocity: zero,
            coupled: Vec::new(),
        }
    }

    /// Adds coupled oscillators at rest.
    pub fn add_coupled(&mut self, modes: FirstOrderModes) {
        self.coupled.push(modes);
    }

    /// Gap of contact `i`, m.
    pub fn gap_m(&self, i: usize) -> f64 {
        let coupled = self.coupled.iter().map(|c| c.gaps[i].read(&c.state).0);
        self.clearance_m[i] + read(&self.shapes[i], &self.amplitude) + coupled.sum::<f64>()
    }

    /// Advances by one step under the modal `force` at its middle, and `coupled_force` on the coupled oscillators that
    /// have a drive. Returns the impulses, N s.
    pub fn step(&mut self, force: &[f64], coupled_force: f64) -> [f64; 2] {
        let h = self.step_s;
        let n = self.shapes.len();
        let before: [f64; 2] = std::array::from_fn(|i| self.gap_rate(i, &self.velocity));
        let closed = std::array::from_fn(|i| i < n && self.gap_m(i) + 0.5 * h * before[i] <= 0.0);

        // Effective inertia 1 + Δt d/2 + Δt² k/4 of the implicit step.
        let inertia = |m: &LinearMode| {
            Complex::from(1.0) + m.damping_per_s * (0.5 * h) + m.stiffness_per_s2 * (0.25 * h * h)
        };
        for (j, (free, m)) in self.free.iter_mut().zip(&self.modes).enumerate() {
            let (q, r) = (self.amplitude[j], self.velocity[j]);
            let pull = m.stiffness_per_s2 * (q + r * (0.5 * h)) + m.damping_per_s * r - force[j];
            *free = r - pull * h / inertia(m);
        }

        for modes in &mut self.coupled {
            modes.step(h, coupled_force);
        }

        let mut p = [0.0; 2];
        if closed[0] || closed[1] {
            let mut w = [[0.0; 2]; 2];
            for (a, row) in w.iter_mut().enumerate().take(n) {
                for (b, entry) in row.iter_mut().enumerate().take(n) {
                    let pairs = self.shapes[a].iter().zip(&self.shapes[b]).zip(&self.modes);
                    *entry = pairs.map(|((x, y), m)| x * y * inertia(m).inv().re).sum();
                    let coupled = self.coupled.iter().map(|c| c.mobility(a, b, h));
                    *entry += coupled.sum::<f64>();
                }
            }
            let target = std::array::from_fn(|i| {
                self.gap_rate(i, &self.free) + self.restitution * before[i]
            });
            p = lcp::solve(w, target, closed).unwrap_or([0.0; 2]);
        }
        for modes in &mut self.coupled {
            modes.kick(p, h);
        }
        for (j, m) in self.modes.iter().enumerate() {
            let kick: f64 = (0..n).map(|i| self.shapes[i][j] * p[i]).sum();
            let after = self.free[j] + inertia(m).inv() * kick;
            self.amplitude[j] += (self.velocity[j] + after) * (0.5 * h);
            self.velocity[j] = after;
        }
        p
    }

    /// Rate of gap `i` for the present velocities of the modes and the coupled oscillators.
    fn gap_rate(&self, i: usize, velocity: &[Complex<f64>]) -> f64 {
        let Some(shape) = self.shapes.get(i) else {
            return 0.0;
        };
        let coupled = self.coupled.iter().map(|c| c.gaps[i].read(&c.state).1);
        read(shape, velocity) + coupled.sum::<f64>()
    }

    /// ½ Σ (|r|² + Re k |q|²), J.
    pub fn energy_j(&self) -> f64 {
        let states = self.amplitude.iter().zip(&self.velocity);
        self.modes
            .iter()
            .zip(states)
            .map(|(m, (q, r))| 0.5 * (r.norm_sqr() + m.stiffness_per_s2.re * q.norm_sqr()))
            .sum()
    }
}

impl FirstOrderModes {
    /// η₁ = ((1 + hs/2) η₀ + h w f) / (1 − hs/2).
    fn step(&mut self, h: f64, force: f64) {
        for (k, s) in self.rates_per_s.iter().enumerate() {
            let half = s * (0.5 * h);
            let mut eta = Complex::new(self.state.re[k], self.state.im[k]) * (half + 1.0);
            if let Some(w) = &self.drive {
                eta += Complex::new(w.re[k], w.im[k]) * (h * force);
            }
            eta /= -half + 1.0;
            (self.state.re[k], self.state.im[k]) = (eta.re, eta.im);
        }
    }

    /// Adds w P / (1 − hs/2).
    fn kick(&mut self, p: [f64; 2], h: f64) {
        for (w, p) in self.entrances.iter().zip(p) {
            for (k, s) in self.rates_per_s.iter().enumerate() {
                let eta = Complex::new(w.re[k], w.im[k]) * p / (-s * (0.5 * h) + 1.0);
                self.state.re[k] += eta.re;
                self.state.im[k] += eta.im;
            }
        }
    }

    /// Rate of gap `a` after the step per unit impulse on contact `b`.
    fn mobility(&self, a: usize, b: usize, h: f64) -> f64 {
        let (row, w) = (&self.gaps[a].velocity, &self.entrances[b]);
        let modes = self.rates_per_s.iter().enumerate();
        modes
            .map(|(k, s)| {
                let eta = Complex::new(w.re[k], w.im[k]) / (-s * (0.5 * h) + 1.0);
                row.re[k] * eta.re + row.im[k] * eta.im
            })
            .sum()
    }
}

fn read(shape: &[f64], z: &[Complex<f64>]) -> f64 {
    shape.iter().zip(z).map(|(b, z)| b * z.re).sum()
}
