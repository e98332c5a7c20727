//! Gives the response of an oscillator to elementary forcing over a time in closed form.
//!
//! Over a stretch in which the forcing per unit generalised force is
//!
//! ```text
//! s(τ) = c₀ + c₁ τ + Re(C e^{στ})
//! ```
//!
//! the increments of displacement and velocity of x'' + 2γ x' + ω² x = s from rest are
//! convolutions with the impulse response. With the root λ of the oscillator,
//! F(λ) = ∫ e^{λ(h−τ)} s(τ) dτ, they are the divided differences x = F[λ₁, λ₂] and
//! v = (λF)[λ₁, λ₂], where
//!
//! ```text
//! ∫ e^{λ(h−τ)} e^{στ} dτ = e^{λh} h φ₁((σ−λ)h),    φ₁(z) = (e^z − 1)/z
//! ∫ e^{λ(h−τ)} dτ = h φ₁(λh),   ∫ e^{λ(h−τ)} τ dτ = h² φ₂(λh)
//! ```
//!
//! φ₁ is entire: a forcing at resonance (a half-sine with f T = ½ on an undamped mode) is an
//! ordinary case. Over times short against all rates a Gauss rule is used instead, exact to
//! rounding and free of cancellation.

use super::oscillator::{GAUSS_8, Oscillator, phi1, phi2};
use nalgebra::Complex;

/// Forcing at the start of a stretch: s(τ) = c₀ + c₁ τ + Re(C e^{στ}).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Phase {
    /// c₀.
    pub constant: f64,
    /// c₁, 1/s.
    pub slope_per_s: f64,
    /// C.
    pub wave: Complex<f64>,
}

/// Response of one oscillator over one time to the four parts of a [`Phase`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForcedResponse {
    /// Of the displacement per c₀, c₁, Re C and Im C, s² (per c₁: s³).
    pub displacement: [f64; 4],
    /// Of the velocity, s (per c₁: s²).
    pub velocity: [f64; 4],
}

/// Response of one first-order mode over one time to the four parts of a [`Phase`].
#[derive(Clone, Copy, Debug, Default)]
pub struct FirstOrderResponse([Complex<f64>; 4]);

impl Phase {
    /// The phase `h_s` later, for a wave of rate `sigma_per_s`.
    pub fn later(&self, sigma_per_s: Complex<f64>, h_s: f64) -> Self {
        self.turned(h_s, (sigma_per_s * h_s).exp())
    }

    /// The phase `h_s` later, over which the wave is multiplied by `factor`.
    pub fn turned(&self, h_s: f64, factor: Complex<f64>) -> Self {
        Self {
            constant: self.constant + self.slope_per_s * h_s,
            slope_per_s: self.slope_per_s,
            wave: self.wave * factor,
        }
    }

    /// c₀, c₁, Re C and Im C, in the order of a [`ForcedResponse`].
    pub fn parts(&self) -> [f64; 4] {
        [self.constant, self.slope_per_s, self.wave.re, self.wave.im]
    }

    /// s at the start of the stretch.
    pub fn value(&self) -> f64 {
        self.constant + self.wave.re
    }
}

impl FirstOrderResponse {
    /// Response over `h_s` of a mode of rate `s_per_s` to a wave of rate `sigma_per_s`.
    pub fn new(s_per_s: Complex<f64>, sigma_per_s: Complex<f64>, h_s: f64) -> Self {
        let i = Complex::new(0.0, 1.0);
        let z = s_per_s * h_s;
        let grown = z.exp() * h_s;
        let along = grown * phi1((sigma_per_s - s_per_s) * h_s);
        let against = grown * phi1((sigma_per_s.conj() - s_per_s) * h_s);
        Self([
            phi1(z) * h_s,
            phi2(z) * (h_s * h_s),
            // Re(C e^{στ}) with C = 1 and C = i.
            (along + against) * 0.5,
            i * (along - against) * 0.5,
        ])
    }

    /// Increment of the mode for a forcing that starts at `phase`.
    pub fn increment(&self, phase: &Phase) -> Complex<f64> {
        let [constant, slope, re, im] = self.0;
        (constant * phase.constant + slope * phase.slope_per_s)
            + (re * phase.wave.re + im * phase.wave.im)
    }
}

