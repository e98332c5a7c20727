//! Inverses of the two heights of a half cell, and their logarithmic mean h̄ = (h_f − h_c)/ln(h_f/h_c).

use crate::elementary::{ln, polynomial};

/// Below this ((h_f − h_c)/(h_f + h_c))² the logarithmic mean is a series.
const FLAT: f64 = 0.0025;

/// 1/(h_centre + h_face) and 1/h_face.
#[inline(always)]
pub(super) fn inverses(h_centre: f64, h_face: f64) -> [f64; 2] {
    let sum = h_centre + h_face;
    let inverse = 1.0 / (sum * h_face);
    [inverse * h_face, inverse * sum]
}

/// [`inverses`] of both sides of a face by one division.
#[inline(always)]
pub(super) fn inverses_of_both(centres: [f64; 2], faces: [f64; 2]) -> [[f64; 2]; 2] {
    let sums = [centres[0] + faces[0], centres[1] + faces[1]];
    let (u, d) = (sums[0] * faces[0], sums[1] * faces[1]);
    let inverse = 1.0 / (u * d);
    let (u, d) = (inverse * d, inverse * u);
    [[u * faces[0], u * sums[0]], [d * faces[1], d * sums[1]]]
}

/// Whether the heights of a half cell differ so much that the short series of their logarithmic
/// mean does not hold.
#[inline(always)]
pub(super) fn is_steep(h_centre: f64, h_face: f64) -> bool {
    let (sum, rise) = (h_face + h_centre, h_face - h_centre);
    rise * rise >= FLAT * (sum * sum)
}

/// Logarithmic mean of the two heights, its inverse and derivatives by h_centre and h_face, and
/// ln(h_face/h_centre).
pub(super) struct LogarithmicMean {
    pub(super) value: f64,
    pub(super) inverse: f64,
    pub(super) by: [f64; 2],
    pub(super) log_ratio: f64,
}

impl LogarithmicMean {
    /// `STEEP` must hold where [`is_steep`] does; where it does not, both values of `STEEP` give the
    /// same bits. `inverse_h` is 1/h_centre and `inverse_sum` 1/(h_centre + h_face).
    #[inline(always)]
    pub(super) fn new<const STEEP: bool>(
        [h_centre, h_face]: [f64; 2],
        inverse_h: f64,
        inverse_sum: f64,
    ) -> Self {
        let sum = h_centre + h_face;
        let s = (h_face - h_centre) * inverse_sum;
        let q = s * s;
        // s/artanh(s), its derivative, artanh(s), and artanh(s)/s.
        let falling = [1.0 / 3.0, 4.0 / 45.0, 44.0 / 945.0, 428.0 / 14175.0];
        let near = (-q).mul_add(polynomial(q, falling), 1.0);
        let steepening = [2.0 / 3.0, 16.0 / 45.0, 264.0 / 945.0, 3424.0 / 14175.0];
        let near_slope = -s * polynomial(q, steepening);
        let odd = [1.0 / 3.0, 0.2, 1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0, 1.0 / 13.0];
        let series = q * polynomial(q, odd);
        let (near_artanh, near_inverse) = (s.mul_add(series, s), 1.0 + series);
        let (ratio, slope, artanh, inverse_ratio) = if STEEP {
            let steep = is_steep(h_centre, h_face);
            let far_artanh = 0.5 * ln(h_face * inverse_h);
            let both = 1.0 / (far_artanh * s);
            let inverse = both * s;
            let far = s * inverse;
            let far_slope = (1.0 - far / (1.0 - q)) * inverse;
            (
                if steep { far } else { near },
                if steep { far_slope } else { near_slope },
                if steep { far_artanh } else { near_artanh },
                if steep {
                    both * far_artanh * far_artanh
                } else {
                    near_inverse
                },
            )
        } else {
            (near, near_slope, near_artanh, near_inverse)
        };
        let lean = slope * inverse_sum;
        Self {
            value: 0.5 * sum * ratio,
            inverse: 2.0 * inverse_sum * inverse_ratio,
            by: [
                lean.mul_add(-h_face, 0.5 * ratio),
                lean.mul_add(h_centre, 0.5 * ratio),
            ],
            log_ratio: 2.0 * artanh,
        }
    }
}
