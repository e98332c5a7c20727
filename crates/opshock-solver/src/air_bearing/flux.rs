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
    /// ψ in the next cell away from the face, Pa m.
    pub(super) psi_behind: f64,
    /// Δ over the distance to that cell's centre; 0 where the film has a step in between, where
    /// there is no such cell, or where the wind does not blow towards the face.
    pub(super) reach: f64,
    /// G at the centre and dG/dψ.
    pub(super) g: f64,
    pub(super) g_slope: f64,
    /// Height at the centre and at this side of the face, m.
    pub(super) h_centre: f64,
    pub(super) h_face: f64,
    /// 1/Δ, 1/m.
    pub(super) inverse_distance: f64,
    /// 6 μ U · (outward normal), Pa s · m/s.
    pub(super) wind: f64,
}

/// α, β of a half cell and what its derivatives share.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfFlux {
    pub(super) alpha: f64,
    pub(super) beta: f64,
    /// Pe.
    pub(super) pe: f64,
    /// Rise δ of ψ from the centre to the face by convection, and its derivatives by ψ, by ψ
    /// behind and by Pe.
    pub(super) rise: f64,
    pub(super) rise_by: [f64; 3],
    /// B(Pe), (D/Δ) B(Pe), (D/Δ) B′(Pe).
    pub(super) b: f64,
    k: f64,
    k_slope: f64,
    /// D/Δ.
    conductance: f64,
}

/// Smallest β: keeps the face pressure finite where both sides blow away from the face.
const SMALLEST_BETA: f64 = 1e-200;

/// Derivatives by ψ, ψ behind, h_centre and h_face of one half cell.
pub(super) type Partials = [f64; 4];

/// Derivatives of a half cell's flux and load at constant face pressure.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfPartials {
    /// Of α − β p.
    pub(super) flux: Partials,
    /// Of the mean excess of the pressure over the centre's.
    pub(super) excess: Partials,
    /// Of the same by the face pressure.
    pub(super) excess_by_p: f64,
}

impl HalfCell {
    /// Outward flux coefficients.
    #[inline]
    pub(super) fn flux(&self) -> HalfFlux {
        let conductance = self.g * self.h_centre * self.inverse_distance;
        let pe = self.wind / conductance + (self.h_face - self.h_centre) / self.h_centre;
        let (b, b_slope) = bernoulli(pe);
        let k = conductance * b;
        let (rise, rise_by) = if self.reach > 0.0 && pe > 0.0 {
            self.rise(pe, b)
        } else {
            (0.0, [0.0; 3])
        };
        HalfFlux {
            alpha: k * self.psi + conductance * pe * (self.psi + rise),
            beta: (k * self.h_face).max(SMALLEST_BETA),
            pe,
            rise,
            rise_by,
            b,
            k,
            k_slope: conductance * b_slope,
            conductance,
        }
    }

    /// δ = ψ (g(s) − 1), s = ω(Pe) reach (1 − ψ_behind/ψ), with derivatives by ψ, ψ behind, Pe.
    #[inline]
    fn rise(&self, pe: f64, b: f64) -> (f64, [f64; 3]) {
        let (weight, weight_slope) = if pe < 0.02 {
            let q = pe * pe;
            (pe * (1.0 / 3.0 - q / 45.0), 1.0 / 3.0 - q / 15.0)
        } else {
            // coth(Pe) from coth(Pe/2) = 1 + 2/(exp(Pe) − 1).
            let half = 1.0 + 2.0 * b / pe;
            let coth = 0.5 * (half + 1.0 / half);
            let inverse = 1.0 / pe;
            (coth - inverse, 1.0 - coth * coth + inverse * inverse)
        };
        let ratio = self.psi_behind / self.psi;
        let per_weight = self.reach * (1.0 - ratio);
        let s = weight * per_weight;
        let (gain, gain_slope) = if s >= 0.0 {
            (s, 1.0)
        } else {
            let q = 1.0 / (1.0 - s);
            (s * q, q * q)
        };
        let lever = gain_slope * weight * self.reach;
        (
            self.psi * gain,
            [
                gain + lever * ratio,
                -lever,
                self.psi * gain_slope * per_weight * weight_slope,
            ],
        )
    }

    /// All derivatives at constant face pressure p.
    #[inline]
    pub(super) fn partials(&self, flux: &HalfFlux, p: f64) -> HalfPartials {
        let pe = self.pe_partials(flux);
        let rise = self.rise_partials(flux, &pe);
        let (excess, excess_by_p) = self.mean_excess_partials(flux, p, &pe, &rise);
        HalfPartials {
            flux: self.flux_partials(flux, p, &pe, &rise),
            excess,
            excess_by_p,
        }
    }

    /// Derivatives of Pe.
    #[inline]
    fn pe_partials(&self, flux: &HalfFlux) -> Partials {
        let inverse_h = 1.0 / self.h_centre;
        [
            -self.wind / flux.conductance * self.g_slope / self.g,
            0.0,
            -(flux.pe + 1.0) * inverse_h,
            inverse_h,
        ]
    }

    /// Derivatives of δ.
    #[inline]
    fn rise_partials(&self, flux: &HalfFlux, pe: &Partials) -> Partials {
        let [by_psi, by_behind, by_pe] = flux.rise_by;
        [
            by_psi + by_pe * pe[0],
            by_behind,
            by_pe * pe[2],
            by_pe * pe[3],
        ]
    }

