//! Film thickness with a smooth lower limit, the minimum film height h0.
//!
//! ```text
//! f(h) = h                              h >= 2 h0
//! f(h) = h0 (1 + 1/(1 + (2 h0 − h)/h0)) h <  2 h0
//! ```
//!
//! The Reynolds equation has no solution at h <= 0, yet iterates and touching sliders go there. f
//! has a continuous derivative and stays above h0; the clearance that decides a verdict is always
//! the true height.

use super::faces::{BLOCK, Block};

/// The minimum height h0 of a film, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeightLimit {
    pub(super) h0: f64,
}

impl HeightLimit {
    /// f(h) and f′(h).
    #[inline(always)]
    pub(super) fn apply(self, h: f64) -> (f64, f64) {
        let h0 = self.h0;
        if h >= 2.0 * h0 {
            (h, 1.0)
        } else {
            let s = h0 / (3.0 * h0 - h);
            (h0 * (1.0 + s), s * s)
        }
    }
}

impl HeightLimit {
    /// f and f′ of `base` + `recess` for a block. Where the whole block lies above 2 h0 no division is made; the
    /// numbers are the same.
    #[inline(always)]
    pub(super) fn apply_block(self, base: &Block, recess: &Block) -> [Block; 2] {
        let mut h = [0.0; BLOCK];
        let mut low = false;
        for k in 0..BLOCK {
            h[k] = base[k] + recess[k];
            low |= h[k] < 2.0 * self.h0;
        }
        let mut slope = [1.0; BLOCK];
        if low {
            for k in 0..BLOCK {
                (h[k], slope[k]) = self.apply(h[k]);
            }
        }
        [h, slope]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floor_is_c1_monotone_and_above_h0() {
        let height_limit = HeightLimit { h0: 3e-10 };
        let (below, above) = (
            height_limit.apply(6e-10 * (1.0 - 1e-12)),
            height_limit.apply(6e-10),
        );
        assert!((below.0 - above.0).abs() < 1e-20 && (below.1 - above.1).abs() < 1e-11);
        let mut previous = 0.0;
        for k in 0..2000 {
            let (h, slope) = height_limit.apply(-1e-7 + 1e-10 * k as f64);
            assert!(h > 3e-10 && slope > 0.0 && h > previous);
            previous = h;
        }
    }
}
