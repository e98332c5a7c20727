//! Small dense symmetric matrices: Cholesky factorisation, generalised eigenvalue problem.
//!
//! ```text
//! K x = ω² M x
//! ```
//!
//! Two reductions to a standard problem, because each is accurate at one end of the spectrum:
//! with K = L Lᵀ the problem L⁻¹ M L⁻ᵀ y = ω⁻² y has the **lowest** ω as its largest eigenvalues
//! and so keeps their digits however fine the mesh is; with M = L Lᵀ a singular K is allowed.

use faer::{Mat, Side};

/// Square matrix, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct SquareMatrix {
    n: usize,
    entries: Vec<f64>,
}

/// Eigenvalues in rising order and their vectors.
#[derive(Clone, Debug)]
pub struct EigenPairs {
    /// ω² (generalised problem) in rising order.
    pub values: Vec<f64>,
    /// One vector per value, xᵀ M x = 1.
    pub vectors: Vec<Vec<f64>>,
}

/// Why a dense problem has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DenseError {
    /// A pivot of the Cholesky factorisation is not positive.
    #[error("matrix is not positive definite: pivot {pivot} is {value:e}")]
    NotPositiveDefinite {
        /// Row of the pivot.
        pivot: usize,
        /// Its value.
        value: f64,
    },
    /// The eigenvalue iteration did not converge.
    #[error("eigenvalue iteration did not converge for a matrix of order {order}")]
    NotConverged {
        /// Order of the matrix.
        order: usize,
    },
}

impl SquareMatrix {
    /// Zero matrix of order `n`.
    pub fn zeros(n: usize) -> Self {
        Self {
            n,
            entries: vec![0.0; n * n],
        }
    }

    /// Order.
    pub fn order(&self) -> usize {
        self.n
    }

    /// Entry in row `i`, column `j`.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.entries[i * self.n + j]
    }

    /// Adds to the entry in row `i`, column `j`.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        self.entries[i * self.n + j] += value;
    }

    /// Row `i`.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.entries[i * self.n..(i + 1) * self.n]
    }

    /// A x.
    ///
    /// # Panics
    /// When `x` is not as long as the matrix.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        assert_eq!(x.len(), self.n);
        (0..self.n).map(|i| dot(self.row(i), x)).collect()
    }

    /// xᵀ A y.
    pub fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        dot(x, &self.times(y))
    }

    /// Lower factor L of A = L Lᵀ; reads the lower triangle.
    ///
    /// # Errors
    /// [`DenseError::NotPositiveDefinite`] with the pivot.
    pub fn cholesky(&self) -> Result<CholeskyFactor, DenseError> {
        let n = self.n;
        let mut l = Self::zeros(n);
        let mut first = Vec::with_capacity(n);
        for i in 0..n {
            let start = (0..i).find(|&j| self.get(i, j) != 0.0).unwrap_or(i);
            first.push(start);
            for (j, &first_of_j) in first.iter().enumerate().skip(start) {
                let from = start.max(first_of_j);
                let sum = self.get(i, j) - dot(&l.row(i)[from..j], &l.row(j)[from..j]);
                if i == j {
                    // A pivot that is not a number is refused too.
                    if sum.is_nan() || sum <= 0.0 {
                        return Err(DenseError::NotPositiveDefinite {
                            pivot: i,
                            value: sum,
                        });
                    }
                    l.entries[i * n + i] = sum.sqrt();
                } else {
                    l.entries[i * n + j] = sum / l.get(j, j);
                }
            }
        }
        Ok(CholeskyFactor { lower: l, first })
    }

    /// Eigenvalues in rising order, orthonormal vectors.
    ///
    /// # Errors
    /// [`DenseError::NotConverged`].
    pub fn symmetric_eigen(&self) -> Result<EigenPairs, DenseError> {
        let n = self.n;
        let a = Mat::from_fn(n, n, |i, j| self.get(i, j));
        let eigen = a
            .self_adjoint_eigen(Side::Lower)
            .map_err(|_| DenseError::NotConverged { order: n })?;
        let (u, s) = (eigen.U(), eigen.S());
        Ok(EigenPairs {
            values: (0..n).map(|k| s[k]).collect(),
            vectors: (0..n)
                .map(|k| (0..n).map(|i| u[(i, k)]).collect())
                .collect(),
        })
    }
}

/// Lower triangular factor of a positive definite matrix.
///
/// Left of a row's first entry the factor is zero as the matrix is (its profile), so that a banded
/// matrix costs what its band costs.
#[derive(Clone, Debug)]
pub struct CholeskyFactor {
    lower: SquareMatrix,
    /// Column of the first entry of every row.
    first: Vec<usize>,
}

impl CholeskyFactor {
    /// x := L⁻¹ x.
    pub fn solve_lower(&self, x: &mut [f64]) {
        // Nothing moves above the first entry of x.
        let start = x.iter().position(|&v| v != 0.0).unwrap_or(x.len());
        for i in start..self.lower.n {
            let (row, from) = (self.lower.row(i), self.first[i]);
            x[i] = (x[i] - dot(&row[from..i], &x[from..i])) / row[i];
        }
    }

