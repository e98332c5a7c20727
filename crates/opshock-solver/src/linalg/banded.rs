//! Banded matrices and their LU factorisation on a fixed pattern.
//!
//! ```text
//! A = L U,   a_ij = 0 for |i − j| > b
//! ```
//!
//! Rows are eliminated without exchanges, so the pattern of L + U is the band itself and a
//! factorisation allocates nothing. That is safe for the matrices it is meant for: the flux
//! Jacobian of a conservative, monotone scheme is diagonally dominant by columns (what leaves one
//! cell enters its neighbours), and for such a matrix no multiplier exceeds one (Golub and Van
//! Loan, *Matrix Computations*, 4th ed., theorem 4.1.2). Where a linearisation strays from that,
//! [`BandedLu::factor`] sees the multipliers grow and refuses, and the caller may turn to a
//! pivoting factorisation.
//!
//! Four pivots are eliminated together, so that a row below is read and written once for four
//! multiply-subtract sweeps over contiguous slices.

use super::triangles::Triangles;
use crate::lanes::{Kernel, widest};
use thiserror::Error;

/// Pivots eliminated together.
const BLOCK: usize = 4;

/// Largest multiplier a factorisation without row exchanges may produce. Errors of a solution
/// grow with it; at this value about ten of sixteen digits remain.
const LARGEST_MULTIPLIER: f64 = 1e5;

/// Why a banded factorisation stopped.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum BandedError {
    /// A pivot is zero or not finite.
    #[error("pivot {row} of the banded matrix is {value:e}")]
    Pivot {
        /// Row of the pivot.
        row: usize,
        /// Its value.
        value: f64,
    },
    /// Multipliers grew so far that the solution could not be trusted.
    #[error("multipliers of the banded factorisation grew to {largest:e}")]
    Growth {
        /// Largest multiplier.
        largest: f64,
    },
}

/// Square banded matrix, rows stored one after the other, 2 b + 1 entries each.
#[derive(Clone, Debug, PartialEq)]
pub struct BandMatrix {
    n: usize,
    half_bandwidth: usize,
    entries: Vec<f64>,
}

impl BandMatrix {
    /// Zero matrix of `n` rows with entries where |i − j| <= `half_bandwidth`.
    pub fn zeros(n: usize, half_bandwidth: usize) -> Self {
        Self {
            n,
            half_bandwidth,
            entries: vec![0.0; n * (2 * half_bandwidth + 1)],
        }
    }

    /// Number of rows.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Entries on either side of the diagonal.
    pub fn half_bandwidth(&self) -> usize {
        self.half_bandwidth
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.entries.fill(0.0);
    }

    /// Entry (i, j); zero outside the band.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        if i.abs_diff(j) > self.half_bandwidth {
            0.0
        } else {
            self.entries[self.index(i, j)]
        }
    }

    /// Adds `value` to entry (i, j).
    ///
    /// # Panics
    ///
    /// When (i, j) lies outside the matrix; entries outside the band must not be given.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let index = self.index(i, j);
        self.entries[index] += value;
    }

    /// Aᵀ.
    pub fn transposed(&self) -> Self {
        let mut out = Self::zeros(self.n, self.half_bandwidth);
        for i in 0..self.n {
            let last = (i + self.half_bandwidth).min(self.n - 1);
            for j in i.saturating_sub(self.half_bandwidth)..=last {
                let index = out.index(j, i);
                out.entries[index] = self.entries[self.index(i, j)];
            }
        }
        out
    }

    /// out = A x.
    pub fn multiply(&self, x: &[f64], out: &mut [f64]) {
        assert_eq!(x.len(), self.n);
        assert_eq!(out.len(), self.n);
        let b = self.half_bandwidth;
        for (i, out_i) in out.iter_mut().enumerate() {
            let first = i.saturating_sub(b);
            let last = (i + b).min(self.n - 1);
            let row = &self.entries[self.index(i, first)..=self.index(i, last)];
            *out_i = row.iter().zip(&x[first..=last]).map(|(a, x)| a * x).sum();
        }
    }

    #[inline]
    fn index(&self, i: usize, j: usize) -> usize {
        debug_assert!(i.abs_diff(j) <= self.half_bandwidth);
        i * (2 * self.half_bandwidth + 1) + (j + self.half_bandwidth - i)
    }
}

/// LU factors of a [`BandMatrix`] plus a diagonal, in storage allocated once.
#[derive(Clone, Debug)]
pub struct BandedLu {
    n: usize,
    /// Rows rounded up to a multiple of [`BLOCK`]; the extra ones are rows of the identity.
    n_padded: usize,
    half_bandwidth: usize,
    /// Entries of a row: the band, and BLOCK − 1 zeros on either side so that the four pivot rows
    /// of a block can be swept over the same columns.
    stride: usize,
    rows: Vec<f64>,
    inverse_pivots: Vec<f64>,
    triangles: Triangles,
}

