//! Banded matrices and their LU factorisation on a fixed pattern.
//!
//! ```text
//! A = L U,   a_ij = 0 for i − j > below and for j − i > above
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

use super::triangles::{Entry, Triangles};
use crate::lanes::{Simd, WithSimd, widest};
use thiserror::Error;

/// Pivots eliminated together.
const BLOCK: usize = 4;

/// Columns swept together: rows are swept in whole sets of so many.
const SET: usize = 8;

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

/// How far a matrix reaches on either side of its diagonal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Band {
    /// Entries of a row before the diagonal.
    pub below: usize,
    /// Entries of a row behind the diagonal.
    pub above: usize,
}

impl Band {
    /// As far on either side.
    pub fn even(half_bandwidth: usize) -> Self {
        Self {
            below: half_bandwidth,
            above: half_bandwidth,
        }
    }

    /// As far to the other side.
    fn reversed(self) -> Self {
        Self {
            below: self.above,
            above: self.below,
        }
    }

    /// Entries of a row.
    pub(super) fn width(self) -> usize {
        self.below + 1 + self.above
    }

    fn holds(self, i: usize, j: usize) -> bool {
        i <= j + self.below && j <= i + self.above
    }

    /// Columns of row `i` of `n`, first and last.
    fn columns(self, i: usize, n: usize) -> std::ops::RangeInclusive<usize> {
        i.saturating_sub(self.below)..=(i + self.above).min(n - 1)
    }
}

/// Square banded matrix, rows stored one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct BandMatrix {
    n: usize,
    band: Band,
    entries: Vec<f64>,
}

impl BandMatrix {
    /// Zero matrix of `n` rows with entries in `band`.
    pub fn zeros(n: usize, band: Band) -> Self {
        Self {
            n,
            band,
            entries: vec![0.0; n * band.width()],
        }
    }

    /// Number of rows.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Entries on either side of the diagonal.
    pub fn band(&self) -> Band {
        self.band
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.entries.fill(0.0);
    }

