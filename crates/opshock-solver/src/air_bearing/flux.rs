//! Mass flux through one face: two half cells, the face pressure eliminated.
//!
//! With ψ = p h, G = Q ψ and w = 6 μ U_n, the flux per width towards a face is
//!
//! ```text
//! J = w ψ − G h dψ/dn + G ψ dh/dn.
//! ```
//!
//! In the half cell from a cell's centre (ψ_c, h_c) to a face (p_f h_f) at the distance Δ, with G
//! frozen at the centre, the coefficients D = G h_c and V = w + G (h_f − h_c)/Δ are constant and
//! the flux is that of the exponential profile (Scharfetter and Gummel 1969):
//!
//! ```text
//! J = α − β p_f,   α = (D/Δ) B(−Pe) ψ_c,   β = (D/Δ) B(Pe) h_f,   Pe = V Δ/D,   B(x) = x/(eˣ − 1)
//! ```
//!
//! Pressure is continuous at a face and height is not (an etched step on a face), so the two
//! outward fluxes cancel when p_f = (α_l + α_r)/(β_l + β_r). All coefficients are positive: the
//! scheme is monotone, p h = const is reproduced where convection rules, and a step on a face is
//! exact.

/// B(x) = x/(eˣ − 1) and B′(x).
#[inline]
pub(super) fn bernoulli(x: f64) -> (f64, f64) {
    if x.abs() < 0.02 {
        let s = x * x;
        (
            1.0 - 0.5 * x + s * (1.0 / 12.0 - s * (1.0 / 720.0 - s / 30240.0)),
            -0.5 + x * (1.0 / 6.0 - s * (1.0 / 180.0 - s / 5040.0)),
        )
    } else {
        let b = x / (x.exp() - 1.0);
        (b, b * (1.0 - b - x) / x)
    }
}

/// What a half cell is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfCell {
    /// ψ at the centre, Pa m.
    pub(super) psi: f64,
    /// G at the centre and dG/dψ.
    pub(super) g: f64,
    pub(super) g_slope: f64,
    /// Height at the centre and at this side of the face, m.
    pub(super) h_centre: f64,
    pub(super) h_face: f64,
    /// 1/Δ, 1/m.
    pub(super) inverse_distance: f64,
    /// 6 μ U · (outward normal), Pa m... per metre of width and unit ψ/h.
    pub(super) wind: f64,
}

/// α, β of a half cell and what its derivatives share.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfFlux {
    pub(super) alpha: f64,
    pub(super) beta: f64,
    /// (D/Δ) B(Pe) and (D/Δ) B′(Pe), and Pe.
    k: f64,
    k_slope: f64,
    pe: f64,
}

/// Smallest β: keeps the face pressure finite where both sides blow away from the face.
const SMALLEST_BETA: f64 = 1e-200;

impl HalfCell {
    /// Outward flux coefficients.
    #[inline]
    pub(super) fn flux(&self) -> HalfFlux {
        let conductance = self.g * self.h_centre * self.inverse_distance;
        let pe = self.wind / conductance + (self.h_face - self.h_centre) / self.h_centre;
        let (b, b_slope) = bernoulli(pe);
        let k = conductance * b;
        HalfFlux {
            alpha: (k + conductance * pe) * self.psi,
            beta: (k * self.h_face).max(SMALLEST_BETA),
            k,
            k_slope: conductance * b_slope,
            pe,
        }
    }

    /// Derivatives of α − β p at constant face pressure p by ψ, h_centre and h_face.
    #[inline]
    pub(super) fn derivatives(&self, flux: &HalfFlux, p: f64) -> [f64; 3] {
        let inverse_h = 1.0 / self.h_centre;
        let g = self.g * self.inverse_distance;
        let g_slope = self.g_slope * self.inverse_distance;
        let wind_part = self.wind / (g * self.h_centre);
        let drive = self.psi - p * self.h_face;
        // K = G h_c B(Pe)/Δ by ψ, h_c, h_f.
        let k_psi = g_slope / g * (flux.k - flux.k_slope * wind_part);
        let k_centre = (flux.k - flux.k_slope * (flux.pe + 1.0)) * inverse_h;
        let k_face = flux.k_slope * inverse_h;
        let velocity = g * self.h_centre * flux.pe;
        [
            k_psi * drive + self.psi * g_slope * (self.h_face - self.h_centre) + flux.k + velocity,
            k_centre * drive - self.psi * g,
            k_face * drive + self.psi * g - p * flux.k,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bernoulli_and_its_slope_are_smooth_across_the_series() {
        for x in [-0.02_f64, 0.02] {
            let (a, b) = (bernoulli(x * (1.0 - 1e-12)), bernoulli(x * (1.0 + 1e-12)));
            assert!((a.0 - b.0).abs() < 1e-13 && (a.1 - b.1).abs() < 1e-11);
        }
        assert_eq!(bernoulli(0.0), (1.0, -0.5));
        assert_eq!(bernoulli(800.0).0, 0.0);
        assert_eq!(bernoulli(-800.0), (800.0, -1.0));
    }

    #[test]
    fn half_cell_derivatives_match_differences() {
        let cell = |psi: f64, h_centre: f64, h_face: f64, wind: f64| HalfCell {
            psi,
            g: psi + 3.0 + 0.2 * psi * psi,
            g_slope: 1.0 + 0.4 * psi,
            h_centre,
            h_face,
            inverse_distance: 4.0,
            wind,
        };
        for wind in [-60.0, -3.0, 0.0, 0.001, 5.0, 80.0] {
            for h_face in [0.7, 1.0, 1.3] {
                let (psi, p) = (1.7, 1.2);
                let value = |psi: f64, h: f64, f: f64| {
                    let flux = cell(psi, h, f, wind).flux();
                    flux.alpha - flux.beta * p
                };
                let base = cell(psi, 1.0, h_face, wind);
                let analytic = base.derivatives(&base.flux(), p);
                let e = 1e-6;
                let numeric = [
                    (value(psi + e, 1.0, h_face) - value(psi - e, 1.0, h_face)) / (2.0 * e),
                    (value(psi, 1.0 + e, h_face) - value(psi, 1.0 - e, h_face)) / (2.0 * e),
                    (value(psi, 1.0, h_face + e) - value(psi, 1.0, h_face - e)) / (2.0 * e),
                ];
                for (a, n) in analytic.iter().zip(numeric) {
                    assert!(
                        (a - n).abs() < 1e-6 * (1.0 + n.abs()),
                        "{wind} {h_face}: {a} {n}"
                    );
                }
            }
        }
    }
}
