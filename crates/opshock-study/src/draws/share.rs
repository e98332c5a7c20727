//! Shares of independent draws, with exact binomial intervals.

use serde::Serialize;
use statrs::distribution::{Beta, ContinuousCDF as _};

/// A share of independent draws.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// Draws that have the property.
    pub with: u64,
    /// All of them.
    pub of: u64,
    /// Ends of the exact binomial interval of 95 % (Clopper and Pearson 1934, Biometrika 26, 404); where no
    /// draw has the property, or all have it, it is one-sided, about 3/n wide.
    pub interval: [f64; 2],
}

impl Share {
    /// Of `with` among `of` independent draws.
    pub fn of(with: u64, of: u64) -> Self {
        let (k, n) = (with as f64, of as f64);
        let quantile =
            |a: f64, b: f64, p: f64| Beta::new(a, b).map_or(f64::NAN, |beta| beta.inverse_cdf(p));
        let interval = match (with, of) {
            (_, 0) => [0.0, 1.0],
            (0, _) => [0.0, 1.0 - 0.05_f64.powf(1.0 / n)],
            (k, n) if k == n => [0.05_f64.powf(1.0 / n as f64), 1.0],
            _ => [
                quantile(k, n - k + 1.0, 0.025),
                quantile(k + 1.0, n - k, 0.975),
            ],
        };
        Self { with, of, interval }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_have_exact_intervals() {
        // Clopper and Pearson: 10 of 100 is 4.90 % to 17.62 % (R: binom.test(10, 100)).
        let [low, high] = Share::of(10, 100).interval;
        assert!(
            (low - 0.049_005_4).abs() < 1e-6 && (high - 0.176_222_6).abs() < 1e-6,
            "{low} {high}"
        );
        // The rule of three: none of 3000 is below 0.1 % with 95 %.
        let [_, none] = Share::of(0, 3000).interval;
        assert!((none - 9.980_8e-4).abs() < 1e-7, "{none}");
        assert_eq!(Share::of(0, 0).interval, [0.0, 1.0]);
    }
}
