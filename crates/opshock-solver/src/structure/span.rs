//! Bounds the unit response over several steps, so that steps in which no gap can close are skipped.

use super::sample::{Sample, unit_gap};

/// Steps of a contact-free interval, which begins at a multiple of them.
pub(super) const INTERVAL_NODES: usize = 16;

/// Bounds of a value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub low: f64,
    pub high: f64,
}

/// Bounds of the unit response over an interval, ends included.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// Changes of the gaps: at the nodes, and of the cubics between them.
    pub gaps: [Range; 2],
    /// Displacements at the nodes: contact point, rim, slider.
    pub points: [Range; 3],
}

impl Range {
    /// Bounds of nothing.
    const EMPTY: Self = Self {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
    };

    /// Extended to `value` ± `more`.
    fn with(self, value: f64, more: f64) -> Self {
        Self {
            low: self.low.min(value - more),
            high: self.high.max(value + more),
        }
    }

    /// Bounds of `factor` times the value.
    pub fn times(self, factor: f64) -> Self {
        let (a, b) = (factor * self.low, factor * self.high);
        Self {
            low: a.min(b),
            high: a.max(b),
        }
    }

    /// Bounds of the sum of both values.
    pub fn plus(self, other: Self) -> Self {
        Self {
            low: self.low + other.low,
            high: self.high + other.high,
        }
    }

    /// Bounds of a motion known at both ends of a time `h_s`, in value and rate, that deviates from the cubic through
    /// them by `stray` at most: those of the cubic's control points (Bernstein).
    pub fn of_motion(ends: [[f64; 2]; 2], h_s: f64, stray: f64) -> Self {
        let [[x0, v0], [x1, v1]] = ends;
        let third = h_s / 3.0;
        [x0, x0 + third * v0, x1 - third * v1, x1]
            .into_iter()
            .fold(Self::EMPTY, |range, x| range.with(x, stray))
    }
}

impl Span {
    /// Bounds over `nodes`, `step_s` apart.
    pub fn new(nodes: &[Sample], step_s: f64) -> Self {
        let mut span = Self {
            gaps: [Range::EMPTY; 2],
            points: [Range::EMPTY; 3],
        };
        let mut fastest = [0.0_f64; 2];
        for sample in nodes {
            for (side, range) in span.gaps.iter_mut().enumerate() {
                let gap = unit_gap(side, sample);
                *range = range.with(gap.value_m, 0.0);
                fastest[side] = fastest[side].max(gap.rate_m_per_s.abs());
            }
            let points = [sample.contact.value, sample.rim, sample.slider.value];
            for (range, value) in span.points.iter_mut().zip(points) {
                *range = range.with(value, 0.0);
            }
        }
        for (range, rate_m_per_s) in span.gaps.iter_mut().zip(fastest) {
            // No cubic leaves the range of its ends by more than a quarter of a step times the larger of their rates.
            let more = 0.25 * step_s * rate_m_per_s;
            (range.low, range.high) = (range.low - more, range.high + more);
        }
        span
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_stays_within_the_bounds_of_its_ends() {
        // cos ωt over 0.8 radians: it deviates from the cubic by (ωh)⁴/384.
        let (omega, h) = (3.0, 0.8 / 3.0);
        for k in 0..40 {
            let phase = 0.17 * f64::from(k);
            let at = |t: f64| {
                [
                    (omega * t + phase).cos(),
                    -omega * (omega * t + phase).sin(),
                ]
            };
            let range = Range::of_motion([at(0.0), at(h)], h, 0.8_f64.powi(4) / 384.0);
            for j in 0..=50 {
                let [x, _] = at(h * f64::from(j) / 50.0);
                assert!(range.low <= x && x <= range.high, "{k} {j}");
            }
            assert!(range.high - range.low < 0.8);
        }
    }
}
