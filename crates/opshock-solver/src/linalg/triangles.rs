//! Solves with banded triangular factors, stored for fast solution in blocks of sixteen rows.
//!
//! A solution row by row waits for every row before the next. Here sixteen rows are solved together: with L and U cut
//! into blocks of sixteen rows,
//!
//! ```text
//! y_I = L_II⁻¹ r_I − Σ_j (L_II⁻¹ L_Ij) y_j,      x_I = U_II⁻¹ y_I − Σ_j (U_II⁻¹ U_Ij) x_j
//! ```
//!
//! every column of a block is sixteen numbers side by side, times one number of the solution. The inverses of the small
//! triangles and their products are computed once. A block waits for the one before it through a single sum, in which
//! the columns it depends on come last. Sums have a fixed order whatever the registers.
//!
//! The cost of a solution is the reading of the factors, so they may be kept in single precision ([`Entry`]).

use super::diagonals::Band;
use super::entry::Entry;
use crate::lanes::{Simd, WithSimd, widest};

/// Rows solved together.
const ROWS: usize = 16;

/// Columns beside a block's own that are computed together: a single one waits for its sums.
const ABREAST: usize = 4;

/// Sums a block's columns are spread over.
const SUMS: usize = 4;

/// Sixteen numbers of a column; none shares a cache line with another's.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Column<E>([E; ROWS]);

/// Both triangles of a banded factorisation.
#[derive(Clone, Debug)]
pub(super) struct Triangles<E> {
    n: usize,
    band: Band,
    /// Per block of rows: −L_II⁻¹ times the columns before it, then L_II⁻¹.
    lower: Vec<Column<E>>,
    /// Per block of rows: U_II⁻¹, then −U_II⁻¹ times the columns behind it.
    upper: Vec<Column<E>>,
    /// Rows of one block before its own columns and behind them, in whole groups of [`ABREAST`] columns.
    outside: [Vec<E>; 2],
    /// The solution as it comes, in whole blocks.
    x: Vec<E>,
}

impl<E: Entry> Triangles<E> {
    /// Storage for matrices of `n` rows with entries in `band`.
    pub(super) fn new(n: usize, band: Band) -> Self {
        let blocks = n.div_ceil(ROWS);
        Self {
            n,
            band,
            lower: vec![Column([E::ZERO; ROWS]); blocks * (band.below + ROWS)],
            upper: vec![Column([E::ZERO; ROWS]); blocks * (band.above + ROWS)],
            outside: [band.below, band.above]
                .map(|columns| vec![E::ZERO; ROWS * columns.next_multiple_of(ABREAST)]),
            x: vec![E::ZERO; blocks * ROWS],
        }
    }

    /// Takes over factors: `row(i)` holds the columns of row i in the band, L without its diagonal of
    /// ones and U; the diagonal of U is given inverted.
    #[inline(always)]
    pub(super) fn take<'r, S: Simd>(
        &mut self,
        simd: S,
        row: impl Fn(usize) -> &'r [E],
        inverse_pivots: &[E],
    ) {
        let n = self.n;
        let Band { below, above } = self.band;
        let [before, behind] = &mut self.outside;
        let strides = [below, above].map(|columns| columns.next_multiple_of(ABREAST));
        for (block, (lower, upper)) in self
            .lower
            .chunks_exact_mut(below + ROWS)
            .zip(self.upper.chunks_exact_mut(above + ROWS))
            .enumerate()
        {
            let first = block * ROWS;
            let (lower_outside, lower_own) = lower.split_at_mut(below);
            let (upper_own, upper_outside) = upper.split_at_mut(ROWS);
            let mut unit = [Column([E::ZERO; ROWS]); ROWS];
            let mut full = [Column([E::ZERO; ROWS]); ROWS];
            let mut inverse = [E::ONE; ROWS];
            // Entries of these rows beyond the band are zero from the start.
            let n_rows = ROWS.min(n - first);
            before[n_rows * strides[0]..].fill(E::ZERO);
            behind[n_rows * strides[1]..].fill(E::ZERO);
            for r in 0..n_rows {
                // Entry k is column first + r − below + k.
                let entries = row(first + r);
                let n_before = below.saturating_sub(r);
                let at = r * strides[0] + below - n_before;
                copy(&entries[..n_before], &mut before[at..]);
                for c in r.saturating_sub(below)..r {
                    unit[r].0[c] = entries[c + below - r];
                }
                for c in r + 1..ROWS.min(r + above + 1) {
                    full[r].0[c] = entries[c + below - r];
                }
                // Columns first + ROWS ... first + r + above.
                let own_end = (ROWS + below - r).min(self.band.width());
                copy(&entries[own_end..], &mut behind[r * strides[1]..]);
                inverse[r] = inverse_pivots[first + r];
            }
            let unit = inverse_of_unit_lower(simd, &unit);
            less_products(simd, &unit, before, lower_outside);
            lower_own.copy_from_slice(&unit);
            let full = inverse_of_upper(simd, &full, &inverse);
            less_products(simd, &full, behind, upper_outside);
            upper_own.copy_from_slice(&full);
        }
    }

    /// Solves in place; with `is_reversed` the last entry of `rhs` belongs to the first row.
    pub(super) fn solve(&mut self, rhs: &mut [f64], is_reversed: bool) {
        assert_eq!(rhs.len(), self.n);
        widest(Solve {
            triangles: self,
            rhs,
            is_reversed,
        });
    }

    #[inline(always)]
    fn load(&mut self, rhs: &[f64], is_reversed: bool) {
        let (x, behind) = self.x.split_at_mut(rhs.len());
        // Rows behind the last are those of the identity.
        behind.fill(E::ZERO);
        if is_reversed {
            for (x, r) in x.iter_mut().zip(rhs.iter().rev()) {
                *x = E::nearest(*r);
            }
        } else {
            for (x, r) in x.iter_mut().zip(rhs) {
                *x = E::nearest(*r);
            }
        }
    }

    #[inline(always)]
    fn store(&self, rhs: &mut [f64], is_reversed: bool) {
        if is_reversed {
            for (r, x) in rhs.iter_mut().rev().zip(&self.x) {
                *r = x.widen();
            }
        } else {
            for (r, x) in rhs.iter_mut().zip(&self.x) {
                *r = x.widen();
            }
        }
    }
}

