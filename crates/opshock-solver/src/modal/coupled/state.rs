//! Amplitudes of the damped modes of coupled oscillators, their flow over a time, and rows that read a point from them.

use crate::linalg::SquareMatrix;
use crate::modal::bank::{Readout, dot};

/// Amplitudes η of all modes, in columns of whole chunks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoupledState {
    /// Real parts.
    pub re: Vec<f64>,
    /// Imaginary parts.
    pub im: Vec<f64>,
}

/// e^{sh} − 1 of all modes.
#[derive(Clone, Debug, Default)]
pub struct CoupledFlow {
    pub(super) re: Vec<f64>,
    pub(super) im: Vec<f64>,
}

/// Rows that read displacement and velocity of a point.
#[derive(Clone, Debug, Default)]
pub struct PointReadout {
    /// Displacement.
    pub position: Readout,
    /// Velocity.
    pub velocity: Readout,
}

impl CoupledState {
    /// Puts every mode to rest.
    pub fn reset(&mut self) {
        self.re.fill(0.0);
        self.im.fill(0.0);
    }

    /// Takes the values of `other`, of the same length.
    pub fn copy_from(&mut self, other: &Self) {
        self.re.copy_from_slice(&other.re);
        self.im.copy_from_slice(&other.im);
    }

    /// Adds `factor` times `other`.
    pub fn add(&mut self, other: &Self, factor: f64) {
        for (x, y) in self.re.iter_mut().zip(&other.re) {
            *x += factor * y;
        }
        for (x, y) in self.im.iter_mut().zip(&other.im) {
            *x += factor * y;
        }
    }

    /// zᵀ F z over real, then imaginary parts.
    pub fn form(&self, form: &SquareMatrix) -> f64 {
        let m = self.re.len();
        let along = |row: &[f64]| {
            let re = dot(&row[..m], &self.re);
            re + dot(&row[m..], &self.im)
        };
        let re: f64 = (0..m).map(|i| self.re[i] * along(form.row(i))).sum();
        let im: f64 = (0..m).map(|i| self.im[i] * along(form.row(m + i))).sum();
        re + im
    }
}

impl CoupledFlow {
    /// `after` := flow of `before`.
    pub fn apply(&self, before: &CoupledState, after: &mut CoupledState) {
        for k in 0..self.re.len() {
            let (x, y) = (before.re[k], before.im[k]);
            after.re[k] = x + (self.re[k] * x - self.im[k] * y);
            after.im[k] = y + (self.re[k] * y + self.im[k] * x);
        }
    }

    /// Adds to `after` the effect of an impulse on `entrance` at the start of the flow.
    pub fn add_kick(&self, entrance: &CoupledState, impulse: f64, after: &mut CoupledState) {
        for k in 0..self.re.len() {
            let (x, y) = (impulse * entrance.re[k], impulse * entrance.im[k]);
            after.re[k] += x + (self.re[k] * x - self.im[k] * y);
            after.im[k] += y + (self.re[k] * y + self.im[k] * x);
        }
    }

    /// Displacement of `to` after the flow per unit impulse on `entrance` at its start.
    pub fn compliance(&self, entrance: &CoupledState, to: &PointReadout) -> f64 {
        let mut sum = 0.0;
        for k in 0..self.re.len() {
            let (x, y) = (entrance.re[k], entrance.im[k]);
            // The displacement right after the impulse is zero but for rounding.
            sum += to.position.re[k] * (self.re[k] * x - self.im[k] * y)
                + to.position.im[k] * (self.re[k] * y + self.im[k] * x);
        }
        sum
    }
}

impl PointReadout {
    /// (displacement, velocity).
    pub fn read(&self, state: &CoupledState) -> (f64, f64) {
        (
            self.position.read(&state.re, &state.im),
            self.velocity.read(&state.re, &state.im),
        )
    }
}
