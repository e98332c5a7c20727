//! Mass flux through one face: two half cells, the face pressure eliminated.
//!
//! With ψ = p h, G = Q ψ and w = 6 μ U_n, the flux per width towards a face is
//!
//! ```text
//! J = w ψ − G h dψ/dn + G ψ dh/dn.
//! ```
//!
//! In the half cell from a cell's centre (ψ_c, h_c) to a face (p_f h_f) at the distance Δ, with G
//! frozen at the centre, the flux is that of the exponential profile (Scharfetter and Gummel 1969):
//!
//! ```text
//! J = α − β p_f,   α = (D/Δ) B(−Pe) ψ_c + V δ,   β = (D/Δ) B(Pe) h_f,   B(x) = x/(eˣ − 1),
//! D = G h̄,   V = w + G (h_f − h_c)/Δ,   Pe = V Δ/D = w Δ/D + ln(h_f/h_c).
//! ```
//!
//! h̄ = (h_f − h_c)/ln(h_f/h_c) makes p = const an exact solution without wind. Pressure is
//! continuous at a face and height is not (an etched step on a face), so the two outward fluxes
//! cancel when p_f = (α_l + α_r)/(β_l + β_r): a step on a face is exact, p h = const is reproduced
//! where convection rules, and D and B being positive the scheme does not oscillate.
//!
//! Where the wind blows towards the face and Pe is large, the exponential profile is flat and would
//! carry the centre's ψ, an error of first order wherever gas leaks out at the sides. δ carries the
//! slope from the cell behind to the face:
//!
//! ```text
//! δ = ψ_c (g(s) − 1),   s = ω Δ/(Δ + Δ_b) (1 − ψ_b/ψ_c),   ω = (1 − Pe/sinh Pe) Pe_w/Pe
//! g(s) = 1 + s (s >= 0),   1/(1 − s) (s < 0)
//! ```
//!
//! g keeps ψ at the face positive whatever the slope; ω leaves diffusion, which the exponential
//! profile resolves, alone. There is no slope across an etched step.
//!
//! The force counts the same profiles: where the wind is nothing, the pressure's mean over a half
//! cell is that of the straight line to p_f; where it rules, ψ changes linearly and a layer of
//! thickness D/V stands at the face the wind blows to. The layers at the pads' trailing edges are
//! less than a micrometre thick and carry about a per cent of the load; no cell resolves them.

