//! Modes of base plate and housing under the shock, and the load that they transmit to the actuator's pivot.
//!
//! A base moves with disk, hub and arms as one system ([`crate::structure`]). Its motion under the unit pulse enters
//! the suspension as the load b(t) = a(t) − ü at its pivot. In the damped modes of that system, η̇ = λ η + w a and u =
//! Re Σ s η, with u measured from the rigidly moving base. In an interval with a = c₀ + c₁ τ + Re(C e^{στ})
//!
//! ```text
//! η = −w (c₀ + c₁ τ + c₁/λ)/λ + w/2 [C e^{στ}/(σ − λ) + C̄ e^{σ̄τ}/(σ̄ − λ)] + B e^{λτ}
//! ```
//!
//! with B from η at the interval's start; after the pulse the base rings freely, with c₀ = c₁ = C = 0. A mode at the
//! pulse's own rate would make both terms infinite; its rate is then shifted by a relative 1e-6.

use nalgebra::Complex;

use super::pulse::Stretch;
use crate::modal::{CoupledState, Phase, PointReadout, Readout};

/// Relative distance of a mode's rate from the pulse's below which the mode is shifted.
const CLOSEST: f64 = 1e-6;

/// A mode of base plate and housing, of unit modal mass.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct BaseMode {
    /// Undamped frequency, Hz.
    pub frequency_hz: f64,
    /// Damping ratio, at least 0, below 1.
    pub damping_ratio: f64,
    /// Load by a unit inertia load per mass, p, √kg.
    pub participation_sqrt_kg: f64,
    /// Displacement of the spindle, φ, 1/√kg.
    pub spindle_per_sqrt_kg: f64,
    /// Displacement of the ramp's mount, 1/√kg.
    pub ramp_per_sqrt_kg: f64,
    /// Displacement of the actuator's pivot, which carries the suspension, 1/√kg.
    pub pivot_per_sqrt_kg: f64,
}

impl BaseMode {
    /// Whether the mode can move: numbers finite, a frequency above 0, a damping ratio in [0, 1).
    pub fn is_sound(&self) -> bool {
        let numbers = [
            self.participation_sqrt_kg,
            self.spindle_per_sqrt_kg,
            self.ramp_per_sqrt_kg,
            self.pivot_per_sqrt_kg,
        ];
        self.frequency_hz.is_finite()
            && self.frequency_hz > 0.0
            && (0.0..1.0).contains(&self.damping_ratio)
            && numbers.iter().all(|x| x.is_finite())
    }
}

/// Motion of the actuator's pivot under the unit pulse.
#[derive(Clone, Debug)]
pub struct BaseMotion {
    modes: Vec<Swing>,
    segments: Vec<Segment>,
}

/// A mode of first order.
#[derive(Clone, Copy, Debug)]
struct Swing {
    /// λ.
    rate_per_s: Complex<f64>,
    /// w.
    entrance: Complex<f64>,
    /// Weight s of η in u, and in u̇.
    shape: Complex<f64>,
    velocity: Complex<f64>,
}

impl Swing {
    /// Forced part of η by the pulse alone, `tau_s` into an interval.
    fn forced(&self, stretch: &Stretch, tau_s: f64) -> Complex<f64> {
        let (
            Phase {
                constant,
                slope_per_s,
                wave,
            },
            sigma,
        ) = (stretch.phase, stretch.sigma_per_s);
        let rate = self.rate_per_s;
        let held = (rate.inv() * slope_per_s + (constant + slope_per_s * tau_s)) / rate;
        let mut sum = -held;
        for (wave, sigma) in [(wave, sigma), (wave.conj(), sigma.conj())] {
            if wave != Complex::default() {
                sum += wave * (sigma * tau_s).exp() / (sigma - rate) * 0.5;
            }
        }
        self.entrance * sum
    }
}

