//! Corrects the conductances of the faces around a corner of the slider's surface where the pressure is singular.
//!
//! Where up to four etch depths meet, the pressure behaves as p₀ + c r^α f(θ) with α < 1: at the
//! inlet corner of a pad that is narrower than the step before it, α is close to 1/2. Two-point
//! fluxes miss a fixed share of the flow next to such a point (36 % at α = 1/2), so a scheme of
//! second order falls to the first. The remedy: the four faces that meet in the corner get the
//! conductance that is exact for r^α f(θ).
//!
//! With κ = G h² in each quadrant, f obeys f″ + α² f = 0 with f and κ f′ continuous:
//!
//! ```text
//! (f, κ f′) at the end of a quadrant = T(α, κ) (f, κ f′) at its start,
//! T = [ cos β, sin β/(α κ) ; −α κ sin β, cos β ],   β = α π/2,
//! trace(T₄ T₃ T₂ T₁) = 2.
//! ```
//!
//! Exponents of interface problems: Kellogg 1974, Applicable Analysis 4, 101-129.

use std::f64::consts::FRAC_PI_2;

/// Exponents above this need no correction.
const REGULAR: f64 = 0.97;

/// A quadrant that conducts less than this share of the next better one is treated as a wall.
const WALL: f64 = 0.2;

/// Largest ratio of two conductances that is distinguished from infinity.
const LARGEST_CONTRAST: f64 = 1e8;

/// Cell widths around a corner: left, right, below, above.
#[derive(Clone, Copy, Debug)]
pub(super) struct Widths {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) below: f64,
    pub(super) above: f64,
}

/// Factors on the conductances of the four faces that meet in a corner.
///
/// Quadrants run counter-clockwise from the one left below; face k lies between quadrants k and
/// k + 1: below, right, above, left.
pub(super) fn conductance_factors(kappa: [f64; 4], widths: &Widths) -> [f64; 4] {
    // A wall at this contrast is as good as impermeable, and the shape keeps its digits despite rounding.
    let most = kappa.iter().copied().fold(0.0, f64::max);
    let kappa = kappa.map(|k| k.max(LARGEST_CONTRAST.recip() * most));
    let Some(alpha) = exponent(&kappa) else {
        return [1.0; 4];
    };
    let Some(start) = shape(alpha, &kappa) else {
        return [1.0; 4];
    };
    let Widths {
        left,
        right,
        below,
        above,
    } = *widths;
    // Per quadrant: extent along its first and along its second edge.
    let extents = [[left, below], [below, right], [right, above], [above, left]];

    let quarter = quarter_turn(alpha);
    let mut edge = start;
    let mut pressure = [0.0; 4];
    let mut flux = [0.0; 4];
    for k in 0..4 {
        let [a, b] = extents[k];
        let angle = alpha * b.atan2(a);
        let radius = 0.5 * a.hypot(b);
        pressure[k] = radius.powf(alpha)
            * (edge[0] * angle.cos() + edge[1] * angle.sin() / (alpha * kappa[k]));
        // Rounding aside, the circuit ends where it started.
        edge = if k == 3 {
            start
        } else {
            turned(alpha, quarter, kappa[k], edge)
        };
        flux[k] = -edge[1] * b.powf(alpha) / alpha;
    }

    let mut ordered = kappa;
    ordered.sort_by(f64::total_cmp);
    let bound = if ordered[0] < WALL * ordered[1] {
        WALL * ordered[1]
    } else {
        0.0
    };
    std::array::from_fn(|k| {
        let next = (k + 1) % 4;
        // A quadrant that hardly conducts only bounds the others; what little crosses its faces
        // follows its own, much thinner layers.
        if kappa[k].min(kappa[next]) < bound {
            return 1.0;
        }
        let length = extents[k][1];
        let resistance = 0.5 * (extents[k][0] / kappa[k] + extents[next][1] / kappa[next]);
        let two_point = (pressure[k] - pressure[next]) * length / resistance;
        let factor = flux[k] / two_point;
        if factor.is_finite() {
            factor.clamp(0.5, 2.5)
        } else {
            1.0
        }
    })
}

