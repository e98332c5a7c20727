//! Small dense systems by elimination with row exchanges.
//!
//! Rows are compared after scaling by their largest entry, since metres and radians meet in one
//! matrix.

/// LU factors of a small square matrix, in storage allocated once.
#[derive(Clone, Debug)]
pub struct PivotedLu {
    n: usize,
    /// Row by row: the matrix, then its factors.
    entries: Vec<f64>,
    /// Largest entry of every row before the elimination.
    scales: Vec<f64>,
    /// Row taken as pivot row k.
    exchanges: Vec<usize>,
}

impl PivotedLu {
    /// Storage for matrices of `n` rows.
    pub fn new(n: usize) -> Self {
        Self {
            n,
            entries: vec![0.0; n * n],
            scales: vec![1.0; n],
            exchanges: (0..n).collect(),
        }
    }

    /// The matrix to factor, row by row; its old factors are overwritten.
    pub fn matrix_mut(&mut self) -> &mut [f64] {
        &mut self.entries
    }

    /// Factors the matrix given in [`PivotedLu::matrix_mut`]; false when a row or a pivot is zero or
    /// not finite, and the factors are worthless.
    pub fn factor(&mut self) -> bool {
        let n = self.n;
        for (row, scale) in self.entries.chunks_exact_mut(n).zip(&mut self.scales) {
            let largest = row.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
            if !(largest > 0.0 && largest.is_finite()) {
                return false;
            }
            row.iter_mut().for_each(|a| *a /= largest);
            *scale = largest;
        }
        for k in 0..n {
            let size = |row: usize| self.entries[row * n + k].abs();
            let pivot_row = (k..n)
                .max_by(|&a, &b| size(a).total_cmp(&size(b)))
                .unwrap_or(k);
            self.exchanges[k] = pivot_row;
            if pivot_row != k {
                let (above, below) = self.entries.split_at_mut(pivot_row * n);
                above[k * n..(k + 1) * n].swap_with_slice(&mut below[..n]);
            }
            let (done, rest) = self.entries.split_at_mut((k + 1) * n);
            let pivot_entries = &done[k * n + k..];
            let pivot = pivot_entries[0];
            if !(pivot != 0.0 && pivot.is_finite()) {
                return false;
            }
            for row in rest.chunks_exact_mut(n) {
                let multiplier = row[k] / pivot;
                row[k] = multiplier;
                for (a, p) in row[k + 1..].iter_mut().zip(&pivot_entries[1..]) {
                    *a -= multiplier * p;
                }
            }
        }
        true
    }

    /// Solves in place with the last factors; false when the solution is not finite.
    ///
    /// # Panics
    ///
    /// When `rhs` has not n entries.
    pub fn solve(&self, rhs: &mut [f64]) -> bool {
        let n = self.n;
        assert_eq!(rhs.len(), n);
        for (r, scale) in rhs.iter_mut().zip(&self.scales) {
            *r /= scale;
        }
        // Multipliers have moved with their rows, so all exchanges come first.
        for (k, &row) in self.exchanges.iter().enumerate() {
            rhs.swap(k, row);
        }
        for k in 0..n {
            let (known, rest) = rhs.split_at_mut(k);
            let row = &self.entries[k * n..k * n + k];
            for (multiplier, x) in row.iter().zip(&*known) {
                rest[0] -= multiplier * x;
            }
        }
        for k in (0..n).rev() {
            let row = &self.entries[k * n..(k + 1) * n];
            let known: f64 = row[k + 1..]
                .iter()
                .zip(&rhs[k + 1..])
                .map(|(a, x)| a * x)
                .sum();
            rhs[k] = (rhs[k] - known) / row[k];
        }
        rhs.iter().all(|x| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::PivotedLu;

    #[test]
    fn elimination_needs_row_exchanges_and_survives_mixed_units() {
        // Exact solution (1, -2, 3); the first pivot is zero and rows differ by 1e14 in scale.
        let rows = [[0.0, 2.0, 1.0], [3e14, 1e14, -2e14], [1e-9, 1e-9, 4e-9]];
        let exact = [1.0, -2.0, 3.0];
        let mut lu = PivotedLu::new(3);
        let flat: Vec<f64> = rows.iter().flatten().copied().collect();
        lu.matrix_mut().copy_from_slice(&flat);
        let mut rhs: Vec<f64> = rows
            .iter()
            .map(|r| r.iter().zip(exact).map(|(a, x)| a * x).sum())
            .collect();
        assert!(lu.factor() && lu.solve(&mut rhs));
        for (x, wanted) in rhs.iter().zip(exact) {
            assert!((x - wanted).abs() < 1e-13);
        }
        for refused in [[1.0, 2.0, 2.0, 4.0], [1.0, f64::NAN, 2.0, 4.0]] {
            let mut lu = PivotedLu::new(2);
            lu.matrix_mut().copy_from_slice(&refused);
            assert!(!lu.factor());
        }
    }
}