/// B(x) = x/(eˣ − 1) and B′(x).
#[inline(always)]
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
    /// Pe and B(Pe).
    pe: f64,
    b: f64,
    /// The wind's part of Pe.
    blow: f64,
    /// δ and its derivatives by ψ, by ψ behind, by Pe and by the wind's part of it.
    rise: f64,
    rise_by: [f64; 4],
    /// Logarithmic mean of the heights, and its derivatives by h_centre and h_face.
    mean: [f64; 3],
    /// (D/Δ) B(Pe), (D/Δ) B′(Pe) and D/Δ.
    k: f64,
    k_slope: f64,
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
    #[inline(always)]
    pub(super) fn flux(&self) -> HalfFlux {
        let (mean, log_ratio) = logarithmic_mean(self.h_centre, self.h_face);
        let conductance = self.g * mean[0] * self.inverse_distance;
        let blow = self.wind / conductance;
        let pe = blow + log_ratio;
        let (b, b_slope) = bernoulli(pe);
        let k = conductance * b;
        let (rise, rise_by) = if self.reach > 0.0 {
            self.rise(pe, blow, b)
        } else {
            (0.0, [0.0; 4])
        };
        HalfFlux {
            alpha: k * self.psi + conductance * pe * (self.psi + rise),
            beta: (k * self.h_face).max(SMALLEST_BETA),
            pe,
            b,
            blow,
            rise,
            rise_by,
            mean,
            k,
            k_slope: conductance * b_slope,
            conductance,
        }
    }

    /// α and β without wind, where the exponential profile is J = G h_c h_f/Δ (ψ/h_c − p): what
    /// [`HalfCell::flux`] gives for a wind of 0, without its logarithm and exponential.
    #[inline(always)]
    pub(super) fn still(&self) -> (f64, f64) {
        let c = self.g * self.h_face * self.inverse_distance;
        (c * self.psi, c * self.h_centre)
    }

    /// [`HalfCell::mean_excess`] without wind.
    #[inline(always)]
    pub(super) fn still_excess(&self, p: f64) -> f64 {
        0.5 * (p - self.psi / self.h_centre)
    }

    /// δ = ψ (g(s) − 1), s = ω reach (1 − ψ_behind/ψ), ω = (1 − Pe/sinh Pe) Pe_wind/Pe, with
    /// derivatives by ψ, ψ behind, Pe and Pe_wind.
    #[inline(always)]
    fn rise(&self, pe: f64, blow: f64, b: f64) -> (f64, [f64; 4]) {
        let (per_blow, slope) = if pe.abs() < 0.02 {
            let q = pe * pe;
            (
                pe * (1.0 / 6.0 - q * (7.0 / 360.0)),
                1.0 / 6.0 - q * (7.0 / 120.0),
            )
        } else {
            // Pe/sinh(Pe) and coth(Pe) from coth(Pe/2) = 1 + 2/(exp(Pe) − 1).
            let half = 1.0 + 2.0 * b / pe;
            let coth = 0.5 * (half + 1.0 / half);
            let sink = pe * 0.5 * (half - 1.0 / half);
            let per_blow = (1.0 - sink) / pe;
            (per_blow, (sink * (coth - 1.0 / pe) - per_blow) / pe)
        };
        let weight = blow * per_blow;
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
                self.psi * gain_slope * per_weight * blow * slope,
                self.psi * gain_slope * per_weight * per_blow,
            ],
        )
    }

    /// Mean over the half cell of the pressure's excess over its centre.
    #[inline(always)]
    pub(super) fn mean_excess(&self, flux: &HalfFlux, p: f64) -> f64 {
        let centre = self.psi / self.h_centre;
        if self.wind == 0.0 {
            return self.still_excess(p);
        }
        let carried = self.carried_mean(flux, p) * self.mean_inverse_height()[0];
        let convective = flux.blow.abs() * convective_share(flux.pe, flux.b).0;
        0.5 * (1.0 - convective) * (p - centre) + convective * (carried - centre)
    }

    /// Mean of ψ outside the exponential layer.
    #[inline(always)]
    fn carried_mean(&self, flux: &HalfFlux, p: f64) -> f64 {
        if self.wind > 0.0 {
            self.psi + 0.5 * flux.rise
        } else {
            0.5 * (self.psi + p * self.h_face)
        }
    }

    /// Mean of 1/h (Simpson) and its derivatives by h_centre and h_face.
    #[inline(always)]
    fn mean_inverse_height(&self) -> [f64; 3] {
        let (a, b) = (1.0 / self.h_centre, 1.0 / self.h_face);
        let m = 1.0 / (self.h_centre + self.h_face);
        [
            (a + 8.0 * m + b) / 6.0,
            -(a * a + 8.0 * m * m) / 6.0,
            -(b * b + 8.0 * m * m) / 6.0,
        ]
    }

    /// All derivatives at constant face pressure p.
    #[inline(always)]
    pub(super) fn partials(&self, flux: &HalfFlux, p: f64) -> HalfPartials {
        let [mean, mean_centre, mean_face] = flux.mean;
        // Relative derivatives of D/Δ, then those of Pe and its wind part, then of δ.
        let log = [
            self.g_slope / self.g,
            0.0,
            mean_centre / mean,
            mean_face / mean,
        ];
        let blow = log.map(|by| -flux.blow * by);
        let pe = [
            blow[0],
            0.0,
            blow[2] - 1.0 / self.h_centre,
            blow[3] + 1.0 / self.h_face,
        ];
        let [rise_psi, rise_behind, rise_pe, rise_blow] = flux.rise_by;
        let mut rise: Partials = std::array::from_fn(|v| rise_pe * pe[v] + rise_blow * blow[v]);
        rise[0] += rise_psi;
        rise[1] += rise_behind;

        // α − β p = K (ψ − p h_f) + V (ψ + δ) with K = (D/Δ) B(Pe), V = w + G (h_f − h_c)/Δ.
        let g = self.g * self.inverse_distance;
        let g_slope = self.g_slope * self.inverse_distance;
        let drive = self.psi - p * self.h_face;
        let carried = self.psi + flux.rise;
        let velocity = flux.conductance * flux.pe;
        let k = |v: usize| (flux.k * log[v] + flux.k_slope * pe[v]) * drive + velocity * rise[v];
        let by_flux = [
            k(0) + carried * g_slope * (self.h_face - self.h_centre) + flux.k + velocity,
            velocity * rise[1],
            k(2) - carried * g,
            k(3) + carried * g - p * flux.k,
        ];

        let inverse_h = 1.0 / self.h_centre;
        let centre = self.psi * inverse_h;
        let centre_by = [inverse_h, -centre * inverse_h];
        if self.wind == 0.0 {
            return HalfPartials {
                flux: by_flux,
                excess: [-0.5 * centre_by[0], 0.0, -0.5 * centre_by[1], 0.0],
                excess_by_p: 0.5,
            };
        }
        let (per_blow, per_blow_slope) = convective_share(flux.pe, flux.b);
        let strength = flux.blow.abs();
        let convective = strength * per_blow;
        let [q, q_centre, q_face] = self.mean_inverse_height();
        let mean_psi = self.carried_mean(flux, p);
        let gain = mean_psi * q - 0.5 * (p + centre);
        let at_centre = 0.5 * (1.0 + convective);
        let (mean_by, mean_by_p) = if self.wind > 0.0 {
            (
                [
                    1.0 + 0.5 * rise[0],
                    0.5 * rise[1],
                    0.5 * rise[2],
                    0.5 * rise[3],
                ],
                0.0,
            )
        } else {
            ([0.5, 0.0, 0.0, 0.5 * p], 0.5 * self.h_face)
        };
        let sign = flux.blow.signum();
        let part = |v: usize| {
            gain * (strength * per_blow_slope * pe[v] + sign * per_blow * blow[v])
                + convective * q * mean_by[v]
        };
        HalfPartials {
            flux: by_flux,
            excess: [
                part(0) - at_centre * centre_by[0],
                part(1),
                part(2) - at_centre * centre_by[1] + convective * mean_psi * q_centre,
                part(3) + convective * mean_psi * q_face,
            ],
            excess_by_p: 0.5 * (1.0 - convective) + convective * q * mean_by_p,
        }
    }
}