/// sin β and cos β.
fn quarter_turn(alpha: f64) -> (f64, f64) {
    (alpha * FRAC_PI_2).sin_cos()
}

/// (f, κ f′) at the end of a quadrant.
fn turned(alpha: f64, (sin, cos): (f64, f64), kappa: f64, [f, g]: [f64; 2]) -> [f64; 2] {
    [
        f * cos + g * sin / (alpha * kappa),
        g * cos - f * alpha * kappa * sin,
    ]
}

/// Once around: columns of the product of the four transfer matrices.
fn circuit(alpha: f64, kappa: &[f64; 4]) -> [[f64; 2]; 2] {
    let quarter = quarter_turn(alpha);
    [[1.0, 0.0], [0.0, 1.0]].map(|start| {
        kappa
            .iter()
            .fold(start, |edge, k| turned(alpha, quarter, *k, edge))
    })
}

/// Smallest exponent below [`REGULAR`].
fn exponent(kappa: &[f64; 4]) -> Option<f64> {
    let excess = |alpha: f64| {
        let [a, b] = circuit(alpha, kappa);
        a[0] + b[1] - 2.0
    };
    const STEPS: usize = 200;
    let at = |k: usize| 0.02 + (REGULAR - 0.02) * k as f64 / STEPS as f64;
    let mut was_below = excess(at(0)) < 0.0;
    let crossed = (1..=STEPS).find(|&k| {
        let is_below = excess(at(k)) < 0.0;
        std::mem::replace(&mut was_below, is_below) && !is_below
    })?;
    let (mut low, mut high) = (at(crossed - 1), at(crossed));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

/// (f, κ f′) at the start of the first quadrant, up to a factor.
fn shape(alpha: f64, kappa: &[f64; 4]) -> Option<[f64; 2]> {
    let [a, b] = circuit(alpha, kappa);
    // Null vector of the circuit minus one, from its larger row.
    let scale = kappa.iter().copied().fold(0.0, f64::max);
    let rows = [[a[0] - 1.0, b[0] * scale], [a[1] / scale, b[1] - 1.0]];
    let [p, q] = if rows[0][0].hypot(rows[0][1]) > rows[1][0].hypot(rows[1][1]) {
        rows[0]
    } else {
        rows[1]
    };
    (p.hypot(q) > 1e-9).then_some([-q, p * scale])
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: Widths = Widths {
        left: 1.0,
        right: 1.0,
        below: 1.0,
        above: 1.0,
    };

    #[test]
    fn even_surfaces_and_straight_edges_need_no_correction() {
        for kappa in [[1.0; 4], [1.0, 100.0, 100.0, 1.0], [1.0, 1.0, 3.0, 3.0]] {
            assert_eq!(conductance_factors(kappa, &SQUARE), [1.0; 4]);
        }
    }

    #[test]
    fn inlet_corner_of_a_narrow_pad_has_exponent_one_half() {
        // Half plane on the left, a wall right above, an open space right below: r^(1/2).
        let kappa = [1.0, 1e4, 1e-4, 1.0];
        assert!((exponent(&kappa).unwrap() - 0.5).abs() < 1e-3);
        let factors = conductance_factors(kappa, &SQUARE);
        // sqrt(r) sin(theta/2): centre at r = 1/sqrt(2), 45 degrees from the open side.
        let centre = 0.5_f64.sqrt().sqrt() * (std::f64::consts::PI / 8.0).sin();
        assert!(
            (factors[0] * 2.0 * centre - 1.0).abs() < 1e-3,
            "{factors:?}"
        );
        assert!((factors[3] - factors[0]).abs() < 1e-3, "{factors:?}");
    }

    #[test]
    fn outer_corner_of_a_rail_in_a_deep_recess_has_exponent_two_thirds() {
        let kappa = [1.0, 1.0, 1e-8, 1.0];
        assert!((exponent(&kappa).unwrap() - 2.0 / 3.0).abs() < 1e-4);
    }
}
