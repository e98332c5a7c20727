//! Computes the lowest eigenpairs of K x = ω² M x of narrow matrices: their number first, then these pairs alone.
//!
//! * **Count.** K − s M = L D Lᵀ has as many negative pivots as there are ω² below s (Sylvester's
//!   law of inertia).
//! * **Pairs.** With K = L Lᵀ the operator L⁻¹ M L⁻ᵀ has the lowest ω as its largest eigenvalues
//!   1/ω², which Lanczos steps find first; every new vector is made orthogonal to all before it,
//!   twice. Steps end when the residual of each wanted pair is at rounding.
//!
//! Both cost in proportion to the band. Where the steps do not converge (a wanted pair without a share in the starting
//! vector, or nearly as many pairs as unknowns) [`dense::lowest_modes`] gives the pairs.
//!
//! Source: Parlett, *The Symmetric Eigenvalue Problem* (1998), chapters 3 and 13.

use super::band::{BandCholesky, SymmetricBand};
use super::dense::{self, DenseError, EigenPairs, SquareMatrix};
use crate::lanes::{self, Kernel, SUMS};

/// Residual of a pair relative to the largest 1/ω²: some units of rounding.
const RESIDUAL: f64 = 1e-15;
/// Lanczos steps before the first check of the pairs: per wanted pair, and in addition. The second number is also that
/// between further checks.
const STEPS: [usize; 2] = [2, 8];

/// The pairs of K x = ω² M x with ω² < `limit`, and at least `at_least` of them, lowest first, for
/// positive definite K; vectors have xᵀ M x = 1.
///
/// # Errors
/// K not positive definite, or no convergence.
pub fn modes_below<const W: usize>(
    stiffness: &SymmetricBand<W>,
    mass: &SymmetricBand<W>,
    limit: f64,
    at_least: usize,
) -> Result<EigenPairs, DenseError> {
    let factor = stiffness.cholesky()?;
    let n_below = stiffness.count_below(mass, limit);
    let wanted = n_below.max(at_least).min(stiffness.order());
    if wanted == 0 {
        return Ok(EigenPairs {
            values: Vec::new(),
            vectors: Vec::new(),
        });
    }
    let counted = |pairs: &EigenPairs| {
        let below = pairs.values.iter().take_while(|&&v| v < limit).count();
        // A value at the limit itself is on either side of it within rounding.
        below.abs_diff(n_below.min(wanted)) <= 1
    };
    match lanczos(&factor, mass, wanted, counted)? {
        Some(pairs) => Ok(pairs),
        None => dense::lowest_modes(&stiffness.dense(), &mass.dense(), |_| wanted),
    }
}

/// `wanted` pairs that are at rounding and `fit`; `None` when half as many steps as there are
/// unknowns do not give them.
fn lanczos<const W: usize>(
    factor: &BandCholesky<W>,
    mass: &SymmetricBand<W>,
    wanted: usize,
    fit: impl Fn(&EigenPairs) -> bool,
) -> Result<Option<EigenPairs>, DenseError> {
    let n = mass.order();
    let mut basis = Basis::new(n);
    // A load on every unknown, without a symmetry that would exclude a mode.
    let start: Vec<f64> = (0..n).map(|i| 1.0 + 1.0 / (2 + i) as f64).collect();
    let mut next = scaled(start);
    // Diagonal of the projected operator and the entries beside it.
    let (mut diagonal, mut coupling) = (Vec::new(), Vec::new());
    let mut next_look = STEPS[0] * wanted + STEPS[1];
    for step in 1..=n / 2 {
        basis.push(&next);
        let mut z = next.clone();
        factor.solve_upper(&mut z);
        let mut w = mass.times(&z);
        factor.solve_lower(&mut w);
        diagonal.push(lanes::product(&next, &w));
        // If the first pass removed the last two alone, modes would be ten times farther from orthogonal.
        for _ in 0..2 {
            basis.remove_from(&mut w);
        }
        coupling.push(lanes::product(&w, &w).sqrt());
        if step == next_look {
            let small = projected(&diagonal, &coupling).symmetric_eigen()?;
            if is_exact(&small, coupling[step - 1], wanted) {
                let pairs = lifted(&small, &basis, factor, mass, wanted);
                if fit(&pairs) {
                    return Ok(Some(pairs));
                }
            }
            next_look += STEPS[1];
        }
        if coupling[step - 1] == 0.0 {
            return Ok(None);
        }
        next = scaled(w);
    }
    Ok(None)
}

/// The operator between the vectors of the basis.
fn projected(diagonal: &[f64], coupling: &[f64]) -> SquareMatrix {
    let n = diagonal.len();
    let mut all = SquareMatrix::zeros(n);
    for i in 0..n {
        all.add(i, i, diagonal[i]);
        if i + 1 < n {
            all.add(i + 1, i, coupling[i]);
            all.add(i, i + 1, coupling[i]);
        }
    }
    all
}

/// The residuals of the `wanted` largest values are at rounding; `coupling` leads out of the basis.
fn is_exact(small: &EigenPairs, coupling: f64, wanted: usize) -> bool {
    let n = small.values.len();
    let largest = small.values[n - 1];
    (n - wanted..n).all(|k| {
        let residual = coupling * small.vectors[k][n - 1].abs();
        residual <= RESIDUAL * largest && small.values[k] > 0.0
    })
}

