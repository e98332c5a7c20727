//! Narrow symmetric matrices: products, Cholesky factorisation, number of eigenvalues below a shift.

use super::dense::{DenseError, SquareMatrix, dot};

/// Symmetric matrix with `W` diagonals below the main one.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricBand<const W: usize> {
    diagonal: Vec<f64>,
    /// Entry k of row i stands in column i − 1 − k; zero left of the first column.
    below: Vec<[f64; W]>,
}

/// Lower factor L of A = L Lᵀ: the inverses of its diagonal, and the rows and columns beside the diagonal divided by
/// the diagonal's entry, so that every number of a solution waits for the one before through one product only.
#[derive(Clone, Debug)]
pub struct BandCholesky<const W: usize> {
    inverse: Vec<f64>,
    before: Vec<[f64; W]>,
    after: Vec<[f64; W]>,
}

impl<const W: usize> SymmetricBand<W> {
    /// Zero matrix of order `n`.
    pub fn zeros(n: usize) -> Self {
        Self {
            diagonal: vec![0.0; n],
            below: vec![[0.0; W]; n],
        }
    }

    /// Order.
    pub fn order(&self) -> usize {
        self.diagonal.len()
    }

    /// Entry in row `i`, column `j`.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (row, distance) = (i.max(j), i.abs_diff(j));
        match distance {
            0 => self.diagonal[row],
            _ => self.below[row].get(distance - 1).copied().unwrap_or(0.0),
        }
    }

    /// Adds to the entries in row `i`, column `j` and in row `j`, column `i`, which are one entry where `i` is `j`.
    ///
    /// # Panics
    /// When the entry lies outside the band.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        match i.abs_diff(j) {
            0 => self.diagonal[i] += value,
            distance => self.below[i.max(j)][distance - 1] += value,
        }
    }

    /// Adds `factor` times another matrix of the same order.
    pub fn add_scaled(&mut self, factor: f64, other: &Self) {
        for (a, b) in self.diagonal.iter_mut().zip(&other.diagonal) {
            *a += factor * b;
        }
        let rows = self.below.as_flattened_mut().iter_mut();
        for (a, b) in rows.zip(other.below.as_flattened()) {
            *a += factor * b;
        }
    }

    /// A x.
    ///
    /// # Panics
    /// When `x` is not as long as the matrix.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        assert_eq!(x.len(), self.order());
        let n = self.order();
        let row = |i: usize| {
            let row = &self.below[i];
            let mut sum = self.diagonal[i] * x[i];
            if i >= W && i + W < n {
                // A whole row without bounds checks.
                let (left, right) = (&x[i - W..i], &x[i + 1..=i + W]);
                let rows = &self.below[i + 1..=i + W];
                for k in 0..W {
                    sum += row[k] * left[W - 1 - k] + rows[k][k] * right[k];
                }
                return sum;
            }
            for k in 0..W {
                if k < i {
                    sum += row[k] * x[i - 1 - k];
                }
                if i + 1 + k < n {
                    sum += self.below[i + 1 + k][k] * x[i + 1 + k];
                }
            }
            sum
        };
        (0..n).map(row).collect()
    }

    /// xᵀ A y.
    pub fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        dot(x, &self.times(y))
    }

    /// All entries.
    pub fn dense(&self) -> SquareMatrix {
        let mut all = SquareMatrix::zeros(self.order());
        for (i, (diagonal, row)) in self.diagonal.iter().zip(&self.below).enumerate() {
            all.add(i, i, *diagonal);
            for (k, &a) in row.iter().enumerate().take(i) {
                all.add(i, i - 1 - k, a);
                all.add(i - 1 - k, i, a);
            }
        }
        all
    }

    /// Lower factor.
    ///
    /// # Errors
    /// [`DenseError::NotPositiveDefinite`] with the pivot.
    pub fn cholesky(&self) -> Result<BandCholesky<W>, DenseError> {
        let mut factor = LowerBand {
            inverse: Vec::with_capacity(self.order()),
            below: Vec::with_capacity(self.order()),
        };
        for (i, (&diagonal, row)) in self.diagonal.iter().zip(&self.below).enumerate() {
            let mut l = [0.0; W];
            let mut pivot = diagonal;
            // From the far end of the row: column j = i − 1 − k.
            for k in (0..W.min(i)).rev() {
                let j = i - 1 - k;
                let mut sum = row[k];
                // Columns left of j, nearest first, of both rows.
                for (a, b) in l[k + 1..W.min(i)].iter().zip(&factor.below[j]) {
                    sum -= a * b;
                }
                l[k] = sum * factor.inverse[j];
                pivot -= l[k] * l[k];
            }
            // A pivot that is not a number is refused too.
            if pivot.is_nan() || pivot <= 0.0 {
                return Err(DenseError::NotPositiveDefinite {
                    pivot: i,
                    value: pivot,
                });
            }
            factor.inverse.push(pivot.sqrt().recip());
            factor.below.push(l);
        }
        Ok(factor.scaled())
    }

    /// Number of negative pivots of A − `shift` B, which is that of the eigenvalues of A x = s B x
    /// below the shift for positive definite B (Sylvester's law of inertia).
    pub fn count_below(&self, other: &Self, shift: f64) -> usize {
        let mut system = self.clone();
        system.add_scaled(-shift, other);
        let mut pivots: Vec<f64> = Vec::with_capacity(self.order());
        // Rows of L with a diagonal of ones.
        let mut rows: Vec<[f64; W]> = Vec::with_capacity(self.order());
        for (i, (&diagonal, row)) in system.diagonal.iter().zip(&system.below).enumerate() {
            let mut scaled = [0.0; W];
            let mut pivot = diagonal;
            for k in (0..W.min(i)).rev() {
                let j = i - 1 - k;
                let mut sum = row[k];
                for m in k + 1..W.min(i) {
                    sum -= scaled[m] * pivots[i - 1 - m] * rows[j][m - k - 1];
                }
                scaled[k] = sum / pivots[j];
                pivot -= scaled[k] * sum;
            }
            // A pivot of zero: the shift is an eigenvalue of a leading part. Either sign gives the right number.
            if pivot == 0.0 {
                pivot = f64::EPSILON * diagonal.abs().max(f64::MIN_POSITIVE);
            }
            pivots.push(pivot);
            rows.push(scaled);
        }
        pivots.iter().filter(|&&pivot| pivot < 0.0).count()
    }
}

