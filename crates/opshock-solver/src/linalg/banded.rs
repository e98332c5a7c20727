//! LU factorisation of banded matrices on a fixed pattern.
//!
//! ```text
//! A = L U,   a_ij = 0 for i − j > below and for j − i > above
//! ```
//!
//! Rows are eliminated without exchanges, so the pattern of L + U is the band itself and a
//! factorisation allocates nothing. That is safe for the matrices it is meant for: the flux Jacobian of a conservative,
//! monotone scheme is diagonally dominant by columns (what leaves one cell enters its neighbours), and for such a
//! matrix no multiplier exceeds one (Golub and Van Loan, *Matrix Computations*, 4th ed., theorem 4.1.2). Where a
//! linearisation is far from that, [`BandedLu::factor`] finds that the multipliers grow and refuses; the caller may
//! then use a pivoting factorisation.
//!
//! Four pivots are eliminated together from four rows below: those rows are read and written once for four
//! multiply-subtract sweeps, the pivots' rows once for four rows.

use super::diagonals::{Band, Diagonals};
pub use super::entry::Entry;
use super::triangles::Triangles;
use crate::lanes::{Simd, WithSimd, widest};
use thiserror::Error;

/// Pivots eliminated together.
const BLOCK: usize = 4;

/// Rows a matrix is copied into at a time.
const ROWS_LOADED: usize = 16;

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

/// LU factors of the sum of two matrices of few diagonals, in storage allocated once. They are computed and kept as
/// `E`: with `f32` a solution has an error of some 1e-6 of its largest number (more where multipliers are large), for
/// half the memory and half the time.
#[derive(Clone, Debug)]
pub struct BandedLu<E = f64> {
    n: usize,
    /// Rows rounded up to a multiple of [`BLOCK`]; the extra ones are rows of the identity.
    n_padded: usize,
    /// Band of the factored matrix: the given one, or that with rows and columns in reverse order if it reaches less
    /// far below. Then fewer rows are swept, over more columns.
    band: Band,
    is_reversed: bool,
    /// Entries of a row: the band, and zeros on either side so that the four pivot rows of a block
    /// can be swept over the same columns, in whole sets of registers: BLOCK − 1 before, SET − 1 more behind.
    stride: usize,
    rows: Vec<E>,
    inverse_pivots: Vec<E>,
    triangles: Triangles<E>,
}

impl<E: Entry> BandedLu<E> {
    /// Storage for matrices of `n` rows with entries in `band`.
    pub fn new(n: usize, band: Band) -> Self {
        let n_padded = n.next_multiple_of(BLOCK);
        let is_reversed = band.below > band.above;
        let band = if is_reversed { band.reversed() } else { band };
        let stride = band.width() + 2 * (BLOCK - 1) + E::SET - 1;
        Self {
            n,
            n_padded,
            band,
            is_reversed,
            stride,
            rows: vec![E::ZERO; n_padded * stride],
            inverse_pivots: vec![E::ONE; n_padded],
            triangles: Triangles::new(n, band),
        }
    }

