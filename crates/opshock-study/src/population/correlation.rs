//! Correlated draws: a Gaussian copula over independent uniform numbers.
//!
//! With u independent and uniform, z = L Φ⁻¹(u) is normal with correlation R = L Lᵀ, and Φ(z) is uniform with that
//! dependence (Nelsen 2006, An Introduction to Copulas, section 2.9 and 3.1). R is of the normal variables: values of
//! distributions that are not normal have a slightly smaller correlation.

use nalgebra::{Cholesky, DMatrix, DVector};
use statrs::distribution::{ContinuousCDF as _, Normal};

/// Dependence of a number of variables.
#[derive(Clone, Debug)]
pub(super) struct Correlation(DMatrix<f64>);

impl Correlation {
    /// Of `n` variables, by pairs and their coefficients; `None` where no variables can be so.
    pub(super) fn of(n: usize, pairs: &[(usize, usize, f64)]) -> Option<Self> {
        let mut matrix = DMatrix::identity(n, n);
        for &(a, b, coefficient) in pairs {
            matrix[(a, b)] = coefficient;
            matrix[(b, a)] = coefficient;
        }
        Cholesky::new(matrix).map(|factor| Self(factor.l()))
    }

    /// Dependent uniform numbers from independent ones.
    pub(super) fn apply(&self, independent: &[f64]) -> Vec<f64> {
        let normal = Normal::standard();
        // Draws are below 1; 0 itself would be infinitely far.
        let scores = independent
            .iter()
            .map(|&u| normal.inverse_cdf(u.max(f64::EPSILON / 4.0)));
        let scores = &self.0 * DVector::from_iterator(independent.len(), scores);
        scores.iter().map(|&z| normal.cdf(z)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draws::draw;

    #[test]
    fn dependent_numbers_have_their_correlation_and_stay_uniform() {
        let correlation = Correlation::of(3, &[(0, 2, 0.6)]).expect("a correlation");
        let n = 20_000;
        let all: Vec<Vec<f64>> = (0..n)
            .map(|index| correlation.apply(&draw(5, index, 3)))
            .collect();
        let mean =
            |of: &dyn Fn(&[f64]) -> f64| all.iter().map(|one| of(one)).sum::<f64>() / n as f64;
        // Pearson's (1907) relation between the correlations of normal scores and of ranks: 6/π asin(r/2).
        let ranks = mean(&|u| 12.0 * (u[0] - 0.5) * (u[2] - 0.5));
        let exact = 6.0 / std::f64::consts::PI * (0.3_f64).asin();
        assert!((ranks - exact).abs() < 0.03, "{ranks} {exact}");
        assert!(mean(&|u| 12.0 * (u[0] - 0.5) * (u[1] - 0.5)).abs() < 0.03);
        assert!((mean(&|u| f64::from(u8::from(u[2] < 0.1))) - 0.1).abs() < 0.01);
        // Three variables cannot all be this contrary.
        assert!(Correlation::of(3, &[(0, 1, -0.9), (0, 2, -0.9), (1, 2, -0.9)]).is_none());
    }
}