impl BandedLu {
    /// Storage for matrices of `n` rows and half bandwidth `half_bandwidth`.
    pub fn new(n: usize, half_bandwidth: usize) -> Self {
        let n_padded = n.next_multiple_of(BLOCK);
        let stride = 2 * (half_bandwidth + BLOCK - 1) + 1;
        Self {
            n,
            n_padded,
            half_bandwidth,
            stride,
            rows: vec![0.0; n_padded * stride],
            inverse_pivots: vec![1.0; n_padded],
            triangles: Triangles::new(n, half_bandwidth),
        }
    }

    /// Number of rows.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Factors `matrix` + `scale` diag(`diagonal`).
    ///
    /// # Errors
    ///
    /// [`BandedError`] when a pivot vanishes or the multipliers grow beyond use; the factors are
    /// then worthless.
    ///
    /// # Panics
    ///
    /// When sizes differ from those given to [`BandedLu::new`].
    pub fn factor(
        &mut self,
        matrix: &BandMatrix,
        scale: f64,
        diagonal: &[f64],
    ) -> Result<(), BandedError> {
        assert_eq!(matrix.n, self.n);
        assert_eq!(matrix.half_bandwidth, self.half_bandwidth);
        assert_eq!(diagonal.len(), self.n);
        widest(Factor {
            lu: self,
            matrix,
            scale,
            diagonal,
        })
    }

    #[inline(always)]
    fn factor_here(
        &mut self,
        matrix: &BandMatrix,
        scale: f64,
        diagonal: &[f64],
    ) -> Result<(), BandedError> {
        self.load(matrix, scale, diagonal);
        let reach = self.half_bandwidth + BLOCK - 1;
        let mut largest: f64 = 0.0;
        for first in (0..self.n_padded).step_by(BLOCK) {
            largest = largest.max(self.factor_block(first)?);
            let last = (first + reach).min(self.n_padded - 1);
            largest = largest.max(self.eliminate_below(first, last));
        }
        // A NaN anywhere above shows as a pivot; growth is what is left to judge.
        if largest > LARGEST_MULTIPLIER {
            return Err(BandedError::Growth { largest });
        }
        // Row i holds its columns i − b ... i + b after BLOCK − 1 zeros.
        let (rows, stride) = (&self.rows, self.stride);
        self.triangles.take(
            |i| &rows[i * stride + BLOCK - 1..(i + 1) * stride - (BLOCK - 1)],
            &self.inverse_pivots,
        );
        Ok(())
    }

    /// Solves A x = `rhs` in place.
    ///
    /// # Panics
    ///
    /// When `rhs` has not n entries.
    pub fn solve(&self, rhs: &mut [f64]) {
        self.triangles.solve(rhs);
    }

    /// Solves for `K` right-hand sides at once; entry i of `rhs` holds row i of all of them.
    ///
    /// # Panics
    ///
    /// When `rhs` has not n entries.
    pub fn solve_columns<const K: usize>(&self, rhs: &mut [[f64; K]]) {
        self.triangles.solve_columns(rhs);
    }

    /// Copies the matrix into the padded rows.
    #[inline(always)]
    fn load(&mut self, matrix: &BandMatrix, scale: f64, diagonal: &[f64]) {
        let b = self.half_bandwidth;
        let centre = b + BLOCK - 1;
        for (i, row) in self.rows.chunks_exact_mut(self.stride).enumerate() {
            row.fill(0.0);
            if i < self.n {
                let source = &matrix.entries[i * (2 * b + 1)..(i + 1) * (2 * b + 1)];
                row[BLOCK - 1..BLOCK + 2 * b].copy_from_slice(source);
                row[centre] += scale * diagonal[i];
            } else {
                row[centre] = 1.0;
            }
        }
    }

    /// Index of column `first` of the block in row `row`.
    #[inline]
    fn start(&self, row: usize, first: usize) -> usize {
        row * self.stride + (first + self.half_bandwidth + BLOCK - 1 - row)
    }

    /// Eliminates the block of pivots `first..first + BLOCK` among its own rows;
    /// largest multiplier.
    #[inline(always)]
    fn factor_block(&mut self, first: usize) -> Result<f64, BandedError> {
        let mut largest: f64 = 0.0;
        let width = self.half_bandwidth + BLOCK;
        for p in 0..BLOCK {
            let row = first + p;
            let (above, below) = self.rows.split_at_mut(row * self.stride);
            let offset = first + self.half_bandwidth + BLOCK - 1;
            let target = &mut below[offset - row..offset - row + width];
            for q in 0..p {
                let source_start = (first + q) * self.stride + offset - (first + q);
                let source = &above[source_start..source_start + width];
                let multiplier = target[q] * self.inverse_pivots[first + q];
                target[q] = multiplier;
                largest = largest.max(multiplier.abs());
                for (t, s) in target[q + 1..].iter_mut().zip(&source[q + 1..]) {
                    *t -= multiplier * s;
                }
            }
            let pivot = target[p];
            let inverse = 1.0 / pivot;
            if pivot == 0.0 || !inverse.is_finite() || !pivot.is_finite() {
                return Err(BandedError::Pivot { row, value: pivot });
            }
            self.inverse_pivots[row] = inverse;
        }
        Ok(largest)
    }

