//! Exponential profile of ψ = p h between a cell's centre and a face, as a function of its Péclet number Pe: B(x) =
//! x/(eˣ − 1) and the related functions that the flux needs.

use crate::elementary::{exp, polynomial};

/// Below this |Pe| the series of B and of ω are used.
pub(super) const SMALL: f64 = 0.02;

/// Beyond this |Pe| the exponential at ±`STRONG` is taken; a factor of 1e130 more or less has no effect.
const STRONG: f64 = 300.0;

/// The exponential profile between a centre and a face, and what else depends on Pe alone.
pub(super) struct Profile {
    /// B(Pe) and B′(Pe).
    pub(super) b: f64,
    pub(super) b_slope: f64,
    /// 1/(exp(Pe) − 1); like all fields below, it has no meaning near Pe = 0.
    pub(super) r: f64,
    /// 1/Pe.
    pub(super) inverse_pe: f64,
    /// tanh(Pe/2), where the wind blows towards the face.
    pub(super) inverse_half: f64,
}

/// exp(Pe) for [`super::flux::HalfCell::driven`].
#[inline(always)]
pub(super) fn growth(pe: f64) -> f64 {
    let x = if pe > STRONG { STRONG } else { pe };
    exp(if x < -STRONG { -STRONG } else { x })
}

/// All of them by one division, which takes as long as a dozen products. `e` is [`growth`] of Pe; |Pe| < 1e40.
#[inline(always)]
pub(super) fn profile<const UP: bool>(pe: f64, e: f64) -> Profile {
    let s = pe * pe;
    let even = polynomial(s, [1.0 / 12.0, -1.0 / 720.0, 1.0 / 30240.0]);
    let near = s.mul_add(even, pe.mul_add(-0.5, 1.0));
    let odd = polynomial(s, [1.0 / 6.0, -1.0 / 180.0, 1.0 / 5040.0]);
    let near_slope = pe.mul_add(odd, -0.5);
    let m = e - 1.0;
    let (r, inverse_pe, inverse_half) = if UP {
        let q = e + 1.0;
        let inverse = 1.0 / (pe * (m * q));
        (
            inverse * (pe * q),
            inverse * (m * q),
            inverse * (pe * m) * m,
        )
    } else {
        let inverse = 1.0 / (pe * m);
        (inverse * pe, inverse * m, 0.0)
    };
    let far = pe * r;
    // B′ = r (1 − B − x), as B/x = r.
    let far_slope = r * (1.0 - far - pe);
    let small = pe.abs() < SMALL;
    Profile {
        b: if small { near } else { far },
        b_slope: if small { near_slope } else { far_slope },
        r,
        inverse_pe,
        inverse_half,
    }
}

/// (1 − 2 φ)/Pe with φ = (1 − B(Pe))/Pe, the mean of the exponential profile between centre and face
/// as a share of its whole rise; and the derivative by Pe.
/// `inverse` is 1/Pe, `b` B(Pe).
#[inline(always)]
pub(super) fn convective_share(pe: f64, inverse: f64, b: f64) -> [f64; 2] {
    let q = pe * pe;
    let near = polynomial(q, [1.0 / 6.0, -1.0 / 360.0, 1.0 / 15120.0]);
    let near_slope = -pe * polynomial(q, [1.0 / 180.0, -1.0 / 3780.0]);
    let layer = (1.0 - b) * inverse;
    let b_slope = b * (1.0 - b - pe) * inverse;
    let layer_slope = -(b_slope + layer) * inverse;
    let far = layer.mul_add(-2.0, 1.0) * inverse;
    let far_slope = -layer_slope.mul_add(2.0, far) * inverse;
    let small = pe.abs() < 0.05;
    [
        if small { near } else { far },
        if small { near_slope } else { far_slope },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bernoulli(x: f64) -> [f64; 2] {
        let (up, down) = (
            profile::<true>(x, growth(x)),
            profile::<false>(x, growth(x)),
        );
        if x != 0.0 {
            assert!((up.b / down.b - 1.0).abs() < 1e-15, "{x}");
            assert!((up.b_slope - down.b_slope).abs() < 1e-13, "{x}");
            assert!((up.inverse_pe * x - 1.0).abs() < 1e-15);
            assert!((down.inverse_pe * x - 1.0).abs() < 1e-15);
            let tanh = (0.5 * x).tanh();
            assert!((up.inverse_half - tanh).abs() < 1e-15 / x.abs().min(1.0));
        }
        [up.b, up.b_slope]
    }

    #[test]
    fn bernoulli_and_its_slope_are_smooth_across_the_series() {
        for x in [-0.02_f64, 0.02] {
            let (a, b) = (bernoulli(x * (1.0 - 1e-12)), bernoulli(x * (1.0 + 1e-12)));
            assert!((a[0] - b[0]).abs() < 1e-13 && (a[1] - b[1]).abs() < 1e-11);
        }
        assert_eq!(bernoulli(0.0), [1.0, -0.5]);
        for x in [-4.0_f64, 0.3, 2.0, 50.0] {
            let exact = x / x.exp_m1();
            assert!((bernoulli(x)[0] - exact).abs() < 1e-15 * exact, "{x}");
        }
        // Against such a wind next to nothing diffuses back: the exponential is that at `STRONG`.
        assert!(bernoulli(800.0)[0] < 1e-127);
        let [b, slope] = bernoulli(-800.0);
        assert!((b - 800.0).abs() < 1e-12 && (slope + 1.0).abs() < 1e-15);
        assert!((bernoulli(-1e39)[0] / 1e39 - 1.0).abs() < 1e-15);
    }
}
