//! Small motions of the slider on its film about a steady state: impedance against frequency, air-bearing modes.
//!
//! ```text
//! (A + s M) ψ̂ = −C q̂,   F̂ = F_ψ ψ̂ + F_q q̂ = −Z(s) q̂,   Z(s) = F_ψ (A + s M)⁻¹ C − F_q
//! ```
//!
//! A = dR/dψ, C = dR/dq and the storage M come from the linearisation the steady solution uses.
//! At s = iω, Re Z is the stiffness and Im Z/ω the damping. A slider of inertia J free on its film
//! moves as exp(s t) where det(Z(s) + s² J) = 0; Z varies slowly with s, so each root follows from
//! a few eigenvalue problems of size three.

use super::attitude::Attitude;
use super::film::Film;
use crate::linalg::banded::{BandedError, BandedLu};
use crate::linalg::diagonals::Diagonals;
use nalgebra::{Complex, Matrix3, Vector3};
use thiserror::Error;

/// Why a dynamic property of the film could not be found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ImpedanceError {
    /// The complex system could not be factored.
    #[error("the film's dynamic matrix could not be factored: {0}")]
    Singular(#[from] BandedError),
    /// The matrix of film, slider and suspension is singular.
    #[error("film, slider and suspension resonate without damping at {frequency_hz} Hz")]
    Resonance {
        /// Frequency, Hz.
        frequency_hz: f64,
    },
    /// A mode did not settle.
    #[error("air-bearing mode {mode} did not settle, last value {frequency_hz} Hz")]
    Mode {
        /// Index from the lowest.
        mode: usize,
        /// Last iterate, Hz.
        frequency_hz: f64,
    },
}

/// Free vibration of the slider on its film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirBearingMode {
    /// |s|/2π, Hz.
    pub frequency_hz: f64,
    /// −Re s/|s|.
    pub damping_ratio: f64,
    /// Complex amplitudes of centre height (1/√kg), pitch and roll (1/(m √kg)) with q̂ᴴ J q̂ = 1, turned so
    /// that q̂ᵀ J q̂ is real and positive: the real part is then as large as it can be.
    pub shape: [Complex<f64>; 3],
}

/// Film linearised about a state.
pub struct SmallMotion<'a> {
    film: &'a Film,
    by_psi: Diagonals,
    by_attitude: [Vec<f64>; 3],
    force_by_psi: [Vec<f64>; 3],
    force_by_attitude: [[f64; 3]; 3],
    /// A + s M with real and imaginary part of every cell side by side.
    matrix: Diagonals,
    lu: BandedLu,
    /// Real and imaginary part of every cell side by side, column by column.
    columns: [Vec<f64>; 3],
    zero: Diagonals,
}

impl<'a> SmallMotion<'a> {
    /// Linearises about (ψ, attitude), usually a steady state.
    ///
    /// # Panics
    ///
    /// When `psi` has not n_cells entries.
    pub fn new(film: &'a Film, psi: &[f64], attitude: &Attitude) -> Self {
        let mut linearisation = film.linearisation();
        film.linearise(psi, attitude, &mut linearisation, &mut film.scratch());
        let n = film.n_cells();
        let offsets = linearisation.by_psi.offsets().iter();
        let pairs = offsets.map(|offset| 2 * offset);
        let stored = film.storage().offsets().iter();
        let pairs =
            pairs.chain(stored.flat_map(|offset| [2 * offset - 1, 2 * offset, 2 * offset + 1]));
        let matrix = Diagonals::zeros(2 * n, pairs.collect());
        Self {
            film,
            lu: BandedLu::new(2 * n, matrix.band()),
            matrix,
            columns: [0; 3].map(|_| vec![0.0; 2 * n]),
            zero: Diagonals::zeros(2 * n, Vec::new()),
            by_psi: linearisation.by_psi,
            by_attitude: linearisation.by_attitude,
            force_by_psi: linearisation.force_by_psi,
            force_by_attitude: linearisation.force_by_attitude,
        }
    }

    /// Z(s), rows and columns in the order (h_c, pitch, roll), s in 1/s.
    ///
    /// # Errors
    ///
    /// [`ImpedanceError::Singular`] when s meets a decay rate of the film itself.
    pub fn at(&mut self, s: Complex<f64>) -> Result<Matrix3<Complex<f64>>, ImpedanceError> {
        self.matrix.clear();
        for (offset, of_cells) in self.by_psi.iter() {
            let pairs = self.matrix.column_mut(2 * offset).expect("made for it");
            for (pair, value) in pairs.chunks_exact_mut(2).zip(of_cells) {
                pair.fill(*value);
            }
        }
        for (offset, of_cells) in self.film.storage().iter() {
            // Imaginary part of the next cell's pair in rows of real parts and the other way round.
            for (beside, row, part) in [(0, 0, s.re), (0, 1, s.re), (1, 0, -s.im), (-1, 1, s.im)] {
                let pairs = self.matrix.column_mut(2 * offset + beside);
                let pairs = pairs.expect("made for it").chunks_exact_mut(2);
                for (pair, value) in pairs.zip(of_cells) {
                    pair[row] += part * value;
                }
            }
        }
        self.lu.factor(&self.matrix, 0.0, &self.zero)?;
        for (column, by) in self.columns.iter_mut().zip(&self.by_attitude) {
            for (pair, by) in column.chunks_exact_mut(2).zip(by) {
                pair.copy_from_slice(&[*by, 0.0]);
            }
            self.lu.solve(column);
        }
        Ok(Matrix3::from_fn(|f, q| {
            let mut sum = Complex::new(-self.force_by_attitude[f][q], 0.0);
            for (gradient, pair) in self.force_by_psi[f]
                .iter()
                .zip(self.columns[q].chunks_exact(2))
            {
                sum += Complex::new(gradient * pair[0], gradient * pair[1]);
            }
            sum
        }))
    }

