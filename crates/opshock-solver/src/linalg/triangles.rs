//! Banded triangular factors laid out for solving.
//!
//! A solution by rows waits for every row before the next. Here eight rows go together: with L and U
//! cut into blocks of eight rows,
//!
//! ```text
//! y_I = L_II⁻¹ (r_I − Σ_j L_Ij y_j),      x_I = U_II⁻¹ (y_I − Σ_j U_Ij x_j)
//! ```
//!
//! every column of a block is eight numbers side by side, times one number of the solution, and the
//! inverses of the small triangles are made once. Sums have a fixed order whatever the registers.

use super::banded::Band;
use crate::lanes::{Simd, WithSimd, widest};

/// Rows solved together.
const ROWS: usize = 8;

/// Sums a block's columns are spread over.
const SUMS: usize = 4;

/// Eight numbers of a column.
type Column = [f64; ROWS];

/// Both triangles of a banded factorisation.
#[derive(Clone, Debug)]
pub(super) struct Triangles {
    n: usize,
    band: Band,
    /// Per block of rows: the columns before it, then the inverse of its own triangle.
    lower: Vec<Column>,
    /// Per block of rows: the inverse of its own triangle, then the columns behind it.
    upper: Vec<Column>,
}

impl Triangles {
    /// Storage for matrices of `n` rows with entries in `band`.
    pub(super) fn new(n: usize, band: Band) -> Self {
        let blocks = n.div_ceil(ROWS);
        Self {
            n,
            band,
            lower: vec![[0.0; ROWS]; blocks * (band.below + ROWS)],
            upper: vec![[0.0; ROWS]; blocks * (band.above + ROWS)],
        }
    }

    /// Takes over factors: `row(i)` holds the columns of row i in the band, L without its diagonal of
    /// ones and U; the diagonal of U is given inverted.
    #[inline(always)]
    pub(super) fn take<'r>(&mut self, row: impl Fn(usize) -> &'r [f64], inverse_pivots: &[f64]) {
        let n = self.n;
        let Band { below, above } = self.band;
        for (block, (lower, upper)) in self
            .lower
            .chunks_exact_mut(below + ROWS)
            .zip(self.upper.chunks_exact_mut(above + ROWS))
            .enumerate()
        {
            let first = block * ROWS;
            lower.fill([0.0; ROWS]);
            upper.fill([0.0; ROWS]);
            let mut unit = [[0.0; ROWS]; ROWS];
            let mut full = [[0.0; ROWS]; ROWS];
            let mut inverse = [1.0; ROWS];
            for r in 0..ROWS.min(n - first) {
                let entries = row(first + r);
                // Entry k is column first + r − below + k. Before the block: below − r of them.
                let before = below.saturating_sub(r);
                for (k, value) in entries[..before].iter().enumerate() {
                    lower[r + k][r] = *value;
                }
                for c in r.saturating_sub(below)..r {
                    unit[r][c] = entries[c + below - r];
                }
                for c in r + 1..ROWS.min(r + above + 1) {
                    full[r][c] = entries[c + below - r];
                }
                // Behind the block: columns first + ROWS ... first + r + above.
                let width = self.band.width();
                for k in (ROWS + below - r).min(width)..width {
                    upper[r + k - below][r] = entries[k];
                }
                inverse[r] = inverse_pivots[first + r];
            }
            invert_unit_lower(&unit, &mut lower[below..]);
            invert_upper(&full, &inverse, &mut upper[..ROWS]);
        }
    }

    /// Solves in place.
    pub(super) fn solve(&self, rhs: &mut [f64]) {
        assert_eq!(rhs.len(), self.n);
        widest(Solve::<1> {
            triangles: self,
            rhs: rhs.as_chunks_mut().0,
        });
    }

    /// Solves for `K` right-hand sides in place.
    pub(super) fn solve_columns<const K: usize>(&self, rhs: &mut [[f64; K]]) {
        assert_eq!(rhs.len(), self.n);
        widest(Solve {
            triangles: self,
            rhs,
        });
    }
}

/// Columns of the inverse of a lower triangle with a diagonal of ones.
#[inline(always)]
fn invert_unit_lower(l: &[Column; ROWS], out: &mut [Column]) {
    for (c, out) in out[..ROWS].iter_mut().enumerate() {
        let mut x = [0.0; ROWS];
        x[c] = 1.0;
        for r in c + 1..ROWS {
            let mut sum = 0.0;
            for k in c..r {
                sum += l[r][k] * x[k];
            }
            x[r] = -sum;
        }
        *out = x;
    }
}