    /// Number of rows.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Factors `matrix` + `scale` `more`, which has no diagonals that `matrix` has not.
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
        matrix: &Diagonals,
        scale: f64,
        more: &Diagonals,
    ) -> Result<(), BandedError> {
        assert_eq!(matrix.n(), self.n);
        let band = if self.is_reversed {
            self.band.reversed()
        } else {
            self.band
        };
        assert_eq!(matrix.band(), band);
        assert_eq!(more.n(), self.n);
        let is_known = |offset| matrix.column(offset).is_some();
        assert!(more.offsets().iter().all(|offset| is_known(*offset)));
        widest(Factor {
            lu: self,
            matrix,
            scale,
            more,
        })
    }

    #[inline(always)]
    fn factor_here<S: Simd>(
        &mut self,
        simd: S,
        matrix: &Diagonals,
        scale: f64,
        more: &Diagonals,
    ) -> Result<(), BandedError> {
        self.load(matrix, scale, more);
        let reach = self.band.below + BLOCK - 1;
        let mut largest = E::ZERO;
        for first in (0..self.n_padded).step_by(BLOCK) {
            largest = larger(largest, self.factor_block(first)?);
            let last = (first + reach).min(self.n_padded - 1);
            largest = larger(largest, self.eliminate_below(simd, first, last));
        }
        let largest = largest.widen();
        // A NaN anywhere above shows as a pivot; only growth remains to be checked.
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

    /// Copies the matrix into the padded rows, a few rows at a time that stay in the cache.
    #[inline(always)]
    fn load(&mut self, matrix: &Diagonals, scale: f64, more: &Diagonals) {
        let (n, stride, centre, is_reversed) =
            (self.n, self.stride, self.centre(), self.is_reversed);
        let turned = |i: usize| if is_reversed { n - 1 - i } else { i };
        for (some, rows) in self.rows.chunks_mut(ROWS_LOADED * stride).enumerate() {
            rows.fill(E::ZERO);
            let first = some * ROWS_LOADED;
            let behind = (first + ROWS_LOADED).min(n);
            for (offset, column) in matrix.iter() {
                let more = more.column(offset);
                let inside = matrix.rows(offset);
                let (from, to, offset) = if is_reversed {
                    (n - inside.end, n - inside.start, -offset)
                } else {
                    (inside.start, inside.end, offset)
                };
                let place = centre.strict_add_signed(offset);
                let loaded = first.max(from)..behind.min(to);
                match more {
                    None => {
                        for i in loaded {
                            rows[(i - first) * stride + place] = E::nearest(column[turned(i)]);
                        }
                    }
                    Some(more) => {
                        for i in loaded {
                            let value = scale.mul_add(more[turned(i)], column[turned(i)]);
                            rows[(i - first) * stride + place] = E::nearest(value);
                        }
                    }
                }
            }
            for padding in rows.chunks_exact_mut(stride).skip(behind - first) {
                padding[centre] = E::ONE;
            }
        }
    }

    /// Where the diagonal stands in a row.
    #[inline]
    fn centre(&self) -> usize {
        self.band.below + BLOCK - 1
    }

    /// Eliminates the block of pivots `first..first + BLOCK` among its own rows;
    /// largest multiplier.
    #[inline(always)]
    fn factor_block(&mut self, first: usize) -> Result<E, BandedError> {
        let mut largest = E::ZERO;
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
                largest = larger(largest, multiplier);
                for (t, s) in target[q + 1..].iter_mut().zip(&source[q + 1..]) {
                    *t = s.mul_add(-multiplier, *t);
                }
            }
            let pivot = target[p];
            let inverse = pivot.recip();
            let value = pivot.widen();
            if value == 0.0 || !inverse.widen().is_finite() || !value.is_finite() {
                return Err(BandedError::Pivot { row, value });
            }
            self.inverse_pivots[row] = inverse;
        }
        Ok(largest)
    }

    /// Eliminates the block's columns from the rows below it, up to `last`; largest multiplier.
    #[inline(always)]
    fn eliminate_below<S: Simd>(&mut self, simd: S, first: usize, last: usize) -> E {
        let width = BLOCK + self.band.above.next_multiple_of(E::SET);
        let offset = first + self.centre();
        let stride = self.stride;
        let (above, below) = self.rows.split_at_mut((first + BLOCK) * stride);
        let pivots = Pivots {
            rows: std::array::from_fn(|p| {
                let start = (first + p) * stride + offset - (first + p);
                &above[start..start + width]
            }),
            inverse: std::array::from_fn(|p| self.inverse_pivots[first + p]),
        };
        let mut largest = [E::ZERO; BLOCK];
        let below = &mut below[..(last + 1 - first - BLOCK) * stride];
        let mut i = first + BLOCK;
        let mut fours = below.chunks_exact_mut(BLOCK * stride);
        for four in &mut fours {
            pivots.eliminate::<S, BLOCK>(simd, four, offset - i, &mut largest);
            i += BLOCK;
        }
        let rest = fours.into_remainder();
        match rest.len() / stride {
            3 => pivots.eliminate::<S, 3>(simd, rest, offset - i, &mut largest),
            2 => pivots.eliminate::<S, 2>(simd, rest, offset - i, &mut largest),
            1 => pivots.eliminate::<S, 1>(simd, rest, offset - i, &mut largest),
            _ => {}
        }
        largest.into_iter().fold(E::ZERO, larger)
    }
}

/// The larger size of two numbers.
#[inline(always)]
fn larger<E: Entry>(a: E, b: E) -> E {
    let b = b.abs();
    if b > a { b } else { a }
}

/// A block of pivots: their rows from its first column on, and the inverses of the pivots.
struct Pivots<'a, E> {
    rows: [&'a [E]; BLOCK],
    inverse: [E; BLOCK],
}

