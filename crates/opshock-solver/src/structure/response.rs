//! Computes small harmonic motions of disk and ramp without contact.
//!
//! ```text
//! H(s) = 1/((s + iN)² + (2γ + c)(s + iN) + ω² − icN),   q̂± = φ H(±iω) F̂
//! ŵ = ½ Σ (b H(iω) + conj(b H(−iω))) φ F̂,   w = Re Σ b q
//! ```
//!
//! over the disk's modes, whose coordinates are complex in the fixed frame, and the same with N = c = 0 over those of
//! the arms. A shock drives n = 0 and the arms by their participations. With a hub disk and hub are coupled, and there
//! is no such sum.

use super::error::StructureError;
use super::model::StructureModel;
use crate::modal::Oscillator;
use nalgebra::Complex;

/// What drives disk and ramp: 1 N at a point, or the shock, 1 m/s² of inertia load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The pulse: every mode by its participation.
    Shock,
    /// Force on the disk at the ramp point, N.
    DiskAtRamp,
    /// Force on the disk under the slider, N.
    DiskAtSlider,
    /// Force on the top arm's contact point, N.
    TopArm,
    /// Force on the bottom arm's contact point, N.
    BottomArm,
}

/// Complex amplitudes of the points that are read, per unit of the source.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StructureAnswer {
    /// Disk at the ramp point, m.
    pub ramp_m: Complex<f64>,
    /// Disk at the rim over the ramp's angle, m.
    pub rim_m: Complex<f64>,
    /// Plane of the disk under the slider: displacement (m), pitch and roll (rad).
    pub slider: [Complex<f64>; 3],
    /// Contact points of the top and the bottom arm, m.
    pub arms_m: [Complex<f64>; 2],
}

/// Both parts of a mode's response: H(iω) and conj H(−iω).
fn sides(o: &Oscillator, omega: f64) -> [Complex<f64>; 2] {
    let turn = Complex::new(0.0, o.turn_rad_per_s);
    let at = |omega: f64| {
        let s = Complex::new(0.0, omega) + turn;
        let damping = 2.0 * o.half_damping_per_s + o.fixed_damping_per_s;
        let stiffness = o.omega_rad_per_s.powi(2) - turn * o.fixed_damping_per_s;
        (s * s + s * damping + stiffness).inv()
    };
    [at(omega), at(-omega).conj()]
}

impl StructureModel {
    /// Response at ω to `source`; ω = 0 gives the static response. `None` for a disk on a hub.
    ///
    /// # Errors
    /// A failed eigenvalue problem of a harmonic n >= 1.
    pub fn response(
        &self,
        omega_rad_per_s: f64,
        source: Source,
    ) -> Result<Option<StructureAnswer>, StructureError> {
        let shared = &*self.shared;
        if shared.free.rotor.is_some() {
            return Ok(None);
        }
        let driven = shared.driven()?;
        let one = Complex::new(1.0, 0.0);
        let slider =
            |q: usize, i: usize| Complex::new(driven.slider[q].re[i], -driven.slider[q].im[i]);
        let mut out = StructureAnswer::default();
        for (i, o) in driven.oscillators.iter().enumerate() {
            if o.omega_rad_per_s == 0.0 {
                continue;
            }
            // A force at a point read by b drives the complex coordinate by conj b.
            let drive = match source {
                Source::Shock => {
                    let place = driven.forced_index.iter().position(|&index| index == i);
                    one * place.map_or(0.0, |j| shared.free.modes.participation[j])
                }
                Source::DiskAtRamp => one * driven.contact[i],
                Source::DiskAtSlider => slider(0, i).conj(),
                Source::TopArm => one * driven.arm_shape[0][i],
                Source::BottomArm => one * driven.arm_shape[1][i],
            };
            if drive == Complex::default() {
                continue;
            }
            let [plus, minus] = sides(o, omega_rad_per_s);
            let read = |b: Complex<f64>| 0.5 * (b * plus * drive + (b * drive).conj() * minus);
            out.ramp_m += read(one * driven.contact[i]);
            out.rim_m += read(one * driven.rim[i]);
            for (q, out) in out.slider.iter_mut().enumerate() {
                *out += read(slider(q, i));
            }
            for (side, out) in out.arms_m.iter_mut().enumerate() {
                *out += read(one * driven.arm_shape[side][i]);
            }
        }
        Ok(Some(out))
    }
}
