//! The lowest pairs of K x = ω² M x of narrow matrices: how many there are is counted, then they
//! alone are computed.
//!
//! * **Count.** K − s M = L D Lᵀ has as many negative pivots as there are ω² below s (Sylvester's
//!   law of inertia).
//! * **Pairs.** With K = L Lᵀ the operator L⁻¹ M L⁻ᵀ has the lowest ω as its largest eigenvalues
//!   1/ω², which Lanczos steps find first; every new vector is made orthogonal to all before it,
//!   twice. Steps end when the residual of each wanted pair is at rounding.
//!
//! Both cost what the band costs. Where the steps do not get there (a wanted pair without a share
//! in the starting vector, or nearly as many pairs as unknowns) [`dense::lowest_modes`] answers.
//!
//! Source: Parlett, *The Symmetric Eigenvalue Problem* (1998), chapters 3 and 13.

use super::dense::{self, CholeskyFactor, DenseError, EigenPairs, SquareMatrix, dot};

/// Residual of a pair relative to the largest 1/ω²: some units of rounding.
const RESIDUAL: f64 = 1e-15;
/// Lanczos steps per wanted pair, and besides.
const STEPS: [usize; 2] = [2, 8];

/// The pairs of K x = ω² M x with ω² < `limit`, and at least `at_least` of them, lowest first, for
/// positive definite K; vectors have xᵀ M x = 1.
///
/// # Errors
/// K not positive definite, or no convergence.
pub fn modes_below(
    stiffness: &SquareMatrix,
    mass: &SquareMatrix,
    limit: f64,
    at_least: usize,
) -> Result<EigenPairs, DenseError> {
    let factor = stiffness.cholesky()?;
    let n_below = count_below(stiffness, mass, limit);
    let wanted = n_below.max(at_least).min(stiffness.order());
    if wanted == 0 {
        return Ok(EigenPairs {
            values: Vec::new(),
            vectors: Vec::new(),
        });
    }
    let mut n_steps = STEPS[0] * wanted + STEPS[1];
    while 2 * n_steps <= stiffness.order() {
        let pairs = lanczos(&factor, mass, n_steps, wanted)?;
        let counted = |pairs: &EigenPairs| {
            let below = pairs.values.iter().take_while(|&&v| v < limit).count();
            // A value at the limit itself is on either side of it within rounding.
            below.abs_diff(n_below.min(wanted)) <= 1
        };
        match pairs.filter(counted) {
            Some(pairs) => return Ok(pairs),
            None => n_steps += wanted + STEPS[1],
        }
    }
    dense::lowest_modes(stiffness, mass, |_| wanted)
}

/// Number of ω² below `limit`: negative pivots of K − limit M.
fn count_below(stiffness: &SquareMatrix, mass: &SquareMatrix, limit: f64) -> usize {
    let n = stiffness.order();
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n);
    let mut first = Vec::with_capacity(n);
    let mut pivots: Vec<f64> = Vec::with_capacity(n);
    for i in 0..n {
        let entry = |j: usize| stiffness.get(i, j) - limit * mass.get(i, j);
        let start = (0..i).find(|&j| entry(j) != 0.0).unwrap_or(i);
        // Row i of L D, then of L.
        let mut row: Vec<f64> = (start..i).map(entry).collect();
        for j in start..i {
            let from = start.max(first[j]);
            let sum: f64 = (from..j)
                .map(|k| row[k - start] * rows[j][k - first[j]])
                .sum();
            row[j - start] -= sum;
        }
        let mut pivot = entry(i);
        for j in start..i {
            let scaled = row[j - start] / pivots[j];
            pivot -= scaled * row[j - start];
            row[j - start] = scaled;
        }
        // A pivot of zero: the limit is an eigenvalue of a leading part. Either sign counts right.
        if pivot == 0.0 {
            pivot = f64::EPSILON * entry(i).abs().max(f64::MIN_POSITIVE);
        }
        pivots.push(pivot);
        rows.push(row);
        first.push(start);
    }
    pivots.iter().filter(|&&pivot| pivot < 0.0).count()
}

