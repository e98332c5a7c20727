//! Straight pieces of the visible boundaries of the slider's surface, and their lowest point over the disk.
//!
//! Over the disk a piece is a parabola, h(s) = h₀ + g s + c s² for 0 ≤ s ≤ 1. Its lower end less a quarter of c is a
//! lower bound, computed for eight pieces at once; few pieces need the exact minimum.

use crate::lanes::{Kernel, SUMS};

/// Straight piece of a visible boundary with the lower recess of its two sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub start_m: [f64; 2],
    pub span_m: [f64; 2],
    /// Recess and form at the start, m.
    pub height_m: f64,
    /// Derivative of the form along the piece at its start, for the parameter 0 ... 1, m.
    pub slope_m: f64,
    /// Half the second derivative for the same parameter, m.
    pub curvature_m: f64,
}

/// Eight pieces in columns; unused entries are infinitely high.
#[derive(Clone, Debug)]
pub(super) struct Eight {
    /// Start over the surface's middle, x and y, m.
    from_centre_m: [[f64; SUMS]; 2],
    span_m: [[f64; SUMS]; 2],
    height_m: [f64; SUMS],
    slope_m: [f64; SUMS],
    curvature_m: [f64; SUMS],
}

impl Eight {
    /// Of eight pieces at most, over the surface's middle.
    pub fn new(pieces: &[Piece], [xc, yc]: [f64; 2]) -> Self {
        let mut out = Self {
            from_centre_m: [[0.0; SUMS]; 2],
            span_m: [[0.0; SUMS]; 2],
            height_m: [f64::INFINITY; SUMS],
            slope_m: [0.0; SUMS],
            curvature_m: [0.0; SUMS],
        };
        for (k, piece) in pieces.iter().enumerate() {
            let [x0, y0] = piece.start_m;
            out.from_centre_m[0][k] = x0 - xc;
            out.from_centre_m[1][k] = y0 - yc;
            out.span_m[0][k] = piece.span_m[0];
            out.span_m[1][k] = piece.span_m[1];
            out.height_m[k] = piece.height_m;
            out.slope_m[k] = piece.slope_m;
            out.curvature_m[k] = piece.curvature_m;
        }
        out
    }
}

/// Lowest point of the pieces.
pub(super) struct LowestPoint {
    pub value_m: f64,
    pub piece: usize,
    /// Share of the piece.
    pub at: f64,
}

/// Finds the lowest point; among equals, the first.
pub(super) struct Lowest<'a> {
    pub eights: &'a [Eight],
    pub pieces: &'a [Piece],
    pub centre_height_m: f64,
    pub pitch_rad: f64,
    pub roll_rad: f64,
}

impl Kernel for Lowest<'_> {
    type Output = LowestPoint;

    #[inline(always)]
    fn call(self) -> LowestPoint {
        let mut best = LowestPoint {
            value_m: f64::INFINITY,
            piece: 0,
            at: 0.0,
        };
        let (mut start, mut slope) = ([0.0; SUMS], [0.0; SUMS]);
        let (mut end, mut bound) = ([0.0; SUMS], [0.0; SUMS]);
        for (first, (eight, pieces)) in self.eights.iter().zip(self.pieces.chunks(SUMS)).enumerate()
        {
            let ([x, y], [dx, dy]) = (&eight.from_centre_m, &eight.span_m);
            let mut lower = false;
            for k in 0..SUMS {
                let curvature = eight.curvature_m[k];
                start[k] = eight.height_m[k] + self.centre_height_m - self.pitch_rad * x[k]
                    + self.roll_rad * y[k];
                slope[k] = eight.slope_m[k] - self.pitch_rad * dx[k] + self.roll_rad * dy[k];
                end[k] = start[k] + slope[k] + curvature;
                // A parabola lies below its ends by at most a quarter of its curvature.
                bound[k] = start[k].min(end[k]) - 0.25 * curvature.max(0.0);
                let above = bound[k] > best.value_m;
                lower |= !above;
            }
            if !lower {
                continue;
            }
            for (k, piece) in pieces.iter().enumerate() {
                if bound[k] > best.value_m {
                    continue;
                }
                let (at, value_m) = piece.lowest(start[k], slope[k], end[k]);
                if value_m < best.value_m {
                    best = LowestPoint {
                        value_m,
                        piece: SUMS * first + k,
                        at,
                    };
                }
            }
        }
        best
    }
}

impl Piece {
    /// Share of the piece and height of its lowest point, of its height and slope at the start and its
    /// height at the end.
    #[inline(always)]
    fn lowest(&self, start: f64, slope: f64, end: f64) -> (f64, f64) {
        if self.curvature_m > 0.0 {
            let s = -0.5 * slope / self.curvature_m;
            if s > 0.0 && s < 1.0 {
                return (s, start + 0.5 * slope * s);
            }
        }
        if end < start {
            (1.0, end)
        } else {
            (0.0, start)
        }
    }
}