/// Logarithmic mean of two heights with its derivatives by both, and ln(h_face/h_centre).
#[inline(always)]
fn logarithmic_mean(h_centre: f64, h_face: f64) -> ([f64; 3], f64) {
    let sum = h_centre + h_face;
    let s = (h_face - h_centre) / sum;
    let q = s * s;
    // s/artanh(s) and its derivative.
    let (ratio, slope, artanh) = if q < 0.0025 {
        let artanh = s * (1.0 + q * (1.0 / 3.0 + q * (0.2 + q * (1.0 / 7.0 + q / 9.0))));
        (
            1.0 - q * (1.0 / 3.0 + q * (4.0 / 45.0 + q * (44.0 / 945.0 + q * 428.0 / 14175.0))),
            -s * (2.0 / 3.0 + q * (16.0 / 45.0 + q * (264.0 / 945.0 + q * 3424.0 / 14175.0))),
            artanh,
        )
    } else {
        let artanh = 0.5 * (h_face / h_centre).ln();
        let ratio = s / artanh;
        (ratio, (1.0 - ratio / (1.0 - q)) / artanh, artanh)
    };
    let lean = slope / sum;
    (
        [
            0.5 * sum * ratio,
            0.5 * ratio - lean * h_face,
            0.5 * ratio + lean * h_centre,
        ],
        2.0 * artanh,
    )
}

/// (1 − 2 φ)/Pe with φ = (1 − B(Pe))/Pe, the mean of the exponential profile between centre and face
/// as a share of its whole rise; and the derivative by Pe.
#[inline(always)]
fn convective_share(pe: f64, b: f64) -> (f64, f64) {
    if pe.abs() < 0.05 {
        let q = pe * pe;
        (
            1.0 / 6.0 - q * (1.0 / 360.0 - q / 15120.0),
            -pe * (1.0 / 180.0 - q / 3780.0),
        )
    } else {
        let inverse = 1.0 / pe;
        let layer = (1.0 - b) * inverse;
        let b_slope = b * (1.0 - b - pe) * inverse;
        let layer_slope = -(b_slope + layer) * inverse;
        let share = (1.0 - 2.0 * layer) * inverse;
        (share, -(2.0 * layer_slope + share) * inverse)
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
    fn without_wind_the_short_form_is_the_general_one() {
        for h_face in [0.02, 0.7, 0.999_999, 1.0, 1.3, 40.0] {
            let cell = HalfCell {
                psi: 1.7,
                psi_behind: 1.1,
                reach: 0.0,
                g: 2.3,
                g_slope: 0.4,
                h_centre: 1.0,
                h_face,
                inverse_distance: 3.0,
                wind: 0.0,
            };
            let (general, (alpha, beta)) = (cell.flux(), cell.still());
            assert!((general.alpha / alpha - 1.0).abs() < 1e-13, "{h_face}");
            assert!((general.beta / beta - 1.0).abs() < 1e-13, "{h_face}");
        }
    }

    #[test]
    fn half_cell_derivatives_match_differences() {
        for wind in [
            -4000.0, -60.0, -3.0, -0.05, 0.0, 0.001, 0.05, 5.0, 80.0, 4000.0,
        ] {
            for (h_face, psi_behind) in [(0.7, 1.2), (1.0, 2.5), (1.3, 1.9)] {
                let p = 1.2;
                let make = |v: [f64; 4]| HalfCell {
                    psi: v[0],
                    psi_behind: v[1],
                    reach: if wind > 0.0 { 0.45 } else { 0.0 },
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