/// Columns of the inverse of a lower triangle with a diagonal of ones, found together as the rows of
/// the inverse of Lᵀ.
#[inline(always)]
fn inverse_of_unit_lower<E: Entry, S: Simd>(simd: S, l: &[Column<E>; ROWS]) -> [Column<E>; ROWS] {
    let mut out = identity();
    for c in (1..ROWS).rev() {
        let source = out[c];
        for (r, row) in out[..c].iter_mut().enumerate() {
            subtract(simd, row, l[c].0[r], &source);
        }
    }
    out
}

/// Columns of the inverse of an upper triangle whose diagonal is given inverted, likewise.
#[inline(always)]
fn inverse_of_upper<E: Entry, S: Simd>(
    simd: S,
    u: &[Column<E>; ROWS],
    inverse_diagonal: &[E; ROWS],
) -> [Column<E>; ROWS] {
    let mut out = identity();
    for c in 0..ROWS {
        let mut source = out[c];
        for v in &mut source.0 {
            *v = *v * inverse_diagonal[c];
        }
        out[c] = source;
        for (r, row) in out.iter_mut().enumerate().skip(c + 1) {
            subtract(simd, row, u[c].0[r], &source);
        }
    }
    out
}

fn identity<E: Entry>() -> [Column<E>; ROWS] {
    let mut out = [Column([E::ZERO; ROWS]); ROWS];
    for (k, row) in out.iter_mut().enumerate() {
        row.0[k] = E::ONE;
    }
    out
}

/// `from` to the start of `to`.
#[inline(always)]
fn copy<E: Entry>(from: &[E], to: &mut [E]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = *from;
    }
}

/// For every column j of `rows`, which stand one after the other: − Σ `columns` times the numbers of j.
#[inline(always)]
fn less_products<E: Entry, S: Simd>(
    simd: S,
    columns: &[Column<E>; ROWS],
    rows: &[E],
    out: &mut [Column<E>],
) {
    let n = out.len();
    let (groups, rest) = out.as_chunks_mut::<ABREAST>();
    for (k, out) in groups.iter_mut().enumerate() {
        *out = less_products_abreast(simd, columns, rows, k * ABREAST);
    }
    if !rest.is_empty() {
        let last = less_products_abreast(simd, columns, rows, n - rest.len());
        for (out, column) in rest.iter_mut().zip(last) {
            *out = column;
        }
    }
}

/// [`less_products`] of the columns from `first`.
#[inline(always)]
fn less_products_abreast<E: Entry, S: Simd>(
    simd: S,
    columns: &[Column<E>; ROWS],
    rows: &[E],
    first: usize,
) -> [Column<E>; ABREAST] {
    let mut sums = [Column([E::ZERO; ROWS]); ABREAST];
    for (column, row) in columns.iter().zip(rows.chunks_exact(rows.len() / ROWS)) {
        let factors = &row[first..first + ABREAST];
        for (sum, factor) in sums.iter_mut().zip(factors) {
            subtract(simd, sum, *factor, column);
        }
    }
    sums
}

/// `row` − `factor` `source`.
#[inline(always)]
fn subtract<E: Entry, S: Simd>(simd: S, row: &mut Column<E>, factor: E, source: &Column<E>) {
    let factor = (-factor).splat(simd);
    for (row, source) in E::cut_mut::<S>(&mut row.0)
        .iter_mut()
        .zip(E::cut::<S>(&source.0))
    {
        *row = E::multiply_add(simd, factor, *source, *row);
    }
}