impl<E: Entry> Pivots<'_, E> {
    /// Eliminates the block's columns from `R` rows, one after the other; in the first of them they begin at
    /// `at`, in each of the others one place earlier. `largest` multipliers are kept by column.
    #[inline(always)]
    fn eliminate<S: Simd, const R: usize>(
        &self,
        simd: S,
        rows: &mut [E],
        at: usize,
        largest: &mut [E; BLOCK],
    ) {
        let (width, stride) = (self.rows[0].len(), rows.len() / R);
        let mut rows = rows.chunks_exact_mut(stride);
        let mut targets: [&mut [E]; R] = std::array::from_fn(|r| {
            let row = rows.next().expect("so many rows");
            &mut row[at - r..at - r + width]
        });
        let [p0, p1, p2, _] = self.rows;
        let mut factors = [[E::ZERO.splat(simd); BLOCK]; R];
        for (target, factors) in targets.iter_mut().zip(&mut factors) {
            let l0 = target[0] * self.inverse[0];
            let l1 = l0.mul_add(-p0[1], target[1]) * self.inverse[1];
            let l2 = l1.mul_add(-p1[2], l0.mul_add(-p0[2], target[2])) * self.inverse[2];
            let l3 = l1.mul_add(-p1[3], l0.mul_add(-p0[3], target[3]));
            let l3 = l2.mul_add(-p2[3], l3) * self.inverse[3];
            let l = [l0, l1, l2, l3];
            target[..BLOCK].copy_from_slice(&l);
            for k in 0..BLOCK {
                largest[k] = larger(largest[k], l[k]);
                factors[k] = (-l[k]).splat(simd);
            }
        }
        let [u0, u1, u2, u3] = [0, 1, 2, 3].map(|p: usize| E::cut::<S>(&self.rows[p][BLOCK..]));
        let n = u0.len();
        let (u1, u2, u3) = (&u1[..n], &u2[..n], &u3[..n]);
        let mut tails = targets.map(|target| &mut E::cut_mut::<S>(&mut target[BLOCK..])[..n]);
        for j in 0..n {
            let u = [u0[j], u1[j], u2[j], u3[j]];
            for (tail, factors) in tails.iter_mut().zip(&factors) {
                let mut t = tail[j];
                for (u, factor) in u.iter().zip(factors) {
                    t = E::multiply_add(simd, *factor, *u, t);
                }
                tail[j] = t;
            }
        }
    }
}

/// [`BandedLu::factor`] as a kernel.
struct Factor<'a, E> {
    lu: &'a mut BandedLu<E>,
    matrix: &'a Diagonals,
    scale: f64,
    more: &'a Diagonals,
}

impl<E: Entry> WithSimd for Factor<'_, E> {
    type Output = Result<(), BandedError>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        self.lu
            .factor_here(simd, self.matrix, self.scale, self.more)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Column-dominant band with entries from a fixed recurrence.
    fn sample(n: usize, band: Band) -> Diagonals {
        let offsets = -(band.below as isize)..=band.above as isize;
        let mut matrix = Diagonals::zeros(n, offsets.collect());
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
            let mut more = Diagonals::zeros(n, vec![0, -(below.min(1) as isize)]);
            for i in 0..n {
                more.add(i, i, 1.0 + i as f64);
                if below > 0 && i > 0 {
                    more.add(i, i - 1, 0.3);
                }
            }
            let (mut rhs, mut added) = (vec![0.0; n], vec![0.0; n]);
            matrix.multiply(&exact, &mut rhs);
            more.multiply(&exact, &mut added);
            for i in 0..n {
                rhs[i] += 0.01 * added[i];
            }
            let mut lu = BandedLu::<f64>::new(n, band);
            lu.factor(&matrix, 0.01, &more).unwrap();
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
        let mut matrix = Diagonals::zeros(2, vec![-1, 0, 1]);
        matrix.add(0, 1, 1.0);
        matrix.add(1, 0, 1.0);
        let mut lu = BandedLu::<f64>::new(2, Band::even(1));
        let nothing = Diagonals::zeros(2, Vec::new());
        assert_eq!(
            lu.factor(&matrix, 0.0, &nothing),
            Err(BandedError::Pivot { row: 0, value: 0.0 })
        );
        matrix.add(0, 0, 1e-9);
        assert!(matches!(
            lu.factor(&matrix, 0.0, &nothing),
            Err(BandedError::Growth { .. })
        ));
    }
}
