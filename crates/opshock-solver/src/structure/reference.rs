//! The same structure under the reference method, for tests of the production scheme.
//!
//! One state for shock and contact together, implicit midpoint instead of exact flow, velocity
//! constraint instead of aimed impulses ([`crate::complementarity::moreau_jean`]).

use super::StructureModel;
use crate::complementarity::moreau_jean::{LinearMode, MoreauJean};
use nalgebra::Complex;

/// Columns of a reference run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReferenceRun {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Disk under the slider, m.
    pub disk_slider_m: Vec<f64>,
    /// Disk at the ramp point, m.
    pub disk_ramp_m: Vec<f64>,
    /// Impulse on each arm, N s.
    pub impulse_n_s: [f64; 2],
    /// Largest penetration, m.
    pub max_penetration_m: f64,
}

impl StructureModel {
    /// Runs the model's modes with Moreau-Jean steps of the model's length.
    pub fn run_reference(&self, amplitude_m_per_s2: f64) -> ReferenceRun {
        let s = &*self.shared;
        let h = s.free.step_s;
        let modes = s
            .oscillators
            .iter()
            .map(|o| {
                let (gamma, turn) = (o.half_damping_per_s, o.turn_rad_per_s);
                LinearMode {
                    stiffness_per_s2: Complex::new(o.fixed_frame_stiffness(), 2.0 * gamma * turn),
                    damping_per_s: Complex::new(2.0 * gamma + o.fixed_damping_per_s, 2.0 * turn),
                }
            })
            .collect();
        let row = |side: usize, sign: f64| -> Vec<f64> {
            let pairs = s.arm_shape[side].iter().zip(&s.contact);
            pairs.map(|(arm, disk)| sign * (arm - disk)).collect()
        };
        let shapes: Vec<_> = [row(0, 1.0), row(1, -1.0)]
            .into_iter()
            .take(s.n_contacts)
            .collect();
        let clearance = s.clearance_m[..s.n_contacts].to_vec();
        let mut system = MoreauJean::new(modes, shapes, clearance, s.law.restitution, h);
        let mut force = vec![0.0; s.oscillators.len()];
        let mut run = ReferenceRun::default();
        for k in 0..=s.n_steps {
            let read = |re: &[f64], im: &[f64]| -> f64 {
                let weights = re.iter().zip(im).zip(&system.amplitude);
                weights.map(|((a, b), q)| a * q.re + b * q.im).sum()
            };
            let ramp: f64 = s
                .contact
                .iter()
                .zip(&system.amplitude)
                .map(|(b, q)| b * q.re)
                .sum();
            run.time_s.push(k as f64 * h);
            run.disk_slider_m
                .push(read(&s.slider[0].re, &s.slider[0].im));
            run.disk_ramp_m.push(ramp);
            for i in 0..s.n_contacts {
                run.max_penetration_m = run.max_penetration_m.max(-system.gap_m(i));
            }
            let middle = amplitude_m_per_s2 * s.pulse.value((k as f64 + 0.5) * h);
            for (&i, gain) in s.forced_index.iter().zip(&s.free.modes.participation) {
                force[i] = gain * middle;
            }
            let p = system.step(&force);
            run.impulse_n_s[0] += p[0];
            run.impulse_n_s[1] += p[1];
        }
        run
    }
}
