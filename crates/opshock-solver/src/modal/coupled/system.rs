//! Matrices of coupled oscillators, their energies and losses.

use crate::linalg::SquareMatrix;
use nalgebra::Complex;

/// A spring in series with a dashpot between a coordinate and the ground.
#[derive(Clone, Copy, Debug)]
pub struct Maxwell {
    /// The coordinate.
    pub coordinate: usize,
    /// Stiffness k of the spring.
    pub stiffness: f64,
    /// Relaxation time τ, s.
    pub time_s: f64,
}

/// Matrices of coupled oscillators.
#[derive(Clone, Debug)]
pub struct CoupledSystem {
    /// M, symmetric and positive definite.
    pub mass: SquareMatrix,
    /// Real part of D.
    pub damping: SquareMatrix,
    /// Imaginary part of D: symmetric for gyroscopic moments.
    pub gyroscopic: SquareMatrix,
    /// U: the symmetric part of K that stores energy.
    pub stiffness: SquareMatrix,
    /// Imaginary part of K.
    pub cross_stiffness: SquareMatrix,
    /// Positive diagonal stiffness with frequencies like the system's: the scale of amplitudes beside
    /// velocities in the eigenproblem.
    pub scale: Vec<f64>,
    /// Maxwell elements.
    pub elements: Vec<Maxwell>,
}

/// Coordinates and velocities.
#[derive(Clone, Debug, Default)]
pub struct Coordinates {
    /// q.
    pub q: Vec<Complex<f64>>,
    /// q̇.
    pub v: Vec<Complex<f64>>,
    /// y of the Maxwell elements.
    pub y: Vec<Complex<f64>>,
}

impl CoupledSystem {
    /// Zero matrices for `scale.len()` coordinates.
    pub fn zeros(scale: Vec<f64>) -> Self {
        let zero = || SquareMatrix::zeros(scale.len());
        Self {
            mass: zero(),
            damping: zero(),
            gyroscopic: zero(),
            stiffness: zero(),
            cross_stiffness: zero(),
            scale,
            elements: Vec::new(),
        }
    }

    /// ½ q̇ᴴ M q̇, ½ qᴴ U q + Σ ½ k |y|².
    pub fn energies(&self, at: &Coordinates) -> (f64, f64) {
        (
            0.5 * hermitian(&self.mass, &at.v),
            0.5 * hermitian(&self.stiffness, &at.q) + 0.5 * self.extended(at, |_| 1.0),
        )
    }

    /// Σ k |y|² weight.
    fn extended(&self, at: &Coordinates, weight: impl Fn(&Maxwell) -> f64) -> f64 {
        let elements = self.elements.iter().zip(&at.y);
        let of = |(element, y): (&Maxwell, &Complex<f64>)| {
            element.stiffness * y.norm_sqr() * weight(element)
        };
        elements.map(of).sum()
    }

    /// Re(q̇ᴴ D q̇ + q̇ᴴ (K − U) q) + Σ k |y|²/τ: power taken from H.
    pub fn loss_rate(&self, at: &Coordinates) -> f64 {
        let n = self.scale.len();
        let mut cross = 0.0;
        for i in 0..n {
            for (j, k) in self.cross_stiffness.row(i).iter().enumerate() {
                // Re(v* i k q)
                cross += k * (at.v[i].im * at.q[j].re - at.v[i].re * at.q[j].im);
            }
        }
        hermitian(&self.damping, &at.v)
            + cross
            + self.extended(at, |element| element.time_s.recip())
    }
}

/// Real quadratic form of a complex vector, for a symmetric matrix.
fn hermitian(a: &SquareMatrix, x: &[Complex<f64>]) -> f64 {
    let mut sum = 0.0;
    for (i, xi) in x.iter().enumerate() {
        let row = a.row(i).iter().zip(x);
        let along: Complex<f64> = row.map(|(a, x)| x * *a).sum();
        sum += xi.re * along.re + xi.im * along.im;
    }
    sum
}
