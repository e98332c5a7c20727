//! Reference method: Moreau-Jean time stepping with θ = ½ on linear modes.
//!
//! The other method beside the production scheme: it shares neither its flow nor its impulses, and
//! both tend to the same motion as the step goes to 0.
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
use nalgebra::Complex;

/// q̈ + d q̇ + k q = f of one mode of unit mass, complex in a turning frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearMode {
    /// k, 1/s².
    pub stiffness_per_s2: Complex<f64>,
    /// d, 1/s.
    pub damping_per_s: Complex<f64>,
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
        }
    }

    /// Gap of contact `i`, m.
    pub fn gap_m(&self, i: usize) -> f64 {
        self.clearance_m[i] + read(&self.shapes[i], &self.amplitude)
    }

    /// Advances by one step under the modal `force` at its middle; impulses, N s.
    pub fn step(&mut self, force: &[f64]) -> [f64; 2] {
        let h = self.step_s;
        let n = self.shapes.len();
        let before: [f64; 2] =
            std::array::from_fn(|i| self.shapes.get(i).map_or(0.0, |s| read(s, &self.velocity)));
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

        let mut p = [0.0; 2];
        if closed[0] || closed[1] {
            let mut w = [[0.0; 2]; 2];
            for (a, row) in w.iter_mut().enumerate().take(n) {
                for (b, entry) in row.iter_mut().enumerate().take(n) {
                    let pairs = self.shapes[a].iter().zip(&self.shapes[b]).zip(&self.modes);
                    *entry = pairs.map(|((x, y), m)| x * y * inertia(m).inv().re).sum();
                }
            }
            let target = std::array::from_fn(|i| {
                let after = self.shapes.get(i).map_or(0.0, |s| read(s, &self.free));
                after + self.restitution * before[i]
            });
            p = lcp::solve(w, target, closed).unwrap_or([0.0; 2]);
        }
        for (j, m) in self.modes.iter().enumerate() {
            let kick: f64 = (0..n).map(|i| self.shapes[i][j] * p[i]).sum();
            let after = self.free[j] + inertia(m).inv() * kick;
            self.amplitude[j] += (self.velocity[j] + after) * (0.5 * h);
            self.velocity[j] = after;
        }
        p
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

fn read(shape: &[f64], z: &[Complex<f64>]) -> f64 {
    shape.iter().zip(z).map(|(b, z)| b * z.re).sum()
}
