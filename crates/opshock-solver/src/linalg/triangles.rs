//! Banded triangular factors laid out for solving.
//!
//! A solution by rows waits for every row before the next. Here sixteen rows go together: with L and
//! U cut into blocks of sixteen rows,
//!
//! ```text
//! y_I = L_II⁻¹ r_I − Σ_j (L_II⁻¹ L_Ij) y_j,      x_I = U_II⁻¹ y_I − Σ_j (U_II⁻¹ U_Ij) x_j
//! ```
//!
//! every column of a block is sixteen numbers side by side, times one number of the solution. The
//! inverses of the small triangles and their products are made once: a block waits for the one before it
//! through a single sum, in which the columns it has to wait for come last. Sums have a fixed order
//! whatever the registers.
//!
//! What a solution costs is the reading of the factors, so they may be kept rounded ([`Entry`]).

use super::banded::Band;
use crate::lanes::{Simd, WithSimd, widest};

/// Rows solved together.
const ROWS: usize = 16;

/// Sums a block's columns are spread over.
const SUMS: usize = 4;

/// Sixteen numbers of a column.
type Column<E> = [E; ROWS];

/// A number as factors are kept: in full, or rounded to half the memory where the solution is itself
/// corrected by iteration.
pub trait Entry: Copy + std::fmt::Debug + 'static {
    /// Several of them in a register.
    type Register<S: Simd>: Copy;
    /// 0.
    const ZERO: Self;

    /// The nearest such number.
    fn nearest(value: f64) -> Self;
    /// The same number in double precision.
    fn widen(self) -> f64;
    /// A register full of one number.
    fn splat<S: Simd>(self, simd: S) -> Self::Register<S>;
    /// a + b.
    fn add<S: Simd>(simd: S, a: Self::Register<S>, b: Self::Register<S>) -> Self::Register<S>;
    /// a b.
    fn multiply<S: Simd>(simd: S, a: Self::Register<S>, b: Self::Register<S>) -> Self::Register<S>;
    /// A column's registers.
    fn registers<S: Simd>(column: &Column<Self>) -> &[Self::Register<S>];
    /// The same, to write.
    fn registers_mut<S: Simd>(column: &mut Column<Self>) -> &mut [Self::Register<S>];
    /// How many of them there are in a register.
    fn lanes<S: Simd>() -> usize;
}

macro_rules! entry {
    ($number:ty, $register:ident, $splat:ident, $add:ident, $mul:ident, $cut:ident, $cut_mut:ident, $lanes:ident) => {
        impl Entry for $number {
            type Register<S: Simd> = S::$register;
            const ZERO: Self = 0.0;

            #[inline(always)]
            #[allow(
                clippy::cast_possible_truncation,
                reason = "rounding is what it is for"
            )]
            fn nearest(value: f64) -> Self {
                value as $number
            }

            #[inline(always)]
            fn widen(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn splat<S: Simd>(self, simd: S) -> S::$register {
                simd.$splat(self)
            }

            #[inline(always)]
            fn add<S: Simd>(simd: S, a: S::$register, b: S::$register) -> S::$register {
                simd.$add(a, b)
            }

            #[inline(always)]
            fn multiply<S: Simd>(simd: S, a: S::$register, b: S::$register) -> S::$register {
                simd.$mul(a, b)
            }

            #[inline(always)]
            fn registers<S: Simd>(column: &Column<Self>) -> &[S::$register] {
                S::$cut(column).0
            }

            #[inline(always)]
            fn registers_mut<S: Simd>(column: &mut Column<Self>) -> &mut [S::$register] {
                S::$cut_mut(column).0
            }

            #[inline(always)]
            fn lanes<S: Simd>() -> usize {
                S::$lanes
            }
        }
    };
}

entry!(
    f64,
    f64s,
    splat_f64s,
    add_f64s,
    mul_f64s,
    as_simd_f64s,
    as_mut_simd_f64s,
    F64_LANES
);
entry!(
    f32,
    f32s,
    splat_f32s,
    add_f32s,
    mul_f32s,
    as_simd_f32s,
    as_mut_simd_f32s,
    F32_LANES
);