    /// Eliminates the block's columns from the rows below it, up to `last`; largest multiplier.
    #[inline(always)]
    fn eliminate_below(&mut self, first: usize, last: usize) -> f64 {
        let width = self.half_bandwidth + BLOCK;
        let starts: [usize; BLOCK] = std::array::from_fn(|p| self.start(first + p, first));
        let inverse: [f64; BLOCK] = std::array::from_fn(|p| self.inverse_pivots[first + p]);
        let offset = first + self.half_bandwidth + BLOCK - 1;
        let (above, below) = self.rows.split_at_mut((first + BLOCK) * self.stride);
        let [u0, u1, u2, u3]: [&[f64]; BLOCK] =
            std::array::from_fn(|p| &above[starts[p]..starts[p] + width]);
        let mut largest: f64 = 0.0;
        for (k, row) in below.chunks_exact_mut(self.stride).enumerate() {
            let i = first + BLOCK + k;
            if i > last {
                break;
            }
            let target = &mut row[offset - i..offset - i + width];
            let l0 = target[0] * inverse[0];
            let l1 = (target[1] - l0 * u0[1]) * inverse[1];
            let l2 = (target[2] - l0 * u0[2] - l1 * u1[2]) * inverse[2];
            let l3 = (target[3] - l0 * u0[3] - l1 * u1[3] - l2 * u2[3]) * inverse[3];
            largest = largest
                .max(l0.abs())
                .max(l1.abs())
                .max(l2.abs())
                .max(l3.abs());
            target[..BLOCK].copy_from_slice(&[l0, l1, l2, l3]);
            let tail = &mut target[BLOCK..];
            let n = tail.len();
            let (u0, u1) = (&u0[BLOCK..BLOCK + n], &u1[BLOCK..BLOCK + n]);
            let (u2, u3) = (&u2[BLOCK..BLOCK + n], &u3[BLOCK..BLOCK + n]);
            for j in 0..n {
                tail[j] -= (l0 * u0[j] + l1 * u1[j]) + (l2 * u2[j] + l3 * u3[j]);
            }
        }
        largest
    }
}

/// [`BandedLu::factor`] as a kernel.
struct Factor<'a> {
    lu: &'a mut BandedLu,
    matrix: &'a BandMatrix,
    scale: f64,
    diagonal: &'a [f64],
}

impl Kernel for Factor<'_> {
    type Output = Result<(), BandedError>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.lu.factor_here(self.matrix, self.scale, self.diagonal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Column-dominant band with entries from a fixed recurrence.
    fn sample(n: usize, b: usize) -> BandMatrix {
        let mut matrix = BandMatrix::zeros(n, b);
        let mut state: u64 = 1;
        for j in 0..n {
            let mut column = 0.0;
            for i in j.saturating_sub(b)..=(j + b).min(n - 1) {
                if i != j {
                    state = state
                        .wrapping_mul(6364136223846793005)
                        .wrapping_add(1442695040888963407);
                    let value = (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
                    matrix.add(i, j, value);
                    column += value.abs();
                }
            }
            matrix.add(j, j, 1.05 * column + 0.01);
        }
        matrix
    }

    #[test]
    fn solution_reproduces_a_known_vector_for_sizes_around_the_block() {
        for (n, b) in [(1, 0), (3, 1), (4, 2), (5, 4), (17, 3), (64, 9), (203, 23)] {
            let matrix = sample(n, b);
            let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin() + 0.2).collect();
            let diagonal: Vec<f64> = (0..n).map(|i| 1.0 + i as f64).collect();
            let mut rhs = vec![0.0; n];
            matrix.multiply(&exact, &mut rhs);
            for i in 0..n {
                rhs[i] += 0.01 * diagonal[i] * exact[i];
            }
            let mut columns: Vec<[f64; 3]> = rhs.iter().map(|&v| [v, 2.0 * v, -v]).collect();
            let mut lu = BandedLu::new(n, b);
            lu.factor(&matrix, 0.01, &diagonal).unwrap();
            lu.solve(&mut rhs);
            lu.solve_columns(&mut columns);
            for i in 0..n {
                assert!((rhs[i] - exact[i]).abs() < 1e-12, "n {n}, b {b}, row {i}");
                assert!((columns[i][1] - 2.0 * exact[i]).abs() < 1e-12);
                assert!((columns[i][2] + exact[i]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn zero_pivot_and_growth_are_refused() {
        let mut matrix = BandMatrix::zeros(2, 1);
        matrix.add(0, 1, 1.0);
        matrix.add(1, 0, 1.0);
        let mut lu = BandedLu::new(2, 1);
        assert_eq!(
            lu.factor(&matrix, 0.0, &[0.0; 2]),
            Err(BandedError::Pivot { row: 0, value: 0.0 })
        );
        matrix.add(0, 0, 1e-9);
        assert!(matches!(
            lu.factor(&matrix, 0.0, &[0.0; 2]),
            Err(BandedError::Growth { .. })
        ));
    }
}