impl ForcedResponse {
    /// Response of `oscillator` (fixed frame: no rotation, no damping fixed in space beside γ) over `h_s` to a wave of
    /// rate `sigma_per_s`.
    pub fn new(oscillator: &Oscillator, sigma_per_s: Complex<f64>, h_s: f64) -> Self {
        let [l1, l2] = oscillator.roots();
        let fastest = l1.norm().max(l2.norm()).max(sigma_per_s.norm());
        if fastest * h_s < 0.5 {
            return Self::by_quadrature(oscillator, sigma_per_s, h_s, 1);
        }
        let spread = l1 - l2;
        if spread.norm() * h_s < 1e-2 {
            let n_panels = (2.0 * fastest * h_s).ceil().min(1e4) as usize;
            return Self::by_quadrature(oscillator, sigma_per_s, h_s, n_panels);
        }
        let [f1, f2] = [l1, l2].map(|l| FirstOrderResponse::new(l, sigma_per_s, h_s).0);
        let mut response = Self::default();
        for k in 0..4 {
            response.displacement[k] = ((f1[k] - f2[k]) / spread).re;
            response.velocity[k] = ((l1 * f1[k] - l2 * f2[k]) / spread).re;
        }
        response
    }

    fn by_quadrature(o: &Oscillator, sigma: Complex<f64>, h_s: f64, n_panels: usize) -> Self {
        let mut response = Self::default();
        let panel = h_s / n_panels as f64;
        for k in 0..n_panels {
            for (x, weight) in GAUSS_8 {
                let tau = (k as f64 + x) * panel;
                let f = o.flow(h_s - tau);
                let wave = (sigma * tau).exp();
                let parts = [1.0, tau, wave.re, -wave.im];
                for (j, part) in parts.into_iter().enumerate() {
                    response.displacement[j] += weight * panel * f.qr.re * part;
                    response.velocity[j] += weight * panel * (1.0 + f.rr.re) * part;
                }
            }
        }
        response
    }

    /// Increments (displacement, velocity) for a forcing that starts at `phase`.
    pub fn increments(&self, phase: &Phase) -> (f64, f64) {
        let parts = phase.parts();
        let sum = |row: &[f64; 4]| {
            (row[0] * parts[0] + row[1] * parts[1]) + (row[2] * parts[2] + row[3] * parts[3])
        };
        (sum(&self.displacement), sum(&self.velocity))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Hard case A1: half-sine of width T on an undamped mode with f T = 1/2.
    #[test]
    fn hard_a1_resonant_half_sine_is_the_limit_form() {
        let width = 5e-4;
        for shift in [0.0, 1e-12, 1e-9, -1e-9, 1e-6] {
            let omega = PI / width * (1.0 + shift);
            let o = Oscillator::fixed(omega, 0.0);
            let r = ForcedResponse::new(&o, Complex::new(0.0, PI / width), width);
            let phase = Phase {
                wave: Complex::new(0.0, -1.0),
                ..Phase::default()
            };
            let (x, _) = r.increments(&phase);
            // x/x_st = (sin ωt − ωt cos ωt)/2 at ωt = π is π/2; it varies by O(shift) around it.
            let ratio = x * omega * omega;
            assert!(
                (ratio - PI / 2.0).abs() < 1e-10 + 3.0 * f64::abs(shift),
                "{shift}: {ratio}"
            );
        }
        let a = 200.0 * 9.80665;
        let omega = 2.0 * PI * 1000.0;
        let o = Oscillator::fixed(omega, 0.0);
        let r = ForcedResponse::new(&o, Complex::new(0.0, PI / width), width);
        let (x, _) = r.increments(&Phase {
            wave: Complex::new(0.0, -1.0),
            ..Phase::default()
        });
        assert!((a * x - 78.038_841_1e-6).abs() < 5e-14);
    }

    #[test]
    fn closed_form_and_quadrature_agree_for_every_part() {
        let sigma = Complex::new(-0.3, 2.0);
        for o in [
            Oscillator::fixed(3.0, 0.02),
            Oscillator::fixed(0.0, 0.0),
            Oscillator::fixed(3.0, 1.0),
            Oscillator::fixed(3.0, 4.0),
            Oscillator::fixed(40.0, 0.01),
        ] {
            for h in [1e-9, 0.01, 0.2, 1.0, 3.0] {
                let a = ForcedResponse::new(&o, sigma, h);
                let b = ForcedResponse::by_quadrature(&o, sigma, h, 200);
                for k in 0..4 {
                    let scale = h * h;
                    assert!(
                        (a.displacement[k] - b.displacement[k]).abs() < 1e-12 * scale,
                        "{o:?} {h} {k}"
                    );
                    assert!(
                        (a.velocity[k] - b.velocity[k]).abs() < 1e-12 * h,
                        "{o:?} {h} {k}"
                    );
                }
            }
        }
    }
}