/// Both triangles of a banded factorisation.
#[derive(Clone, Debug)]
pub(super) struct Triangles<E> {
    n: usize,
    band: Band,
    /// Per block of rows: −L_II⁻¹ times the columns before it, then L_II⁻¹.
    lower: Vec<Column<E>>,
    /// Per block of rows: U_II⁻¹, then −U_II⁻¹ times the columns behind it.
    upper: Vec<Column<E>>,
    /// Columns of one block before and behind, in full.
    outside: [Vec<Column<f64>>; 2],
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
            lower: vec![[E::ZERO; ROWS]; blocks * (band.below + ROWS)],
            upper: vec![[E::ZERO; ROWS]; blocks * (band.above + ROWS)],
            outside: [band.below, band.above].map(|columns| vec![[0.0; ROWS]; columns]),
            x: vec![E::ZERO; blocks * ROWS],
        }
    }

    /// Takes over factors: `row(i)` holds the columns of row i in the band, L without its diagonal of
    /// ones and U; the diagonal of U is given inverted.
    #[inline(always)]
    pub(super) fn take<'r, S: Simd>(
        &mut self,
        simd: S,
        row: impl Fn(usize) -> &'r [f64],
        inverse_pivots: &[f64],
    ) {
        let n = self.n;
        let Band { below, above } = self.band;
        let [before, behind] = &mut self.outside;
        for (block, (lower, upper)) in self
            .lower
            .chunks_exact_mut(below + ROWS)
            .zip(self.upper.chunks_exact_mut(above + ROWS))
            .enumerate()
        {
            let first = block * ROWS;
            let (lower_outside, lower_own) = lower.split_at_mut(below);
            let (upper_own, upper_outside) = upper.split_at_mut(ROWS);
            before.fill([0.0; ROWS]);
            behind.fill([0.0; ROWS]);
            let mut unit = [[0.0; ROWS]; ROWS];
            let mut full = [[0.0; ROWS]; ROWS];
            let mut inverse = [1.0; ROWS];
            for r in 0..ROWS.min(n - first) {
                // Entry k is column first + r − below + k.
                let entries = row(first + r);
                let n_before = below.saturating_sub(r);
                for (column, value) in before[r.min(below)..].iter_mut().zip(&entries[..n_before]) {
                    column[r] = *value;
                }
                for c in r.saturating_sub(below)..r {
                    unit[r][c] = entries[c + below - r];
                }
                for c in r + 1..ROWS.min(r + above + 1) {
                    full[r][c] = entries[c + below - r];
                }
                // Columns first + ROWS ... first + r + above.
                let own_end = (ROWS + below - r).min(self.band.width());
                for (column, value) in behind.iter_mut().zip(&entries[own_end..]) {
                    column[r] = *value;
                }
                inverse[r] = inverse_pivots[first + r];
            }
            for (inverse, outside, own, out) in [
                (
                    inverse_of_unit_lower(simd, &unit),
                    &*before,
                    lower_own,
                    lower_outside,
                ),
                (
                    inverse_of_upper(simd, &full, &inverse),
                    &*behind,
                    upper_own,
                    upper_outside,
                ),
            ] {
                for (out, column) in out.iter_mut().zip(outside) {
                    *out = less_product(simd, &inverse, column).map(E::nearest);
                }
                round_into(&inverse, own);
            }
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
fn inverse_of_unit_lower<S: Simd>(simd: S, l: &[Column<f64>; ROWS]) -> [Column<f64>; ROWS] {
    let mut out = identity();
    for c in (1..ROWS).rev() {
        let source = out[c];
        for (r, row) in out[..c].iter_mut().enumerate() {
            subtract(simd, row, l[c][r], &source);
        }
    }
    out
}

/// Columns of the inverse of an upper triangle whose diagonal is given inverted, likewise.
#[inline(always)]
fn inverse_of_upper<S: Simd>(
    simd: S,
    u: &[Column<f64>; ROWS],
    inverse_diagonal: &Column<f64>,
) -> [Column<f64>; ROWS] {
    let mut out = identity();
    for c in 0..ROWS {
        let source = out[c].map(|v| v * inverse_diagonal[c]);
        out[c] = source;
        for (r, row) in out.iter_mut().enumerate().skip(c + 1) {
            subtract(simd, row, u[c][r], &source);
        }
    }
    out
}

fn identity() -> [Column<f64>; ROWS] {
    std::array::from_fn(|r| std::array::from_fn(|c| if c == r { 1.0 } else { 0.0 }))
}

/// − Σ `columns` times the numbers of `x`.
#[inline(always)]
fn less_product<S: Simd>(simd: S, columns: &[Column<f64>; ROWS], x: &Column<f64>) -> Column<f64> {
    let mut out = [0.0; ROWS];
    for (column, x) in columns.iter().zip(x) {
        subtract(simd, &mut out, *x, column);
    }
    out
}

/// `row` − `factor` `source`.
#[inline(always)]
fn subtract<S: Simd>(simd: S, row: &mut Column<f64>, factor: f64, source: &Column<f64>) {
    let factor = simd.splat_f64s(factor);
    let source = S::as_simd_f64s(source).0;
    for (row, source) in S::as_mut_simd_f64s(row).0.iter_mut().zip(source) {
        *row = simd.sub_f64s(*row, simd.mul_f64s(factor, *source));
    }
}

#[inline(always)]
fn round_into<E: Entry>(columns: &[Column<f64>], out: &mut [Column<E>]) {
    for (out, column) in out.iter_mut().zip(columns) {
        *out = column.map(E::nearest);
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
        for (sum, part) in self.0[s].iter_mut().zip(E::registers::<S>(column)) {
            *sum = E::add(simd, *sum, E::multiply(simd, *part, x));
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
    fn total(self, simd: S) -> Column<E> {
        let [a, b, c, d] = self.0;
        let mut out = [E::ZERO; ROWS];
        for (v, out) in E::registers_mut::<S>(&mut out).iter_mut().enumerate() {
            *out = E::add(simd, E::add(simd, a[v], b[v]), E::add(simd, c[v], d[v]));
        }
        out
    }
}