/// L during the factorisation: inverses of its diagonal, and the entries before it in a row, the nearest first.
struct LowerBand<const W: usize> {
    inverse: Vec<f64>,
    below: Vec<[f64; W]>,
}

impl<const W: usize> LowerBand<W> {
    fn scaled(self) -> BandCholesky<W> {
        let Self { inverse, below } = self;
        let n = inverse.len();
        let mut after = vec![[0.0; W]; n];
        for (i, row) in below.iter().enumerate() {
            for (k, a) in row.iter().enumerate().take(i) {
                let j = i - 1 - k;
                after[j][k] = a * inverse[j];
            }
        }
        let before = below
            .iter()
            .zip(&inverse)
            .map(|(row, inverse)| row.map(|a| a * inverse))
            .collect();
        BandCholesky {
            inverse,
            before,
            after,
        }
    }
}

impl<const W: usize> BandCholesky<W> {
    /// x := L⁻¹ x.
    pub fn solve_lower(&self, x: &mut [f64]) {
        solve_band(x.iter_mut().zip(&self.inverse).zip(&self.before));
    }

    /// x := L⁻ᵀ x.
    pub fn solve_upper(&self, x: &mut [f64]) {
        solve_band(x.iter_mut().zip(&self.inverse).zip(&self.after).rev());
    }

    /// x := A⁻¹ x.
    pub fn solve(&self, x: &mut [f64]) {
        self.solve_lower(x);
        self.solve_upper(x);
    }
}

/// x := x inverse − Σ row × (numbers found before), the nearest of which comes first in a row.
#[inline(always)]
fn solve_band<'a, const W: usize>(
    rows: impl Iterator<Item = ((&'a mut f64, &'a f64), &'a [f64; W])>,
) {
    let mut found = [0.0; W];
    for ((x, inverse), row) in rows {
        let mut sum = *x * inverse;
        // The nearest entry last: the others do not wait for the row before.
        for k in (0..W).rev() {
            sum -= row[k] * found[k];
        }
        *x = sum;
        for k in (1..W).rev() {
            found[k] = found[k - 1];
        }
        found[0] = sum;
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Springs in a row, held at the left, with unit masses: stiffness 2 −1, at the free end 1.
    pub fn chain(n: usize) -> (SymmetricBand<3>, SymmetricBand<3>) {
        let (mut k, mut m) = (SymmetricBand::zeros(n), SymmetricBand::zeros(n));
        for i in 0..n {
            k.add(i, i, if i + 1 == n { 1.0 } else { 2.0 });
            m.add(i, i, 1.0);
            if i > 0 {
                k.add(i, i - 1, -1.0);
            }
        }
        (k, m)
    }

    /// A positive definite matrix that fills the band.
    fn full(n: usize) -> SymmetricBand<3> {
        let mut a = SymmetricBand::zeros(n);
        for i in 0..n {
            a.add(i, i, 4.0 + (i as f64).sin());
            for k in 1..=3.min(i) {
                a.add(i, i - k, (1.3 * (i * k) as f64).cos() / (k + 1) as f64);
            }
        }
        a
    }

    #[test]
    fn factor_and_product_are_those_of_the_whole_matrix() {
        let n = 23;
        let a = full(n);
        let all = a.dense();
        let x: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).sin()).collect();
        let (thin, thick) = (a.times(&x), all.times(&x));
        for (a, b) in thin.iter().zip(&thick) {
            assert!((a - b).abs() < 1e-14);
        }
        let mut back = thin;
        a.cholesky().expect("positive").solve(&mut back);
        for (a, b) in back.iter().zip(&x) {
            assert!((a - b).abs() < 1e-13, "{a} {b}");
        }
    }

    #[test]
    fn eigenvalues_are_counted_by_pivots() {
        let n = 31;
        let (a, mut unit) = (full(n), SymmetricBand::zeros(n));
        (0..n).for_each(|i| unit.add(i, i, 1.0));
        let values = a.dense().symmetric_eigen().expect("converges").values;
        for pair in values.windows(2).enumerate() {
            let (k, [low, high]) = pair else {
                unreachable!()
            };
            assert_eq!(a.count_below(&unit, 0.5 * (low + high)), k + 1);
        }
        assert_eq!(a.count_below(&unit, 0.9 * values[0]), 0);
    }

    #[test]
    fn an_indefinite_matrix_is_refused_with_its_pivot() {
        let (mut k, _) = chain(8);
        k.add(3, 3, -9.0);
        let error = k.cholesky().unwrap_err();
        assert!(matches!(
            error,
            DenseError::NotPositiveDefinite { pivot: 3, .. }
        ));
    }
}
