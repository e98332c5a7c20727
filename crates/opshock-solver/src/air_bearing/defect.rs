//! Discretisation defect of one film grid: the error of its force and moments, as a function of the attitude.
//!
//! The defect interpolates samples (`interpolation`) in variables in which it is smooth (`range`).
//! [`super::correction_forces`] describes the sampling.

pub(super) mod interpolation;
pub(super) mod range;

use super::attitude::Attitude;
use super::gap_load::GapLoad;
use interpolation::Interpolation;
use range::Range;

/// Discretisation defect of one grid: force and moments that the grid lacks.
#[derive(Clone, Debug)]
pub(super) struct Defect {
    pub(super) range: Range,
    pub(super) missing: Interpolation,
}

impl Defect {
    /// P at an attitude.
    pub(super) fn force(&self, attitude: &Attitude) -> [f64; 3] {
        let variables = self.range.variables(attitude);
        self.missing.values(variables.map(|x| x.0))
    }

    /// P and its derivatives.
    pub(super) fn load(&self, attitude: &Attitude) -> GapLoad {
        let variables = self.range.variables(attitude);
        let (force, slopes) = self.missing.linearised(variables.map(|x| x.0));
        let by = |f: usize, q: usize| -> f64 {
            let parts = slopes[f].iter().zip(&variables);
            parts.map(|(slope, x)| slope * x.1[q]).sum()
        };
        GapLoad {
            in_plane_n: None,
            force,
            by_attitude: std::array::from_fn(|f| std::array::from_fn(|q| by(f, q))),
        }
    }
}