    /// Rows one after the other: entry (i, j) stands at place j + below − i of row i. Places outside
    /// the matrix must stay zero.
    pub fn rows_mut(&mut self) -> std::slice::ChunksExactMut<'_, f64> {
        self.entries.chunks_exact_mut(self.band.width())
    }

    /// Entry (i, j); zero outside the band.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        if self.band.holds(i, j) {
            self.entries[self.index(i, j)]
        } else {
            0.0
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
        let mut out = Self::zeros(self.n, self.band.reversed());
        for i in 0..self.n {
            for j in self.band.columns(i, self.n) {
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
        for (i, out_i) in out.iter_mut().enumerate() {
            let columns = self.band.columns(i, self.n);
            let row =
                &self.entries[self.index(i, *columns.start())..=self.index(i, *columns.end())];
            *out_i = row.iter().zip(&x[columns]).map(|(a, x)| a * x).sum();
        }
    }

    #[inline]
    fn index(&self, i: usize, j: usize) -> usize {
        debug_assert!(self.band.holds(i, j));
        i * self.band.width() + (j + self.band.below - i)
    }
}

/// LU factors of a [`BandMatrix`] plus a diagonal, in storage allocated once. They are found in
/// double precision and kept for solving as `E`: a solution with `f32` is right to some 1e-7 of its
/// largest number and reads half the memory.
#[derive(Clone, Debug)]
pub struct BandedLu<E = f64> {
    n: usize,
    /// Rows rounded up to a multiple of [`BLOCK`]; the extra ones are rows of the identity.
    n_padded: usize,
    /// Band of what is factored: of the matrix, or of the matrix with rows and columns counted from
    /// the end, whichever reaches less far below. Then fewer rows are swept, over more columns.
    band: Band,
    is_reversed: bool,
    /// Entries of a row: the band, and zeros on either side so that the four pivot rows of a block
    /// can be swept over the same columns, in whole sets: BLOCK − 1 before, SET − 1 more behind.
    stride: usize,
    rows: Vec<f64>,
    inverse_pivots: Vec<f64>,
    triangles: Triangles<E>,
}

impl<E: Entry> BandedLu<E> {
    /// Storage for matrices of `n` rows with entries in `band`.
    pub fn new(n: usize, band: Band) -> Self {
        let n_padded = n.next_multiple_of(BLOCK);
        let is_reversed = band.below > band.above;
        let band = if is_reversed { band.reversed() } else { band };
        let stride = band.width() + 2 * (BLOCK - 1) + SET - 1;
        Self {
            n,
            n_padded,
            band,
            is_reversed,
            stride,
            rows: vec![0.0; n_padded * stride],
            inverse_pivots: vec![1.0; n_padded],
            triangles: Triangles::new(n, band),
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
        let band = if self.is_reversed {
            self.band.reversed()
        } else {
            self.band
        };
        assert_eq!(matrix.band, band);
        assert_eq!(diagonal.len(), self.n);
        widest(Factor {
            lu: self,
            matrix,
            scale,
            diagonal,
        })
    }

    #[inline(always)]
    fn factor_here<S: Simd>(
        &mut self,
        simd: S,
        matrix: &BandMatrix,
        scale: f64,
        diagonal: &[f64],
    ) -> Result<(), BandedError> {
        self.load(matrix, scale, diagonal);
        let reach = self.band.below + BLOCK - 1;
        let mut largest: f64 = 0.0;
        for first in (0..self.n_padded).step_by(BLOCK) {
            largest = largest.max(self.factor_block(first)?);
            let last = (first + reach).min(self.n_padded - 1);
            largest = largest.max(self.eliminate_below(simd, first, last));
        }
        // A NaN anywhere above shows as a pivot; growth is what is left to judge.
        if largest > LARGEST_MULTIPLIER {
            return Err(BandedError::Growth { largest });
        }
        let (rows, stride, width) = (&self.rows, self.stride, self.band.width());
        self.triangles.take(
            simd,
            |i| &rows[i * stride + BLOCK - 1..][..width],
            &self.inverse_pivots,
        );
        Ok(())
    }

    /// Solves A x = `rhs` in place.
    ///
    /// # Panics
    ///
    /// When `rhs` has not n entries.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        self.triangles.solve(rhs, self.is_reversed);
    }

    /// Copies the matrix into the padded rows.
    #[inline(always)]
    fn load(&mut self, matrix: &BandMatrix, scale: f64, diagonal: &[f64]) {
        let width = self.band.width();
        let centre = self.centre();
        for (i, row) in self.rows.chunks_exact_mut(self.stride).enumerate() {
            row.fill(0.0);
            if i < self.n {
                let at = if self.is_reversed { self.n - 1 - i } else { i };
                let own = &mut row[BLOCK - 1..BLOCK - 1 + width];
                own.copy_from_slice(&matrix.entries[at * width..(at + 1) * width]);
                if self.is_reversed {
                    own.reverse();
                }
                row[centre] += scale * diagonal[at];
            } else {
                row[centre] = 1.0;
            }
        }
    }

    /// Where the diagonal stands in a row.
    #[inline]
    fn centre(&self) -> usize {
        self.band.below + BLOCK - 1
    }

    /// Index of column `first` of the block in row `row`.
    #[inline]
    fn start(&self, row: usize, first: usize) -> usize {
        row * self.stride + (first + self.centre() - row)
    }

    /// Eliminates the block of pivots `first..first + BLOCK` among its own rows;
    /// largest multiplier.
    #[inline(always)]
    fn factor_block(&mut self, first: usize) -> Result<f64, BandedError> {
        let mut largest: f64 = 0.0;
        let width = self.band.above + BLOCK;
        for p in 0..BLOCK {
            let row = first + p;
            let offset = first + self.centre();
            let (above, below) = self.rows.split_at_mut(row * self.stride);
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
    fn eliminate_below<S: Simd>(&mut self, simd: S, first: usize, last: usize) -> f64 {
        let width = BLOCK + self.band.above.next_multiple_of(SET);
        let starts: [usize; BLOCK] = std::array::from_fn(|p| self.start(first + p, first));
        let inverse: [f64; BLOCK] = std::array::from_fn(|p| self.inverse_pivots[first + p]);
        let offset = first + self.centre();
        let (above, below) = self.rows.split_at_mut((first + BLOCK) * self.stride);
        let pivot_rows: [&[f64]; BLOCK] =
            std::array::from_fn(|p| &above[starts[p]..starts[p] + width]);
        let [p0, p1, p2, _] = pivot_rows;
        let [u0, u1, u2, u3] = pivot_rows.map(|row| S::as_simd_f64s(&row[BLOCK..]).0);
        let mut largest: f64 = 0.0;
        for (k, row) in below.chunks_exact_mut(self.stride).enumerate() {
            let i = first + BLOCK + k;
            if i > last {
                break;
            }
            let target = &mut row[offset - i..offset - i + width];
            let l0 = target[0] * inverse[0];
            let l1 = (target[1] - l0 * p0[1]) * inverse[1];
            let l2 = (target[2] - l0 * p0[2] - l1 * p1[2]) * inverse[2];
            let l3 = (target[3] - l0 * p0[3] - l1 * p1[3] - l2 * p2[3]) * inverse[3];
            largest = largest
                .max(l0.abs())
                .max(l1.abs())
                .max(l2.abs())
                .max(l3.abs());
            target[..BLOCK].copy_from_slice(&[l0, l1, l2, l3]);
            let [l0, l1, l2, l3] = [l0, l1, l2, l3].map(|l| simd.splat_f64s(l));
            let tail = S::as_mut_simd_f64s(&mut target[BLOCK..]).0.iter_mut();
            for ((((t, u0), u1), u2), u3) in tail.zip(u0).zip(u1).zip(u2).zip(u3) {
                let a = simd.add_f64s(simd.mul_f64s(l0, *u0), simd.mul_f64s(l1, *u1));
                let b = simd.add_f64s(simd.mul_f64s(l2, *u2), simd.mul_f64s(l3, *u3));
                *t = simd.sub_f64s(*t, simd.add_f64s(a, b));
            }
        }
        largest
    }
}

/// [`BandedLu::factor`] as a kernel.
struct Factor<'a, E> {
    lu: &'a mut BandedLu<E>,
    matrix: &'a BandMatrix,
    scale: f64,
    diagonal: &'a [f64],
}

impl<E: Entry> WithSimd for Factor<'_, E> {
    type Output = Result<(), BandedError>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        self.lu
            .factor_here(simd, self.matrix, self.scale, self.diagonal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Column-dominant band with entries from a fixed recurrence.
    fn sample(n: usize, band: Band) -> BandMatrix {
        let mut matrix = BandMatrix::zeros(n, band);
        let mut state: u64 = 1;
        for j in 0..n {
            let mut column = 0.0;
            for i in j.saturating_sub(band.above)..=(j + band.below).min(n - 1) {
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
        for (n, below, above) in [
            (1, 0, 0),
            (3, 1, 1),
            (4, 2, 2),
            (5, 4, 4),
            (17, 3, 3),
            (64, 9, 9),
            (203, 23, 23),
            (5, 4, 1),
            (17, 6, 3),
            (64, 3, 18),
            (203, 46, 23),
            (40, 12, 0),
        ] {
            let band = Band { below, above };
            let matrix = sample(n, band);
            let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin() + 0.2).collect();
            let diagonal: Vec<f64> = (0..n).map(|i| 1.0 + i as f64).collect();
            let mut rhs = vec![0.0; n];
            matrix.multiply(&exact, &mut rhs);
            for i in 0..n {
                rhs[i] += 0.01 * diagonal[i] * exact[i];
            }
            let mut lu = BandedLu::<f64>::new(n, band);
            lu.factor(&matrix, 0.01, &diagonal).unwrap();
            lu.solve(&mut rhs);
            for i in 0..n {
                assert!(
                    (rhs[i] - exact[i]).abs() < 1e-12,
                    "n {n}, {band:?}, row {i}"
                );
            }
        }
    }

    #[test]
    fn zero_pivot_and_growth_are_refused() {
        let mut matrix = BandMatrix::zeros(2, Band::even(1));
        matrix.add(0, 1, 1.0);
        matrix.add(1, 0, 1.0);
        let mut lu = BandedLu::<f64>::new(2, Band::even(1));
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