    /// x := L⁻ᵀ x.
    pub fn solve_upper(&self, x: &mut [f64]) {
        for i in (0..self.lower.n).rev() {
            let (row, from) = (self.lower.row(i), self.first[i]);
            x[i] /= row[i];
            let xi = x[i];
            for (xj, lij) in x[from..i].iter_mut().zip(&row[from..i]) {
                *xj -= lij * xi;
            }
        }
    }

    /// x := A⁻¹ x.
    pub fn solve(&self, x: &mut [f64]) {
        self.solve_lower(x);
        self.solve_upper(x);
    }

    /// L⁻¹ B L⁻ᵀ for symmetric B, made exactly symmetric.
    fn congruence(&self, b: &SquareMatrix) -> SquareMatrix {
        let n = b.n;
        // Rows of B are its columns: Y = (L⁻¹ B)ᵀ row by row, then L⁻¹ Yᵀ the same way.
        let mut y = b.clone();
        for i in 0..n {
            self.solve_lower(&mut y.entries[i * n..(i + 1) * n]);
        }
        let mut z = SquareMatrix::zeros(n);
        let mut column = vec![0.0; n];
        for j in 0..n {
            for (i, c) in column.iter_mut().enumerate() {
                *c = y.get(i, j);
            }
            self.solve_lower(&mut column);
            z.entries[j * n..(j + 1) * n].copy_from_slice(&column);
        }
        for i in 0..n {
            for j in 0..i {
                let mean = 0.5 * (z.get(i, j) + z.get(j, i));
                z.entries[i * n + j] = mean;
                z.entries[j * n + i] = mean;
            }
        }
        z
    }
}

/// The lowest pairs of K x = ω² M x for positive definite K, accurate at the low end. `n_keep` receives every ω² in
/// rising order and returns how many pairs are wanted.
///
/// # Errors
/// K not positive definite, or no convergence.
pub fn lowest_modes(
    stiffness: &SquareMatrix,
    mass: &SquareMatrix,
    n_keep: impl FnOnce(&[f64]) -> usize,
) -> Result<EigenPairs, DenseError> {
    let factor = stiffness.cholesky()?;
    let pairs = factor.congruence(mass).symmetric_eigen()?;
    // A mass matrix with massless directions ends the finite spectrum.
    let finite = pairs.values.iter().rev().take_while(|&&mu| mu > 0.0);
    let mut values: Vec<f64> = finite.map(|mu| mu.recip()).collect();
    values.truncate(n_keep(&values));
    let mut vectors: Vec<Vec<f64>> = pairs.vectors.into_iter().rev().take(values.len()).collect();
    for (x, mu) in vectors.iter_mut().zip(pairs.values.iter().rev()) {
        factor.solve_upper(x);
        let scale = mu.sqrt().recip();
        x.iter_mut().for_each(|c| *c *= scale);
    }
    Ok(EigenPairs { values, vectors })
}

/// All pairs of K x = ω² M x for positive definite M; K may be singular.
///
/// # Errors
/// M not positive definite, or no convergence.
pub fn modes_of_free_body(
    stiffness: &SquareMatrix,
    mass: &SquareMatrix,
) -> Result<EigenPairs, DenseError> {
    let factor = mass.cholesky()?;
    let mut pairs = factor.congruence(stiffness).symmetric_eigen()?;
    for x in &mut pairs.vectors {
        factor.solve_upper(x);
    }
    Ok(pairs)
}

/// Sum of products, term after term.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// n unit masses in a row on unit springs, the first fixed to a wall, the last one also when `is_held_twice`.
    pub(in crate::linalg) fn chain(n: usize, is_held_twice: bool) -> (SquareMatrix, SquareMatrix) {
        let (mut k, mut m) = (SquareMatrix::zeros(n), SquareMatrix::zeros(n));
        for i in 0..n {
            let springs = if i + 1 < n || is_held_twice { 2.0 } else { 1.0 };
            m.add(i, i, 1.0);
            k.add(i, i, springs);
            if i > 0 {
                k.add(i, i - 1, -1.0);
                k.add(i - 1, i, -1.0);
            }
        }
        (k, m)
    }

    #[test]
    fn both_reductions_give_the_modes_of_a_chain_of_masses() {
        let n = 40;
        let (k, m) = chain(n, true);
        let low = lowest_modes(&k, &m, |_| 5).unwrap();
        let all = modes_of_free_body(&k, &m).unwrap();
        assert_eq!(low.values.len(), 5);
        for j in 0..5 {
            let angle = std::f64::consts::PI * (j + 1) as f64 / (2.0 * (n + 1) as f64);
            let exact = 4.0 * angle.sin().powi(2);
            assert!((low.values[j] / exact - 1.0).abs() < 1e-13);
            assert!((all.values[j] / exact - 1.0).abs() < 1e-11);
            let x = &low.vectors[j];
            assert!((m.form(x, x) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn an_indefinite_matrix_is_refused_with_its_pivot() {
        let (mut k, m) = chain(4, true);
        k.add(2, 2, -3.0);
        assert!(matches!(
            lowest_modes(&k, &m, |_| 2),
            Err(DenseError::NotPositiveDefinite { pivot: 2, .. })
        ));
    }
}
