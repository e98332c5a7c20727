//! Amplitudes on a fixed logarithmic grid: the only amplitudes that a search simulates.
//!
//! ```text
//! A_i = A_ref 2^(i/n),   n = ceil(ln 2 / ln(1 + tol)),   A_ref = 1 G
//! ```
//!
//! The integer i names an amplitude, so a probe requested twice is the same probe to the bit, a stored run can be found
//! again, and neighbouring grid points are at most `tol` apart. Octaves are multiplied exactly: A_(i+n) is 2 A_i to the
//! bit.

use serde::Serialize;

/// Reference amplitude A_ref, multiples of standard gravity.
pub const REFERENCE_G: f64 = 1.0;

/// Amplitude grid of a search tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct AmplitudeGrid {
    /// Grid points per doubling, n.
    pub steps_per_octave: i32,
}

/// A tolerance or range without an amplitude grid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum AmplitudeGridError {
    /// The tolerance is not between 1e-6 and 1.
    #[error("search tolerance {tolerance} is outside 1e-6 to 1")]
    Tolerance {
        /// The share.
        tolerance: f64,
    },
    /// No grid point lies in the range.
    #[error(
        "amplitude range {min_g} G to {max_g} G holds no amplitude of the search amplitude grid"
    )]
    EmptyRange {
        /// Lower end, G.
        min_g: f64,
        /// Upper end, G.
        max_g: f64,
    },
}

/// Grid points of a search, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AmplitudeRange {
    /// Lowest grid point.
    pub low: i32,
    /// Highest grid point.
    pub high: i32,
}

/// A grid point is inside a bound that it misses by rounding alone.
const ROUNDING: f64 = 1e-9;

impl AmplitudeGrid {
    /// Amplitude grid whose neighbours are at most `tolerance` (a share, 0.01 = 1 %) apart.
    ///
    /// # Errors
    ///
    /// The tolerance is not between 1e-6 and 1.
    pub fn for_tolerance(tolerance: f64) -> Result<AmplitudeGrid, AmplitudeGridError> {
        if !(1e-6..=1.0).contains(&tolerance) {
            return Err(AmplitudeGridError::Tolerance { tolerance });
        }
        // 2^(1/n) - 1 = tol is met exactly for tol = 1; rounding must not add a grid point there.
        let grid_points = (std::f64::consts::LN_2 / tolerance.ln_1p() - ROUNDING).ceil();
        Ok(AmplitudeGrid {
            steps_per_octave: grid_points as i32,
        })
    }

    /// The grid with `times` steps for each of this one: point i here is point `i times` there.
    #[must_use]
    pub fn finer(&self, times: i32) -> AmplitudeGrid {
        AmplitudeGrid {
            steps_per_octave: self.steps_per_octave.saturating_mul(times),
        }
    }

    /// Amplitude of a grid point, G.
    pub fn amplitude_g(&self, index: i32) -> f64 {
        let octave = index.div_euclid(self.steps_per_octave);
        let rest = index.rem_euclid(self.steps_per_octave);
        let share = f64::from(rest) / f64::from(self.steps_per_octave);
        REFERENCE_G * share.exp2() * f64::from(octave).exp2()
    }

    /// Ratio of neighbouring amplitudes minus one.
    pub fn step(&self) -> f64 {
        (1.0 / f64::from(self.steps_per_octave)).exp2() - 1.0
    }

    /// Largest number of grid steps whose span stays within `share` (0.1 = 10 %), at least 1.
    pub fn steps_within(&self, share: f64) -> i32 {
        let grid_points = f64::from(self.steps_per_octave) * (1.0 + share).log2() + ROUNDING;
        (grid_points.floor() as i32).max(1)
    }

    /// Grid point nearest to an amplitude in the logarithm. `amplitude_g` is positive and finite.
    pub fn nearest(&self, amplitude_g: f64) -> i32 {
        self.position(amplitude_g).round() as i32
    }

    /// Lowest grid point at or above an amplitude.
    pub fn at_or_above(&self, amplitude_g: f64) -> i32 {
        (self.position(amplitude_g) - ROUNDING).ceil() as i32
    }

    /// Highest grid point at or below an amplitude.
    pub fn at_or_below(&self, amplitude_g: f64) -> i32 {
        (self.position(amplitude_g) + ROUNDING).floor() as i32
    }

    /// Grid points between two amplitudes.
    ///
    /// # Errors
    ///
    /// No grid point lies between them, or they are not positive and finite.
    pub fn range(&self, min_g: f64, max_g: f64) -> Result<AmplitudeRange, AmplitudeGridError> {
        let empty = AmplitudeGridError::EmptyRange { min_g, max_g };
        if !(min_g > 0.0 && max_g.is_finite() && min_g <= max_g) {
            return Err(empty);
        }
        let (low, high) = (self.at_or_above(min_g), self.at_or_below(max_g));
        if low > high {
            return Err(empty);
        }
        Ok(AmplitudeRange { low, high })
    }

    fn position(&self, amplitude_g: f64) -> f64 {
        f64::from(self.steps_per_octave) * (amplitude_g / REFERENCE_G).log2()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_per_cent_has_seventy_steps_per_doubling() {
        let grid = AmplitudeGrid::for_tolerance(0.01).expect("amplitude grid");
        assert_eq!(grid.steps_per_octave, 70);
        assert!(grid.step() <= 0.01);
        assert_eq!(grid.steps_within(0.10), 9);
        assert_eq!(
            AmplitudeGrid::for_tolerance(1.0)
                .expect("amplitude grid")
                .steps_per_octave,
            1
        );
    }

    #[test]
    fn octaves_are_exact_and_nodes_find_themselves() {
        for tolerance in [0.2, 0.05, 0.01, 0.001] {
            let grid = AmplitudeGrid::for_tolerance(tolerance).expect("amplitude grid");
            for index in -300..900 {
                let amplitude = grid.amplitude_g(index);
                assert_eq!(
                    grid.amplitude_g(index + grid.steps_per_octave),
                    2.0 * amplitude
                );
                assert_eq!(grid.nearest(amplitude), index);
                assert_eq!(grid.at_or_above(amplitude), index);
                assert_eq!(grid.at_or_below(amplitude), index);
            }
        }
    }

    #[test]
    fn a_range_holds_the_nodes_between_its_ends() {
        let grid = AmplitudeGrid::for_tolerance(0.01).expect("amplitude grid");
        let range = grid.range(20.0, 2000.0).expect("range");
        assert!(grid.amplitude_g(range.low) >= 20.0);
        assert!(grid.amplitude_g(range.low - 1) < 20.0);
        assert!(grid.amplitude_g(range.high) <= 2000.0);
        assert!(grid.amplitude_g(range.high + 1) > 2000.0);
        assert!(grid.range(100.1, 100.2).is_err());
        for (min, max) in [(0.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0), (2.0, 1.0)] {
            assert!(grid.range(min, max).is_err());
        }
    }

    #[test]
    fn tolerances_outside_reason_are_refused() {
        for tolerance in [0.0, -0.1, 1e-12, 2.0, f64::NAN] {
            assert!(AmplitudeGrid::for_tolerance(tolerance).is_err());
        }
    }
}
