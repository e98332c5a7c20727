//! Momentum of the hub, or of the base with all that stands on it, compared with the impulses on it.

use crate::modal::oscillator::phi1;
use crate::modal::{CoupledModes, PointReadout, Readout};
use nalgebra::Complex;

/// A body along one axis: a weighted sum of coordinates.
pub(in crate::structure) struct Body {
    /// Momentum along the axis: reads the velocity.
    pub momentum: PointReadout,
    /// Force of its supports, springs and dampers.
    pub support: Readout,
    /// Impulse of the supports over a whole step of free motion.
    pub support_step: Readout,
    /// Inertia load per unit a(t), kg.
    pub load_kg: f64,
    /// Impulse per impulse of the ramp on the disk; the ramp's mount takes the opposite.
    pub contact_share: f64,
}

impl Body {
    pub fn new(
        modes: &CoupledModes,
        axis: &[(usize, f64)],
        load_kg: f64,
        contact_share: f64,
        step_s: f64,
    ) -> Self {
        let system = modes.system();
        let rows = |a: &crate::linalg::SquareMatrix, sign: f64| -> Vec<Complex<f64>> {
            let mut sum = vec![Complex::from(0.0); system.scale.len()];
            for (at, weight) in axis {
                for (sum, entry) in sum.iter_mut().zip(a.row(*at)) {
                    *sum += sign * weight * entry;
                }
            }
            sum
        };
        let spring = modes.readout(&rows(&system.stiffness, -1.0)).position;
        let damper = modes.readout(&rows(&system.damping, -1.0)).velocity;
        let add = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect();
        let support = Readout {
            re: add(&spring.re, &damper.re),
            im: add(&spring.im, &damper.im),
        };
        Self {
            momentum: modes.readout(&rows(&system.mass, 1.0)),
            support_step: over_step(&support, modes.rates_per_s(), step_s),
            support,
            load_kg,
            contact_share,
        }
    }
}

/// Row that reads the integral over a step of free motion of what `row` reads.
fn over_step(row: &Readout, rates_per_s: &[Complex<f64>], step_s: f64) -> Readout {
    let mut integral = row.clone();
    for (k, s) in rates_per_s.iter().enumerate() {
        // Re((re − i im) ∫ η dt) with ∫ η dt = η h φ₁(sh).
        let weight = Complex::new(row.re[k], -row.im[k]) * phi1(s * step_s) * step_s;
        (integral.re[k], integral.im[k]) = (weight.re, -weight.im);
    }
    integral
}
