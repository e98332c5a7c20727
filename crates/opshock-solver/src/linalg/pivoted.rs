//! Inverts and multiplies small dense matrices, stored in columns of whole registers, with row exchanges.
//!
//! A matrix of a few rows that is solved with thousands of times is worth inverting: a product of columns runs over
//! whole registers, where a triangular solve waits in every row for the row before.

use crate::lanes::{Kernel, SUMS, Simd, WithSimd, widest};

/// Rows that are handled together.
type Chunk = [f64; SUMS];

/// A square matrix in panels of eight rows, each column by column; the last is padded with zeros.
#[derive(Clone, Debug)]
pub struct PaddedColumns {
    n: usize,
    entries: Vec<Chunk>,
}

impl PaddedColumns {
    /// The `n` × `n` matrix given row by row.
    ///
    /// # Panics
    ///
    /// When `rows` has not n² entries.
    pub fn new(n: usize, rows: &[f64]) -> Self {
        let mut out = Self {
            n,
            entries: vec![[0.0; SUMS]; n * n.div_ceil(SUMS)],
        };
        out.fill(rows);
        out
    }

    /// Rows.
    pub fn order(&self) -> usize {
        self.n
    }

    fn fill(&mut self, rows: &[f64]) {
        let n = self.n;
        assert_eq!(rows.len(), n * n);
        let panels = self.entries.chunks_exact_mut(n);
        for (panel, rows) in panels.zip(rows.chunks(SUMS * n)) {
            for (lane, row) in rows.chunks_exact(n).enumerate() {
                for (column, a) in panel.iter_mut().zip(row) {
                    column[lane] = *a;
                }
            }
        }
    }

    /// `out` := A x.
    ///
    /// # Panics
    ///
    /// When sizes differ.
    pub fn product(&self, x: &[f64], out: &mut [f64]) {
        assert!(self.n == out.len() && x.len() == out.len());
        widest(Product {
            matrix: self,
            x,
            out,
        });
    }
}

struct Product<'a> {
    matrix: &'a PaddedColumns,
    x: &'a [f64],
    out: &'a mut [f64],
}

impl Kernel for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let panels = self.matrix.entries.chunks_exact(self.matrix.n);
        for (panel, out) in panels.zip(self.out.chunks_mut(SUMS)) {
            let mut sums = [0.0; SUMS];
            for (column, x) in panel.iter().zip(self.x) {
                for k in 0..SUMS {
                    sums[k] = column[k].mul_add(*x, sums[k]);
                }
            }
            out.copy_from_slice(&sums[..out.len()]);
        }
    }
}

/// Inverse of a small square matrix, in storage allocated once.
///
/// The matrix is inverted in place (Gauss-Jordan) with exchanges. The coefficients of an unknown in all equations are
/// first divided by the largest of them, since metres and radians occur in one matrix.
#[derive(Clone, Debug)]
pub struct PivotedInverse {
    /// Row by row.
    matrix: Vec<f64>,
    inverse: PaddedColumns,
    /// One over the largest entry of every unknown, padded with ones.
    scales: Vec<Chunk>,
    multipliers: Vec<f64>,
    /// Unknown taken k-th.
    exchanges: Vec<usize>,
    product: Vec<f64>,
}

impl PivotedInverse {
    /// Storage for matrices of `n` rows.
    pub fn new(n: usize) -> Self {
        Self {
            matrix: vec![0.0; n * n],
            inverse: PaddedColumns::new(n, &vec![0.0; n * n]),
            scales: vec![[1.0; SUMS]; n.div_ceil(SUMS)],
            multipliers: vec![0.0; n],
            exchanges: vec![0; n],
            product: vec![0.0; n],
        }
    }

    /// The matrix to invert, row by row. The inverse of the last one is kept until [`PivotedInverse::invert`].
    pub fn matrix_mut(&mut self) -> &mut [f64] {
        &mut self.matrix
    }

    /// Inverts the matrix given in [`PivotedInverse::matrix_mut`]; false when an unknown or a pivot is
    /// zero or not finite, and the inverse is worthless.
    pub fn invert(&mut self) -> bool {
        self.inverse.fill(&self.matrix);
        widest(Invert {
            entries: &mut self.inverse.entries,
            scales: &mut self.scales,
            multipliers: &mut self.multipliers,
            exchanges: &mut self.exchanges,
        })
    }

    /// Solves in place with the last inverse; false when the solution is not finite.
    ///
    /// # Panics
    ///
    /// When `rhs` has not n entries.
    pub fn solve(&mut self, rhs: &mut [f64]) -> bool {
        self.inverse.product(rhs, &mut self.product);
        rhs.copy_from_slice(&self.product);
        rhs.iter().all(|x| x.is_finite())
    }
}

/// With the columns of A as rows this inverts Aᵀ: the rows of A⁻ᵀ are the columns of A⁻¹.
struct Invert<'a> {
    entries: &'a mut [Chunk],
    scales: &'a mut [Chunk],
    multipliers: &'a mut [f64],
    exchanges: &'a mut [usize],
}

