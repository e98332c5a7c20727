//! Disk and ramp on a base that vibrates ([`crate::shock::BaseMotion`]).
//!
//! Each mount passes on the load b(t) = a(t) − ü instead of a(t), and moves by u. Within a step b is the
//! pulse with its wave changed by G, and one decaying wave per mode of base and disk together, so every
//! oscillator keeps a closed-form response: that to the pulse and one more per wave.

use nalgebra::Complex;

use crate::complementarity::Gap;
use crate::modal::{ForcedResponse, Oscillator, Phase};
use crate::shock::{BaseMotion, Mount};

/// Most modes of a base.
pub(super) const MOST_MODES: usize = 16;
/// Most modes of the disk that are coupled to it; what is above them has next to none of its mass.
pub(super) const MOST_RIDERS: usize = 48;
/// Modes of first order: one of each conjugate pair.
const MOST_WAVES: usize = MOST_MODES + MOST_RIDERS;

/// Mounts of what the structure marches: disk, ramp.
const MOUNTS: [Mount; 2] = [Mount::Spindle, Mount::Ramp];

/// A base with the responses of what stands on it.
pub(super) struct OnBase {
    pub motion: BaseMotion,
    /// G at each mount.
    gains: [Complex<f64>; 2],
    /// Over a whole step, by mode of the base, then by oscillator.
    step: Responses,
    /// The same over each time of a quadrature within the step.
    quadrature: Vec<Responses>,
}

type Responses = Vec<Vec<ForcedResponse>>;

/// Waves of the load at both mounts from an instant on, by mode of the base.
#[derive(Clone, Copy)]
pub(super) struct Waves([[Complex<f64>; 2]; MOST_WAVES]);

impl OnBase {
    /// `oscillators` on the base, under a pulse of rate `sigma_per_s`.
    pub fn new(
        motion: BaseMotion,
        sigma_per_s: Complex<f64>,
        oscillators: &[Oscillator],
        step_s: f64,
        quadrature_s: impl Iterator<Item = f64>,
    ) -> Self {
        let responses = |h_s: f64| -> Responses {
            let rates = (0..motion.n_modes()).map(|k| motion.rate_per_s(k));
            rates
                .map(|rate| {
                    let of = |o: &Oscillator| ForcedResponse::new(o, rate, h_s);
                    oscillators.iter().map(of).collect()
                })
                .collect()
        };
        Self {
            gains: MOUNTS.map(|mount| motion.gain(mount, sigma_per_s)),
            step: responses(step_s),
            quadrature: quadrature_s.map(responses).collect(),
            motion,
        }
    }

    /// The pulse at both mounts, without the base's ringing.
    pub fn phases(&self, phase: &Phase) -> [Phase; 2] {
        self.gains.map(|gain| Phase {
            wave: phase.wave * gain,
            ..*phase
        })
    }

    /// The ringing from `start_s` on.
    pub fn waves(&self, start_s: f64) -> Waves {
        let mut waves = [[Complex::default(); 2]; MOST_WAVES];
        for (k, own) in waves.iter_mut().enumerate().take(self.motion.n_modes()) {
            *own = MOUNTS.map(|mount| self.motion.wave(mount, k, start_s));
        }
        Waves(waves)
    }

    /// Load of the ringing at both mounts `tau_s` after `waves`.
    pub fn ringing(&self, waves: &Waves, tau_s: f64) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (k, waves) in waves.0.iter().enumerate().take(self.motion.n_modes()) {
            let turn = (self.motion.rate_per_s(k) * tau_s).exp();
            for (sum, wave) in sum.iter_mut().zip(waves) {
                *sum += (wave * turn).re;
            }
        }
        sum
    }

    /// Increments of oscillator `j` at `mount` by the ringing over a whole step.
    pub fn step_increments(&self, waves: &Waves, j: usize, mount: usize) -> (f64, f64) {
        increments(self.step.iter().map(|of| of[j]), waves, mount)
    }

    /// That of its velocity up to point `point` of the quadrature.
    pub fn velocity_increment(&self, point: usize, waves: &Waves, j: usize, mount: usize) -> f64 {
        let responses = self.quadrature[point].iter().map(|of| of[j]);
        increments(responses, waves, mount).1
    }

    /// Increments of `oscillator` at `mount` by the ringing over any time; nothing tabulated.
    pub fn piece_increments(
        &self,
        oscillator: &Oscillator,
        start_s: f64,
        h_s: f64,
        mount: usize,
    ) -> (f64, f64) {
        let rates = (0..self.motion.n_modes()).map(|k| self.motion.rate_per_s(k));
        let responses = rates.map(|rate| ForcedResponse::new(oscillator, rate, h_s));
        increments(responses, &self.waves(start_s), mount)
    }

    /// Loads at both mounts at `time_s`, where the pulse is `value`.
    pub fn loads(&self, time_s: f64, value: f64) -> [f64; 2] {
        MOUNTS.map(|mount| self.motion.load(mount, time_s, value))
    }

    /// Displacement of disk and ramp mount over the rigid base per unit amplitude, with rates.
    pub fn mounts(&self, time_s: f64) -> [[f64; 2]; 2] {
        MOUNTS.map(|mount| self.motion.displacement(mount, time_s))
    }

    /// What the mounts add to the top and the bottom gap under an amplitude.
    pub fn gaps(&self, amplitude: f64, time_s: f64) -> [Gap; 2] {
        let [spindle, ramp] = self.mounts(time_s);
        [1.0, -1.0].map(|sign| Gap {
            value_m: sign * amplitude * (ramp[0] - spindle[0]),
            rate_m_per_s: sign * amplitude * (ramp[1] - spindle[1]),
        })
    }

    /// Rate at which the mounts open the top gap per unit amplitude; the bottom one closes as fast.
    pub fn opening_rate(&self, time_s: f64) -> f64 {
        let [[_, spindle], [_, ramp]] = self.mounts(time_s);
        ramp - spindle
    }
}

fn increments(
    responses: impl Iterator<Item = ForcedResponse>,
    waves: &Waves,
    mount: usize,
) -> (f64, f64) {
    let mut sum = (0.0, 0.0);
    for (response, waves) in responses.zip(&waves.0) {
        let (x, v) = response.increments(&Phase {
            wave: waves[mount],
            ..Phase::default()
        });
        sum = (sum.0 + x, sum.1 + v);
    }
    sum
}