/// Columns of the inverse of an upper triangle whose diagonal is given inverted.
#[inline(always)]
fn invert_upper(u: &[Column; ROWS], inverse_diagonal: &Column, out: &mut [Column]) {
    for (c, out) in out[..ROWS].iter_mut().enumerate() {
        let mut x = [0.0; ROWS];
        x[c] = inverse_diagonal[c];
        for r in (0..c).rev() {
            let mut sum = 0.0;
            for k in r + 1..=c {
                sum += u[r][k] * x[k];
            }
            x[r] = -sum * inverse_diagonal[r];
        }
        *out = x;
    }
}

struct Solve<'a, const K: usize> {
    triangles: &'a Triangles,
    rhs: &'a mut [[f64; K]],
}

impl<const K: usize> WithSimd for Solve<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::F64_LANES {
            8 => self.run::<S, 1>(simd),
            4 => self.run::<S, 2>(simd),
            2 => self.run::<S, 4>(simd),
            _ => self.run::<S, 8>(simd),
        }
    }
}

impl<const K: usize> Solve<'_, K> {
    /// The solution with a column in `V` registers.
    #[inline(always)]
    fn run<S: Simd, const V: usize>(self, simd: S) {
        let Triangles {
            n,
            band,
            lower,
            upper,
        } = self.triangles;
        let (n, Band { below, above }, rhs) = (*n, *band, self.rhs);
        for (block, columns) in lower.chunks_exact(below + ROWS).enumerate() {
            let first = block * ROWS;
            let end = n.min(first + ROWS);
            let known = first.saturating_sub(below);
            let (before, own) = columns.split_at(below);
            for k in 0..K {
                let before = &before[below - (first - known)..];
                let sum = product::<S, V, K>(simd, before, &rhs[known..first], k);
                settle::<S, V, K>(simd, own, sum, &mut rhs[first..end], k);
            }
        }
        for (block, columns) in upper.chunks_exact(above + ROWS).enumerate().rev() {
            let first = block * ROWS;
            let end = n.min(first + ROWS);
            let known = n.min(end + above);
            let (own, behind) = columns.split_at(ROWS);
            for k in 0..K {
                let behind = &behind[..known - end];
                let sum = product::<S, V, K>(simd, behind, &rhs[end..known], k);
                settle::<S, V, K>(simd, own, sum, &mut rhs[first..end], k);
            }
        }
    }
}

/// Σ_j column_j x_j of right-hand side k.
#[inline(always)]
fn product<S: Simd, const V: usize, const K: usize>(
    simd: S,
    columns: &[Column],
    x: &[[f64; K]],
    k: usize,
) -> [S::f64s; V] {
    let zero = simd.splat_f64s(0.0);
    let mut sums = [[zero; V]; SUMS];
    let add = |sum: &mut [S::f64s; V], column: &Column, x: f64| {
        let x = simd.splat_f64s(x);
        for (sum, part) in sum.iter_mut().zip(S::as_simd_f64s(column).0) {
            *sum = simd.add_f64s(*sum, simd.mul_f64s(*part, x));
        }
    };
    let (column_sets, x_sets) = (columns.chunks_exact(SUMS), x.chunks_exact(SUMS));
    let rest = column_sets.remainder().iter().zip(x_sets.remainder());
    for (columns, x) in column_sets.zip(x_sets) {
        for s in 0..SUMS {
            add(&mut sums[s], &columns[s], x[s][k]);
        }
    }
    for (column, x) in rest {
        add(&mut sums[0], column, x[k]);
    }
    let [mut a, b, c, d] = sums;
    for v in 0..V {
        a[v] = simd.add_f64s(simd.add_f64s(a[v], b[v]), simd.add_f64s(c[v], d[v]));
    }
    a
}

/// x = own (x − sum) for the rows of one block and right-hand side k.
#[inline(always)]
fn settle<S: Simd, const V: usize, const K: usize>(
    simd: S,
    own: &[Column],
    sum: [S::f64s; V],
    x: &mut [[f64; K]],
    k: usize,
) {
    let mut left = [[0.0]; ROWS];
    let mut known = [0.0; ROWS];
    for (out, part) in S::as_mut_simd_f64s(&mut known).0.iter_mut().zip(sum) {
        *out = part;
    }
    for ((left, x), known) in left.iter_mut().zip(&*x).zip(known) {
        left[0] = x[k] - known;
    }
    let solved = product::<S, V, 1>(simd, &own[..ROWS], &left, 0);
    let mut out = [0.0; ROWS];
    for (out, part) in S::as_mut_simd_f64s(&mut out).0.iter_mut().zip(solved) {
        *out = part;
    }
    for (x, out) in x.iter_mut().zip(out) {
        x[k] = out;
    }
}