impl WithSimd for Invert<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Self {
            entries,
            scales,
            multipliers,
            exchanges,
        } = self;
        let n = exchanges.len();
        for i in 0..n {
            let mut largest = [0.0_f64; SUMS];
            for panel in entries.chunks_exact(n) {
                for k in 0..SUMS {
                    largest[k] = largest[k].max(panel[i][k].abs());
                }
            }
            let largest = largest.into_iter().fold(0.0, f64::max);
            if !(largest > 0.0 && largest.is_finite()) {
                return false;
            }
            scales[i / SUMS][i % SUMS] = 1.0 / largest;
        }
        for panel in entries.chunks_exact_mut(n) {
            for (i, column) in panel.iter_mut().enumerate() {
                scale(column, scales[i / SUMS][i % SUMS]);
            }
        }
        for k in 0..n {
            let (at, lane) = (k / SUMS * n, k % SUMS);
            let (mut taken, mut size) = (k, 0.0);
            for i in 0..n {
                multipliers[i] = entries[at + i][lane];
                let candidate = multipliers[i].abs();
                if i >= k && candidate > size {
                    (taken, size) = (i, candidate);
                }
                entries[at + i][lane] = 0.0;
            }
            if !(size > 0.0 && size.is_finite()) {
                return false;
            }
            exchanges[k] = taken;
            multipliers.swap(k, taken);
            let inverse = 1.0 / multipliers[k];
            multipliers[k] = 0.0;
            for panel in entries.chunks_exact_mut(n) {
                panel.swap(k, taken);
            }
            entries[at + k][lane] = 1.0;
            for panel in entries.chunks_exact_mut(n) {
                scale(&mut panel[k], inverse);
                let pivot = panel[k];
                let pivot = S::as_simd_f64s(&pivot).0;
                for (column, multiplier) in panel.iter_mut().zip(&*multipliers) {
                    let multiplier = simd.splat_f64s(-*multiplier);
                    for (a, p) in S::as_mut_simd_f64s(column).0.iter_mut().zip(pivot) {
                        *a = simd.mul_add_f64s(multiplier, *p, *a);
                    }
                }
            }
        }
        // Rows were exchanged before, so columns are exchanged after, backwards.
        for k in (0..n).rev() {
            let taken = exchanges[k];
            if taken != k {
                for i in 0..n {
                    let (here, there) = (k / SUMS * n + i, taken / SUMS * n + i);
                    let a = entries[here][k % SUMS];
                    entries[here][k % SUMS] = entries[there][taken % SUMS];
                    entries[there][taken % SUMS] = a;
                }
            }
        }
        for (panel, scales) in entries.chunks_exact_mut(n).zip(scales) {
            for column in panel {
                for k in 0..SUMS {
                    column[k] *= scales[k];
                }
            }
        }
        true
    }
}

#[inline(always)]
fn scale(column: &mut Chunk, factor: f64) {
    let mut scaled = *column;
    for a in &mut scaled {
        *a *= factor;
    }
    *column = scaled;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inversion_needs_row_exchanges_and_survives_mixed_units() {
        // Exact solution (1, -2, 3); the first pivot is zero and rows differ by 1e14 in scale.
        let rows = [[0.0, 2.0, 1.0], [3e14, 1e14, -2e14], [1e-9, 1e-9, 4e-9]];
        let exact = [1.0, -2.0, 3.0];
        let mut inverse = PivotedInverse::new(3);
        let flat: Vec<f64> = rows.iter().flatten().copied().collect();
        inverse.matrix_mut().copy_from_slice(&flat);
        let mut rhs: Vec<f64> = rows
            .iter()
            .map(|r| r.iter().zip(exact).map(|(a, x)| a * x).sum())
            .collect();
        assert!(inverse.invert() && inverse.solve(&mut rhs));
        for (x, wanted) in rhs.iter().zip(exact) {
            assert!((x - wanted).abs() < 1e-13);
        }
        for refused in [[1.0, 2.0, 2.0, 4.0], [1.0, f64::NAN, 2.0, 4.0]] {
            let mut inverse = PivotedInverse::new(2);
            inverse.matrix_mut().copy_from_slice(&refused);
            assert!(!inverse.invert());
        }
    }

    /// Entries without order, a few of them large; the diagonal is not distinguished.
    fn rows(n: usize) -> Vec<f64> {
        (0..n * n)
            .map(|k| (k as f64 * 1.7).sin() + 3.0 * f64::from((k / n + 2) % n == k % n))
            .collect()
    }

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        for n in [1, 2, 7, 8, 9, 20, 33] {
            let rows = rows(n);
            let mut inverse = PivotedInverse::new(n);
            inverse.matrix_mut().copy_from_slice(&rows);
            assert!(inverse.invert());
            for j in 0..n {
                let unit: Vec<f64> = (0..n).map(|k| f64::from(k == j)).collect();
                let mut column = unit.clone();
                assert!(inverse.solve(&mut column));
                for i in 0..n {
                    let product: f64 = (0..n).map(|k| rows[i * n + k] * column[k]).sum();
                    let one = unit[i];
                    assert!((product - one).abs() < 1e-12, "{n}: {i} {j} {product}");
                }
            }
        }
    }

    #[test]
    fn products_are_those_of_rows_at_every_size() {
        for n in [1, 3, 8, 17, 20] {
            let a = rows(n);
            let x: Vec<f64> = (0..n).map(|k| (0.3 * k as f64).cos()).collect();
            let mut out = vec![f64::NAN; n];
            PaddedColumns::new(n, &a).product(&x, &mut out);
            for (i, out) in out.iter().enumerate() {
                let wanted: f64 = (0..n).map(|j| a[i * n + j] * x[j]).sum();
                assert!((out - wanted).abs() < 1e-13 * n as f64, "{n} {i}");
            }
        }
    }
}