struct Solve<'a, E> {
    triangles: &'a mut Triangles<E>,
    rhs: &'a mut [f64],
    is_reversed: bool,
}

impl<E: Entry> WithSimd for Solve<'_, E> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        self.triangles.load(self.rhs, self.is_reversed);
        match E::lanes::<S>() {
            16 => self.run::<S, 1>(simd),
            8 => self.run::<S, 2>(simd),
            4 => self.run::<S, 4>(simd),
            2 => self.run::<S, 8>(simd),
            _ => self.run::<S, 16>(simd),
        }
        self.triangles.store(self.rhs, self.is_reversed);
    }
}

impl<E: Entry> Solve<'_, E> {
    /// The solution with a column in `V` registers.
    #[inline(always)]
    fn run<S: Simd, const V: usize>(&mut self, simd: S) {
        let Triangles {
            band: Band { below, above },
            lower,
            upper,
            x,
            ..
        } = &mut *self.triangles;
        let (below, above) = (*below, *above);
        for (block, columns) in lower.chunks_exact(below + ROWS).enumerate() {
            let first = block * ROWS;
            let known = first.saturating_sub(below);
            let (before, own) = columns.split_at(below);
            let before = &before[below - (first - known)..];
            let (solved, rest) = x.split_at_mut(first);
            let solved = &solved[known..];
            let rows = &mut rest[..ROWS];
            let (far, near) = before.split_at(before.len() % SUMS);
            let (x_far, x_near) = solved.split_at(far.len());
            let mut sum = BlockSum::<E, S, V>::of_far(simd, far, x_far);
            sum.add_all(simd, own, rows);
            sum.add_all(simd, near, x_near);
            rows.copy_from_slice(&sum.total(simd));
        }
        for (block, columns) in upper.chunks_exact(above + ROWS).enumerate().rev() {
            let first = block * ROWS;
            let (own, behind) = columns.split_at(ROWS);
            let (rest, solved) = x.split_at_mut(first + ROWS);
            let solved = &solved[..above.min(solved.len())];
            let rows = &mut rest[first..];
            let near = behind[..solved.len()].chunks_exact(SUMS);
            let x_near = solved.chunks_exact(SUMS);
            let mut sum = BlockSum::<E, S, V>::of_far(simd, near.remainder(), x_near.remainder());
            sum.add_all(simd, own, rows);
            for (columns, x) in near.zip(x_near).rev() {
                sum.add(simd, columns, x);
            }
            rows.copy_from_slice(&sum.total(simd));
        }
    }
}

/// Columns times numbers as they are summed up for a block, in `V` registers each sum.
struct BlockSum<E: Entry, S: Simd, const V: usize>([[E::Register<S>; V]; SUMS]);

impl<E: Entry, S: Simd, const V: usize> BlockSum<E, S, V> {
    /// The columns that fill no set of sums; they are the farthest.
    #[inline(always)]
    fn of_far(simd: S, columns: &[Column<E>], x: &[E]) -> Self {
        let mut sum = Self([[E::ZERO.splat(simd); V]; SUMS]);
        for (column, x) in columns.iter().zip(x) {
            sum.add_one(simd, 0, column, *x);
        }
        sum
    }

    /// Adds a column times a number to sum `s`.
    #[inline(always)]
    fn add_one(&mut self, simd: S, s: usize, column: &Column<E>, x: E) {
        let x = x.splat(simd);
        for (sum, part) in self.0[s].iter_mut().zip(E::cut::<S>(&column.0)) {
            *sum = E::multiply_add(simd, *part, x, *sum);
        }
    }

    /// Adds a column to every sum.
    #[inline(always)]
    fn add(&mut self, simd: S, columns: &[Column<E>], x: &[E]) {
        for s in 0..SUMS {
            self.add_one(simd, s, &columns[s], x[s]);
        }
    }

    /// Adds columns in whole sets of sums.
    #[inline(always)]
    fn add_all(&mut self, simd: S, columns: &[Column<E>], x: &[E]) {
        for (columns, x) in columns.chunks_exact(SUMS).zip(x.chunks_exact(SUMS)) {
            self.add(simd, columns, x);
        }
    }

    /// The total.
    #[inline(always)]
    fn total(self, simd: S) -> [E; ROWS] {
        let [a, b, c, d] = self.0;
        let mut out = [E::ZERO; ROWS];
        for (v, out) in E::cut_mut::<S>(&mut out).iter_mut().enumerate() {
            *out = E::add(simd, E::add(simd, a[v], b[v]), E::add(simd, c[v], d[v]));
        }
        out
    }
}
