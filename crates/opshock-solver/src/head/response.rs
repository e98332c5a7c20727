//! Frequency response of the whole head: small harmonic motions about steady flight.
//!
//! ```text
//! (s² M + s C + K + Z(s)) x̂ = f̂ + Z(s) ŵ,    ψ̂ = −(A + s M_f)⁻¹ C_f (q̂ − ŵ),   s = iω
//! ```
//!
//! x: slider (z, pitch, roll) and suspension; w: pose of the disk's plane; Z: the film's impedance with the
//! contribution of surface forces. The dimple is closed, as in steady flight; limiters and lift tab are open.

use super::model::HeadModel;
use crate::air_bearing::impedance::{ImpedanceError, SmallMotion};
use nalgebra::{Complex, DMatrix, DVector, Matrix3};

/// Excitation of the head at one frequency; complex amplitudes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drive {
    /// Pose of the disk under the slider: displacement (m), pitch and roll (rad).
    pub disk: [Complex<f64>; 3],
    /// Force and moments on the slider, N and N m.
    pub slider: [Complex<f64>; 3],
    /// Force on the suspension at its dimple, N.
    pub dimple_n: Complex<f64>,
    /// Inertia load per mass on everything, m/s2.
    pub load_m_per_s2: Complex<f64>,
}

/// Response of the head at one frequency; complex amplitudes.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Slider: z (m), pitch and roll (rad).
    pub slider: [Complex<f64>; 3],
    /// The suspension's dimple, m.
    pub dimple_m: Complex<f64>,
    /// The air's and surface forces' change on the slider, N and N m.
    pub film: [Complex<f64>; 3],
    /// Every coordinate of slider and suspension.
    pub(super) coordinates: Vec<Complex<f64>>,
}

/// A head linearised about its steady flight.
pub struct HeadResponse<'a> {
    model: &'a HeadModel,
    film: SmallMotion<'a>,
}

impl<'a> HeadResponse<'a> {
    /// Linearises `model`.
    pub fn new(model: &'a HeadModel) -> Self {
        Self {
            model,
            film: SmallMotion::new(&model.film, &model.flight.psi, &model.flight.attitude),
        }
    }

    /// The film's impedance Z(iω) in the order (height, pitch, roll): stiffness Re Z, damping Im Z/ω.
    ///
    /// # Errors
    ///
    /// As [`SmallMotion::at`].
    pub fn impedance(
        &mut self,
        omega_rad_per_s: f64,
    ) -> Result<Matrix3<Complex<f64>>, ImpedanceError> {
        self.film.at(Complex::new(0.0, omega_rad_per_s))
    }

    /// The response to `drive` at ω; 0 is the static limit.
    ///
    /// # Errors
    ///
    /// As [`SmallMotion::at`], and [`ImpedanceError::Resonance`] at an undamped resonance.
    pub fn at(&mut self, omega_rad_per_s: f64, drive: &Drive) -> Result<Answer, ImpedanceError> {
        let s = Complex::new(0.0, omega_rad_per_s);
        let z = self.film.at(s)?;
        let mechanics = &self.model.mechanics;
        let mut matrix = mechanics.dynamic_matrix(s);
        let mut load: DVector<Complex<f64>> =
            mechanics.inertia_load().map(|m| drive.load_m_per_s2 * m);
        for f in 0..3 {
            load[f] += drive.slider[f];
            for q in 0..3 {
                matrix[(f, q)] += z[(f, q)];
                load[f] += z[(f, q)] * drive.disk[q];
            }
        }
        let dimple = mechanics.dimple_row().map(Complex::from);
        load.axpy(drive.dimple_n, &dimple, Complex::from(1.0));
        let resonance = ImpedanceError::Resonance {
            frequency_hz: omega_rad_per_s / std::f64::consts::TAU,
        };
        let x = DMatrix::lu(matrix).solve(&load).ok_or(resonance)?;
        let slider = std::array::from_fn(|q| x[q]);
        let film = std::array::from_fn(|f| {
            let parts = (0..3).map(|q| -z[(f, q)] * (x[q] - drive.disk[q]));
            parts.sum()
        });
        Ok(Answer {
            slider,
            dimple_m: dimple.dot(&x),
            film,
            coordinates: x.iter().copied().collect(),
        })
    }

    /// ψ̂ of every cell in the last [`HeadResponse::at`], Pa m.
    pub(super) fn film_of(&self, answer: &Answer, drive: &Drive) -> Vec<Complex<f64>> {
        self.film
            .film(std::array::from_fn(|q| answer.slider[q] - drive.disk[q]))
    }
}