    /// Derivatives of α − β p at constant face pressure p.
    #[inline]
    fn flux_partials(&self, flux: &HalfFlux, p: f64, pe: &Partials, rise: &Partials) -> Partials {
        let g = self.g * self.inverse_distance;
        let g_slope = self.g_slope * self.inverse_distance;
        let drive = self.psi - p * self.h_face;
        let carried = self.psi + flux.rise;
        let velocity = flux.conductance * flux.pe;
        [
            (flux.k * self.g_slope / self.g + flux.k_slope * pe[0]) * drive
                + carried * g_slope * (self.h_face - self.h_centre)
                + flux.k
                + velocity * (1.0 + rise[0]),
            velocity * rise[1],
            (flux.k / self.h_centre + flux.k_slope * pe[2]) * drive - carried * g
                + velocity * rise[2],
            flux.k_slope * pe[3] * drive + carried * g - p * flux.k + velocity * rise[3],
        ]
    }

    /// Mean over the half cell of the pressure's excess over its centre, and its derivatives with
    /// the face pressure as a fifth variable.
    #[inline]
    pub(super) fn mean_excess(&self, flux: &HalfFlux, p: f64) -> f64 {
        let inverse_h = 1.0 / self.h_centre;
        let rise = flux.rise * inverse_h;
        0.5 * rise + layer(flux).0 * (p - self.psi * inverse_h - rise)
    }

    /// Derivatives of [`HalfCell::mean_excess`], and by the face pressure.
    #[inline]
    fn mean_excess_partials(
        &self,
        flux: &HalfFlux,
        p: f64,
        pe: &Partials,
        rise: &Partials,
    ) -> (Partials, f64) {
        let inverse_h = 1.0 / self.h_centre;
        let (share, share_slope) = layer(flux);
        let bend = (p - (self.psi + flux.rise) * inverse_h) * share_slope;
        let mut partials: Partials =
            std::array::from_fn(|v| (0.5 - share) * inverse_h * rise[v] + bend * pe[v]);
        partials[0] -= share * inverse_h;
        partials[2] -= ((0.5 - share) * flux.rise - share * self.psi) * inverse_h * inverse_h;
        (partials, share)
    }
}

/// Mean of the exponential profile between centre and face as a share of its whole rise, and the
/// derivative by Pe: (1 − B)/Pe towards a face the wind blows to. Where the wind comes from the face
/// the profile is that of the slope in [`HalfCell::rise`], so the share goes back to 1/2; the bend in
/// between keeps the derivative continuous.
#[inline]
fn layer(flux: &HalfFlux) -> (f64, f64) {
    let pe = flux.pe;
    if pe <= 0.0 {
        let q = 1.0 / (1.0 + pe * pe);
        (0.5 - pe * q / 12.0, -q * q * (1.0 - pe * pe) / 12.0)
    } else if pe < 0.02 {
        let q = pe * pe;
        (0.5 - pe / 12.0 * (1.0 - q / 60.0), -1.0 / 12.0 + q / 240.0)
    } else {
        let share = (1.0 - flux.b) / pe;
        let b_slope = flux.b * (1.0 - flux.b - pe) / pe;
        (share, -(b_slope + share) / pe)
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
        for wind in [-60.0, -3.0, 0.0, 0.001, 0.05, 5.0, 80.0, 4000.0] {
            for (h_face, psi_behind) in [(0.7, 1.2), (1.0, 2.5), (1.3, 1.9)] {
                let p = 1.2;
                let make = |v: [f64; 4]| HalfCell {
                    psi: v[0],
                    psi_behind: v[1],
                    reach: 0.45,
                    g: v[0] + 3.0 + 0.2 * v[0] * v[0],
                    g_slope: 1.0 + 0.4 * v[0],
                    h_centre: v[2],
                    h_face: v[3],
                    inverse_distance: 4.0,
                    wind,
                };
                let at = [1.7, psi_behind, 1.0, h_face];
                let cell = make(at);
                let flux = cell.flux();
                let partials = cell.partials(&flux, p);
                let (by, excess_by, by_p) = (partials.flux, partials.excess, partials.excess_by_p);
                let values = |v: [f64; 4], p: f64| {
                    let cell = make(v);
                    let flux = cell.flux();
                    [flux.alpha - flux.beta * p, cell.mean_excess(&flux, p)]
                };
                let e = 1e-6;
                for k in 0..4 {
                    let (mut plus, mut minus) = (at, at);
                    plus[k] += e;
                    minus[k] -= e;
                    let (plus, minus) = (values(plus, p), values(minus, p));
                    for (f, analytic) in [by[k], excess_by[k]].into_iter().enumerate() {
                        let numeric = (plus[f] - minus[f]) / (2.0 * e);
                        let scale = 1.0 + numeric.abs() + 1e-3 * wind.abs();
                        assert!(
                            (analytic - numeric).abs() < 1e-6 * scale,
                            "wind {wind} h_face {h_face} variable {k} value {f}: {analytic} {numeric}"
                        );
                    }
                }
                let numeric = (values(at, p + e)[1] - values(at, p - e)[1]) / (2.0 * e);
                assert!((by_p - numeric).abs() < 1e-6);
            }
        }
    }
}