/// Pairs of K and M, lowest first, from those of the projected operator.
fn lifted<const W: usize>(
    small: &EigenPairs,
    basis: &Basis,
    factor: &BandCholesky<W>,
    mass: &SymmetricBand<W>,
    wanted: usize,
) -> EigenPairs {
    let n = small.values.len();
    let mut pairs = EigenPairs {
        values: Vec::with_capacity(wanted),
        vectors: Vec::with_capacity(wanted),
    };
    for k in (n - wanted..n).rev() {
        let mut x = basis.sum(&small.vectors[k]);
        factor.solve_upper(&mut x);
        let scale = lanes::product(&x, &mass.times(&x)).sqrt().recip();
        x.iter_mut().for_each(|c| *c *= scale);
        pairs.values.push(small.values[k].recip());
        pairs.vectors.push(x);
    }
    pairs
}

/// Orthonormal vectors one after the other.
struct Basis {
    n: usize,
    rows: Vec<f64>,
}

impl Basis {
    fn new(n: usize) -> Self {
        let rows = Vec::new();
        Self { n, rows }
    }

    fn push(&mut self, x: &[f64]) {
        self.rows.extend_from_slice(x);
    }

    /// Takes from `x` its part along every vector, a few at a time.
    fn remove_from(&self, x: &mut [f64]) {
        let together = self.rows.chunks_exact(ABREAST * self.n);
        let alone = together.remainder().chunks_exact(self.n);
        together.for_each(|rows| remove::<ABREAST>(rows, x));
        alone.for_each(|row| remove::<1>(row, x));
    }

    /// Sum of the vectors times `shares`.
    fn sum(&self, shares: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.n];
        for (share, row) in shares.iter().zip(self.rows.chunks_exact(self.n)) {
            for (x, q) in x.iter_mut().zip(row) {
                *x += share * q;
            }
        }
        x
    }
}

/// Vectors whose shares are removed at once: a single one waits for its sums.
const ABREAST: usize = 4;

/// Takes from `x` its parts along `K` rows.
fn remove<const K: usize>(rows: &[f64], x: &mut [f64]) {
    let n = x.len();
    let rows: [&[f64]; K] = std::array::from_fn(|i| &rows[i * n..][..n]);
    let shares = lanes::abreast(rows.map(|row| [row, &*x]));
    lanes::widest(Removal { rows, shares, x });
}

/// `x` less its `shares` of the rows.
struct Removal<'a, const K: usize> {
    rows: [&'a [f64]; K],
    shares: [f64; K],
    x: &'a mut [f64],
}

impl<const K: usize> Kernel for Removal<'_, K> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (x, x_rest) = self.x.as_chunks_mut::<SUMS>();
        let mut rows: [&[[f64; SUMS]]; K] = [&[]; K];
        for (chunks, row) in rows.iter_mut().zip(self.rows) {
            *chunks = &row.as_chunks().0[..x.len()];
        }
        for (j, x) in x.iter_mut().enumerate() {
            // A copy: as far as the compiler knows, stores into `x` could change rows.
            let mut less = *x;
            for (row, share) in rows.iter().zip(self.shares) {
                for k in 0..SUMS {
                    less[k] -= share * row[j][k];
                }
            }
            *x = less;
        }
        let done = SUMS * x.len();
        for (row, share) in self.rows.iter().zip(self.shares) {
            for (x, q) in x_rest.iter_mut().zip(&row[done..]) {
                *x -= share * q;
            }
        }
    }
}

fn scaled(mut x: Vec<f64>) -> Vec<f64> {
    let scale = lanes::product(&x, &x).sqrt().recip();
    x.iter_mut().for_each(|c| *c *= scale);
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::band::tests::chain;

    /// ω² = 4 sin²((2j − 1) π / (4n + 2)), held at one end.
    fn exact(n: usize, j: usize) -> f64 {
        let angle = (2 * j - 1) as f64 * std::f64::consts::PI / (4 * n + 2) as f64;
        4.0 * angle.sin().powi(2)
    }

    #[test]
    fn the_modes_below_a_limit_are_counted_and_exact() {
        let n = 120;
        let (k, m) = chain(n);
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
        let (k, m) = chain(120);
        let steps = lanczos(&k.cholesky().unwrap(), &m, 6, |_| true).unwrap();
        assert!(steps.is_some(), "answered by Lanczos steps");
        let few = modes_below(&k, &m, 0.0, 6).unwrap();
        let all = dense::lowest_modes(&k.dense(), &m.dense(), |_| 6).unwrap();
        assert_eq!(few.values.len(), 6);
        for j in 0..6 {
            assert!((few.values[j] / all.values[j] - 1.0).abs() < 1e-11);
            let product = m.form(&few.vectors[j], &all.vectors[j]);
            assert!((product.abs() - 1.0).abs() < 1e-10, "mode {j}");
        }
    }

    #[test]
    fn nearly_all_pairs_are_left_to_the_whole_spectrum() {
        let (k, m) = chain(10);
        let pairs = modes_below(&k, &m, 1e9, 0).unwrap();
        assert_eq!(pairs.values.len(), 10);
    }
}
