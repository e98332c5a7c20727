//! Extrapolates a rate by the polynomial through its latest values, as the first guess of an implicit stage.
//!
//! ```text
//! ∫₀^τ p(t) dt = Σⱼ wⱼ kⱼ,   p the polynomial of lowest degree through (tⱼ, kⱼ)
//! ```
//!
//! (Lagrange's form.) A stage solve that starts nearer to its solution takes fewer iterations; the solution itself is
//! that of the stage equation.

/// Most values a polynomial goes through.
pub(super) const KNOWN: usize = 3;

/// Weights wⱼ of the integral from 0 to `reach_s` for values at the first `n` of `times_s`, which
/// differ from each other; the other weights are zero.
pub(super) fn integral_weights(times_s: [f64; KNOWN], n: usize, reach_s: f64) -> [f64; KNOWN] {
    let mut weights = [0.0; KNOWN];
    for j in 0..n {
        // Coefficients of Π (t − tₘ)/(tⱼ − tₘ), constant term first.
        let mut polynomial = [1.0, 0.0, 0.0];
        for m in (0..n).filter(|&m| m != j) {
            let [a, b, c] = polynomial;
            let (t, apart) = (times_s[m], times_s[j] - times_s[m]);
            polynomial = [-t * a, a - t * b, b - t * c].map(|p| p / apart);
        }
        let [a, b, c] = polynomial;
        weights[j] = reach_s * (a + reach_s * (b / 2.0 + reach_s * (c / 3.0)));
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_are_exact_up_to_the_degree_that_the_values_allow() {
        let times = [0.3, -0.8, -1.7];
        for n in 1..=KNOWN {
            for degree in 0..n as i32 {
                let w = integral_weights(times, n, 0.9);
                let sum: f64 = (0..KNOWN).map(|j| w[j] * times[j].powi(degree)).sum();
                let exact = 0.9_f64.powi(degree + 1) / f64::from(degree + 1);
                assert!((sum - exact).abs() < 1e-14, "n {n}, degree {degree}: {sum}");
            }
            assert!(
                integral_weights(times, n, 0.9)[n..]
                    .iter()
                    .all(|w| *w == 0.0)
            );
        }
    }
}
