//! Eigenvalues and eigenvectors of small general matrices, and the rows that decompose a vector into eigenvectors.

use super::dense::DenseError;
use faer::Mat;
use faer::linalg::solvers::{DenseSolveCore, Eigen};
use nalgebra::Complex;

/// Largest gain of an eigenvector's share; above it half of the digits are lost.
const LARGEST_GAIN: f64 = 1e8;

/// A = V diag(s) V⁻¹.
#[derive(Clone, Debug)]
pub struct GeneralEigen {
    /// Eigenvalues s.
    pub values: Vec<Complex<f64>>,
    /// Eigenvectors, one per value.
    pub vectors: Vec<Vec<Complex<f64>>>,
    /// Rows of V⁻¹, one per value.
    pub inverse: Vec<Vec<Complex<f64>>>,
}

/// Decomposes the square matrix given by its `rows`. Eigenvalues are refined by Rayleigh's quotient
/// with both vectors, which keeps the digits of the small ones beside a large one. Of a real matrix
/// real eigenvalues are real to the last bit.
///
/// # Errors
///
/// No convergence, or two eigenvectors so nearly parallel that decomposing a vector loses more than half of the digits.
pub fn general_eigen(rows: &[Vec<Complex<f64>>]) -> Result<GeneralEigen, DenseError> {
    let n = rows.len();
    let failed = || DenseError::NotConverged { order: n };
    let is_real = rows.iter().flatten().all(|z| z.im == 0.0);
    let eigen = match is_real {
        true => Eigen::new_from_real(Mat::from_fn(n, n, |i, j| rows[i][j].re).as_ref()),
        false => Eigen::new(Mat::from_fn(n, n, |i, j| rows[i][j]).as_ref()),
    }
    .map_err(|_| failed())?;
    let (u, s) = (eigen.U(), eigen.S());
    let inverse = u.partial_piv_lu().inverse();
    // What a component is amplified by on its way through V⁻¹ and back.
    let gain = |k: usize| {
        let row: f64 = (0..n).map(|j| inverse[(k, j)].norm_sqr()).sum();
        let column: f64 = (0..n).map(|i| u[(i, k)].norm_sqr()).sum();
        (row * column).sqrt()
    };
    // A gain that is not a number is refused too.
    if !(0..n).all(|k| gain(k) < LARGEST_GAIN) {
        return Err(failed());
    }
    Ok(GeneralEigen {
        values: (0..n)
            .map(|k| {
                let row =
                    |i: usize| -> Complex<f64> { (0..n).map(|j| rows[i][j] * u[(j, k)]).sum() };
                let refined: Complex<f64> = (0..n).map(|i| inverse[(k, i)] * row(i)).sum();
                match is_real && s[k].im == 0.0 {
                    true => Complex::from(refined.re),
                    false => refined,
                }
            })
            .collect(),
        vectors: (0..n)
            .map(|k| (0..n).map(|i| u[(i, k)]).collect())
            .collect(),
        inverse: (0..n)
            .map(|k| (0..n).map(|j| inverse[(k, j)]).collect())
            .collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Companion matrix of a polynomial: its eigenvalues are the roots.
    fn companion(roots: &[Complex<f64>]) -> Vec<Vec<Complex<f64>>> {
        let mut polynomial = vec![Complex::from(1.0)];
        for root in roots {
            let mut next = vec![Complex::from(0.0); polynomial.len() + 1];
            for (k, c) in polynomial.iter().enumerate() {
                next[k] += c;
                next[k + 1] -= c * root;
            }
            polynomial = next;
        }
        let n = roots.len();
        let mut rows = vec![vec![Complex::from(0.0); n]; n];
        for j in 0..n {
            rows[0][j] = -polynomial[j + 1];
        }
        for i in 1..n {
            rows[i][i - 1] = Complex::from(1.0);
        }
        rows
    }

    #[test]
    fn roots_of_a_polynomial_are_found_real_and_complex() {
        let z = Complex::new;
        for roots in [
            vec![z(-1.0, 0.0), z(-0.1, 3.0), z(-0.1, -3.0), z(-4.0, 0.0)],
            vec![z(-1.0, 0.5), z(-0.1, 3.0), z(-0.2, -2.0)],
        ] {
            let eigen = general_eigen(&companion(&roots)).unwrap();
            for root in &roots {
                let near = eigen.values.iter().map(|s| (s - root).norm());
                assert!(near.fold(f64::MAX, f64::min) < 1e-13);
            }
            for (k, row) in eigen.inverse.iter().enumerate() {
                for (l, vector) in eigen.vectors.iter().enumerate() {
                    let product: Complex<f64> = row.iter().zip(vector).map(|(a, b)| a * b).sum();
                    let wanted = f64::from(u8::from(k == l));
                    assert!((product - wanted).norm() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn a_matrix_without_enough_eigenvectors_is_refused() {
        let z = |x: f64| Complex::from(x);
        let rows = vec![vec![z(-1.0), z(1.0)], vec![z(0.0), z(-1.0)]];
        assert!(general_eigen(&rows).is_err());
    }
}