/// The pulse from one kink to the next, and the free ringing meanwhile.
#[derive(Clone, Debug)]
struct Segment {
    stretch: Stretch,
    /// B of every mode.
    free: Vec<Complex<f64>>,
}

impl BaseMotion {
    /// Motion of `pivot` by modes of `rates_per_s`, at rest at the onset, which the intervals of a pulse drive by
    /// `entrance`.
    pub fn new(
        rates_per_s: &[Complex<f64>],
        entrance: &CoupledState,
        pivot: &PointReadout,
        stretches: &[Stretch],
    ) -> Self {
        let swing = |(k, rate): (usize, &Complex<f64>)| {
            let is_met = |s: &Stretch| {
                let sigma = Complex::new(s.sigma_per_s.re, s.sigma_per_s.im.abs());
                (rate - sigma).norm() < CLOSEST * rate.norm()
            };
            let moved = match stretches.iter().any(is_met) {
                true => 1.0 + 2.0 * CLOSEST,
                false => 1.0,
            };
            // A readout holds Re(z̄ η) as (re, im) of z.
            let row = |of: &Readout| Complex::new(of.re[k], -of.im[k]);
            Swing {
                rate_per_s: rate * moved,
                entrance: Complex::new(entrance.re[k], entrance.im[k]),
                shape: row(&pivot.position),
                velocity: row(&pivot.velocity),
            }
        };
        let modes: Vec<Swing> = rates_per_s.iter().enumerate().map(swing).collect();
        let after = Stretch {
            start_s: stretches.last().map_or(0.0, |last| last.end_s),
            end_s: f64::INFINITY,
            sigma_per_s: Complex::from(0.0),
            phase: Phase::default(),
        };
        let mut segments = Vec::with_capacity(stretches.len() + 1);
        let mut start = vec![Complex::default(); modes.len()];
        for stretch in stretches.iter().chain([&after]) {
            let ringing = modes.iter().zip(&start);
            let segment = Segment {
                stretch: *stretch,
                free: ringing
                    .map(|(mode, eta)| eta - mode.forced(stretch, 0.0))
                    .collect(),
            };
            if stretch.end_s.is_finite() {
                let tau_s = stretch.end_s - stretch.start_s;
                for (k, (eta, mode)) in start.iter_mut().zip(&modes).enumerate() {
                    *eta = segment.state(mode, k, tau_s);
                }
            }
            segments.push(segment);
        }
        Self { modes, segments }
    }

    /// Displacement of the pivot relative to the rigid base per unit amplitude, s², and its rate.
    pub fn displacement(&self, time_s: f64) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (mode, eta) in self.states(time_s) {
            sum[0] += (mode.shape * eta).re;
            sum[1] += (mode.velocity * eta).re;
        }
        sum
    }

    /// b where the pulse is `value` at `time_s`: at a jump of the pulse, on either side.
    pub fn load(&self, time_s: f64, value: f64) -> f64 {
        let accelerations = self.states(time_s).map(|(mode, eta)| {
            let rate = mode.rate_per_s * eta + mode.entrance * value;
            (mode.velocity * rate).re
        });
        value - accelerations.sum::<f64>()
    }

    fn segment(&self, time_s: f64) -> &Segment {
        let ended = |segment: &Segment| segment.stretch.end_s <= time_s;
        &self.segments[self.segments.partition_point(ended)]
    }

    /// Every mode with its η.
    fn states(&self, time_s: f64) -> impl Iterator<Item = (&Swing, Complex<f64>)> {
        let segment = self.segment(time_s);
        let tau_s = time_s - segment.stretch.start_s;
        let modes = self.modes.iter().enumerate();
        modes.map(move |(k, mode)| (mode, segment.state(mode, k, tau_s)))
    }
}

impl Segment {
    fn state(&self, mode: &Swing, k: usize, tau_s: f64) -> Complex<f64> {
        mode.forced(&self.stretch, tau_s) + self.free[k] * (mode.rate_per_s * tau_s).exp()
    }
}
