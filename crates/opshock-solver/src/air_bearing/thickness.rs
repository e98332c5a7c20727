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
//!
//! Between rough surfaces h is their mean gap, which never reaches 0, and h0 only keeps numbers in range.

use super::faces::{BLOCK, Block};
use crate::rough_contact::roughness::{FAR, mean_gap};

/// h0 between rough surfaces over the minimum film height: their mean gap at h = −σ is 0.083 σ.
const ROUGH_SHARE: f64 = 0.1;

/// The minimum height h0 of a film between smooth surfaces, and the roughness of its surfaces (0: smooth), m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeightLimit {
    h0: f64,
    sigma: f64,
}

impl HeightLimit {
    /// Of smooth surfaces.
    pub(super) fn new(h0: f64) -> Self {
        Self { h0, sigma: 0.0 }
    }

    /// The same film between surfaces of the roughness `sigma`, m.
    pub(super) fn of_rough(self, sigma: f64) -> Self {
        Self { sigma, ..self }
    }

    /// Height over the disk from which steps and tolerances are measured, m: h0, or the roughness.
    pub(super) fn scale_m(self) -> f64 {
        match self.sigma > 0.0 {
            true => self.sigma.max(ROUGH_SHARE * self.h0),
            false => self.h0,
        }
    }
}

/// Whether a film of the minimum height `min_height_m` between surfaces of the roughness `roughness_m` (0: smooth) sees more than
/// there is where the clearance is `clearance_m`.
pub fn is_limited(clearance_m: f64, min_height_m: f64, roughness_m: f64) -> bool {
    if roughness_m > 0.0 {
        let limit = HeightLimit::new(min_height_m).of_rough(roughness_m);
        return mean_gap(clearance_m, limit.sigma).0 < 2.0 * ROUGH_SHARE * limit.h0;
    }
    clearance_m < 2.0 * min_height_m
}

impl HeightLimit {
    /// Whether the surfaces are rough: the argument of what follows, chosen once a pass, so that a kernel over smooth surfaces has
    /// nothing of the others.
    pub(super) fn is_rough(self) -> bool {
        self.sigma > 0.0
    }

    /// f(h) and f′(h).
    #[inline(always)]
    pub(super) fn apply(self, h: f64) -> (f64, f64) {
        match self.is_rough() {
            true => self.between_rough(h),
            false => limited(self.h0, h),
        }
    }

    /// The same between rough surfaces.
    #[inline(never)]
    fn between_rough(self, h: f64) -> (f64, f64) {
        let (gap, by_height) = mean_gap(h, self.sigma);
        let (limited, slope) = limited(ROUGH_SHARE * self.h0, gap);
        (limited, slope * by_height)
    }

    /// f and f′ of `base` + `recess` for a block. Where the whole block lies above 2 h0, and so far apart that roughness
    /// changes no bit, nothing is computed; the numbers are the same.
    #[inline(always)]
    pub(super) fn apply_block<const ROUGH: bool>(self, base: &Block, recess: &Block) -> [Block; 2] {
        let mut h = [0.0; BLOCK];
        let mut low = false;
        let from = match ROUGH {
            true => f64::max(2.0 * self.h0, FAR * self.sigma),
            false => 2.0 * self.h0,
        };
        for k in 0..BLOCK {
            h[k] = base[k] + recess[k];
            low |= h[k] < from;
        }
        let mut slope = [1.0; BLOCK];
        if low {
            for k in 0..BLOCK {
                (h[k], slope[k]) = match ROUGH {
                    true => self.between_rough(h[k]),
                    false => limited(self.h0, h[k]),
                };
            }
        }
        [h, slope]
    }
}

/// f and f′ of the minimum height h0.
#[inline(always)]
fn limited(h0: f64, h: f64) -> (f64, f64) {
    if h >= 2.0 * h0 {
        (h, 1.0)
    } else {
        let s = h0 / (3.0 * h0 - h);
        (h0 * (1.0 + s), s * s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floor_is_c1_monotone_and_above_h0() {
        let height_limit = HeightLimit::new(3e-10);
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