    /// ψ̂ = −(A + s M)⁻¹ C q̂ of every cell at the s of the last [`SmallMotion::at`], Pa m.
    pub fn film(&self, q: [Complex<f64>; 3]) -> Vec<Complex<f64>> {
        let cells = 0..self.film.n_cells();
        let of_cell = |i: usize| {
            let mut psi = Complex::new(0.0, 0.0);
            for (column, q) in self.columns.iter().zip(q) {
                psi -= Complex::new(column[2 * i], column[2 * i + 1]) * q;
            }
            psi
        };
        cells.map(of_cell).collect()
    }

    /// Z at a frequency: stiffness Re Z (N/m, N, N m/rad) and damping Im Z/ω.
    ///
    /// # Errors
    ///
    /// As [`SmallMotion::at`].
    pub fn impedance(
        &mut self,
        frequency_hz: f64,
    ) -> Result<Matrix3<Complex<f64>>, ImpedanceError> {
        self.at(Complex::new(0.0, std::f64::consts::TAU * frequency_hz))
    }

    /// The three modes of a slider with the inertia diag(`inertia`) (kg, kg m2, kg m2) that nothing
    /// but the film holds, from the lowest frequency up.
    ///
    /// # Errors
    ///
    /// [`ImpedanceError`] when a factorisation fails or a mode does not settle.
    pub fn free_modes(&mut self, inertia: [f64; 3]) -> Result<[AirBearingMode; 3], ImpedanceError> {
        // Mass-scaled Z has eigenvalues −s².
        let roots = inertia.map(f64::sqrt);
        let scaled =
            |z: Matrix3<Complex<f64>>| Matrix3::from_fn(|i, j| z[(i, j)] / (roots[i] * roots[j]));
        let spectrum = |z: Matrix3<Complex<f64>>| {
            let mut values: [Complex<f64>; 3] = scaled(z).schur().unpack().1.diagonal().into();
            values.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
            values
        };
        let root = |value: Complex<f64>| {
            let s = (-value).sqrt();
            if s.im < 0.0 { -s } else { s }
        };
        let start = spectrum(self.impedance(START_HZ)?);
        let mut modes = [AirBearingMode {
            frequency_hz: 0.0,
            damping_ratio: 0.0,
            shape: [Complex::new(0.0, 0.0); 3],
        }; 3];
        for (k, mode) in modes.iter_mut().enumerate() {
            let mut s = root(start[k]);
            let mut settled = false;
            for _ in 0..MOST_MODE_ITERATIONS {
                let values = spectrum(self.at(s)?);
                let target = -(s * s);
                let nearest = values
                    .into_iter()
                    .min_by(|a, b| (a - target).norm().total_cmp(&(b - target).norm()));
                let Some(nearest) = nearest else { break };
                let next = root(nearest);
                let change = (next - s).norm() / next.norm();
                s = next;
                if change < 1e-9 {
                    settled = true;
                    break;
                }
            }
            let frequency_hz = s.norm() / std::f64::consts::TAU;
            if !settled {
                return Err(ImpedanceError::Mode {
                    mode: k,
                    frequency_hz,
                });
            }
            *mode = AirBearingMode {
                frequency_hz,
                damping_ratio: -s.re / s.norm(),
                shape: {
                    let balance = scaled(self.at(s)?) + Matrix3::identity() * (s * s);
                    let shape = null_vector(&balance);
                    std::array::from_fn(|i| shape[i] / roots[i])
                },
            };
        }
        modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        Ok(modes)
    }
}

/// Vector v of length 1 that a singular matrix of rank two maps to zero, with vᵀ v real and positive.
fn null_vector(matrix: &Matrix3<Complex<f64>>) -> Vector3<Complex<f64>> {
    // Orthogonal to two rows, without conjugation; of the three pairs the most independent one.
    let row = |i: usize| matrix.row(i % 3).transpose();
    let crossed = (0..3).map(|i| row(i).cross(&row(i + 1)));
    let best = crossed.max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
    let best = best.unwrap_or_else(Vector3::zeros);
    let square: Complex<f64> = best.iter().map(|x| x * x).sum();
    let turn = Complex::from_polar(best.norm(), 0.5 * square.arg());
    best.map(|x| x / turn)
}

/// Frequency whose impedance the search for modes starts from, Hz; the film is stiff there.
const START_HZ: f64 = 1.5e5;

/// Most eigenvalue problems for one mode.
const MOST_MODE_ITERATIONS: usize = 60;