/// `wanted` pairs from `n_steps` steps; `None` when they are not at rounding.
fn lanczos(
    factor: &CholeskyFactor,
    mass: &SquareMatrix,
    n_steps: usize,
    wanted: usize,
) -> Result<Option<EigenPairs>, DenseError> {
    let band = Band::of(mass);
    let n = mass.order();
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(n_steps);
    // A load on every unknown, without a symmetry that a mode could be blind to.
    let start: Vec<f64> = (0..n).map(|i| 1.0 + 1.0 / (2 + i) as f64).collect();
    let mut next = scaled(start);
    let mut projected = SquareMatrix::zeros(n_steps);
    let mut coupling = 0.0;
    for step in 0..n_steps {
        basis.push(next);
        let q = &basis[step];
        let mut z = q.clone();
        factor.solve_upper(&mut z);
        let mut w = band.times(&z);
        factor.solve_lower(&mut w);
        projected.add(step, step, dot(q, &w));
        for _ in 0..2 {
            for earlier in &basis {
                let share = dot(earlier, &w);
                for (wi, ei) in w.iter_mut().zip(earlier) {
                    *wi -= share * ei;
                }
            }
        }
        coupling = dot(&w, &w).sqrt();
        if step + 1 < n_steps {
            if coupling == 0.0 {
                return Ok(None);
            }
            projected.add(step + 1, step, coupling);
            projected.add(step, step + 1, coupling);
        }
        next = scaled(w);
    }
    let small = projected.symmetric_eigen()?;
    let largest = small.values.last().copied().unwrap_or(0.0);
    let is_exact = |k: usize| {
        let residual = coupling * small.vectors[k][n_steps - 1].abs();
        residual <= RESIDUAL * largest && small.values[k] > 0.0
    };
    let mut pairs = EigenPairs {
        values: Vec::with_capacity(wanted),
        vectors: Vec::with_capacity(wanted),
    };
    for k in (n_steps - wanted..n_steps).rev() {
        if !is_exact(k) {
            return Ok(None);
        }
        let mut x = vec![0.0; n];
        for (share, q) in small.vectors[k].iter().zip(&basis) {
            for (xi, qi) in x.iter_mut().zip(q) {
                *xi += share * qi;
            }
        }
        factor.solve_upper(&mut x);
        let scale = dot(&x, &band.times(&x)).sqrt().recip();
        x.iter_mut().for_each(|c| *c *= scale);
        pairs.values.push(small.values[k].recip());
        pairs.vectors.push(x);
    }
    Ok(Some(pairs))
}

/// The entries of a symmetric matrix between the first and the last of every row.
struct Band<'a> {
    rows: Vec<(usize, &'a [f64])>,
}

impl<'a> Band<'a> {
    fn of(matrix: &'a SquareMatrix) -> Self {
        let rows = (0..matrix.order()).map(|i| {
            let row = matrix.row(i);
            let from = row.iter().position(|&v| v != 0.0).unwrap_or(i);
            let to = row.iter().rposition(|&v| v != 0.0).unwrap_or(i);
            (from, &row[from..=to])
        });
        Self {
            rows: rows.collect(),
        }
    }

    fn times(&self, x: &[f64]) -> Vec<f64> {
        let rows = self.rows.iter();
        rows.map(|(from, row)| dot(row, &x[*from..*from + row.len()]))
            .collect()
    }
}

fn scaled(mut x: Vec<f64>) -> Vec<f64> {
    let scale = dot(&x, &x).sqrt().recip();
    x.iter_mut().for_each(|c| *c *= scale);
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dense::tests::chain;

    /// ω² = 4 sin²((2j − 1) π / (4n + 2)), held at one end.
    fn exact(n: usize, j: usize) -> f64 {
        let angle = (2 * j - 1) as f64 * std::f64::consts::PI / (4 * n + 2) as f64;
        4.0 * angle.sin().powi(2)
    }

    #[test]
    fn the_modes_below_a_limit_are_counted_and_exact() {
        let n = 120;
        let (k, m) = chain(n, false);
        for wanted in [0, 1, 4, 9] {
            let limit =
                0.5 * (exact(n, wanted + 1) + if wanted > 0 { exact(n, wanted) } else { 0.0 });
            let pairs = modes_below(&k, &m, limit, 0).unwrap();
            assert_eq!(pairs.values.len(), wanted);
            for (j, (value, x)) in pairs.values.iter().zip(&pairs.vectors).enumerate() {
                let error = (value / exact(n, j + 1) - 1.0).abs();
                assert!(error < 1e-11, "mode {j} of {wanted}: {error:e}");
                assert!((m.form(x, x) - 1.0).abs() < 1e-13);
                assert!((k.form(x, x) / value - 1.0).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn few_steps_and_the_whole_spectrum_agree() {
        let (k, m) = chain(120, false);
        let steps = lanczos(&k.cholesky().unwrap(), &m, 43, 6).unwrap();
        assert!(steps.is_some(), "answered by Lanczos steps");
        let few = modes_below(&k, &m, 0.0, 6).unwrap();
        let all = dense::lowest_modes(&k, &m, |_| 6).unwrap();
        assert_eq!(few.values.len(), 6);
        for j in 0..6 {
            assert!((few.values[j] / all.values[j] - 1.0).abs() < 1e-11);
            let product = m.form(&few.vectors[j], &all.vectors[j]);
            assert!((product.abs() - 1.0).abs() < 1e-10, "mode {j}");
        }
    }

    #[test]
    fn nearly_all_pairs_are_left_to_the_whole_spectrum() {
        let (k, m) = chain(10, false);
        let pairs = modes_below(&k, &m, 1e9, 0).unwrap();
        assert_eq!(pairs.values.len(), 10);
    }

    #[test]
    fn an_indefinite_stiffness_is_refused_with_its_pivot() {
        let (mut k, m) = chain(8, false);
        k.add(3, 3, -9.0);
        let error = modes_below(&k, &m, 1.0, 0).unwrap_err();
        assert!(matches!(
            error,
            DenseError::NotPositiveDefinite { pivot: 3, .. }
        ));
    }
}
