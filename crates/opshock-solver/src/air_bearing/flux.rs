//! Mass flux through one face of the film's grid, from two half cells with the face pressure eliminated.
//!
//! With ψ = p h, G = Q ψ and w = 6 μ U_n, the flux per width towards a face is
//!
//! ```text
//! J = w ψ − G h dψ/dn + G ψ dh/dn.
//! ```
//!
//! In the half cell from a cell's centre (ψ_c, h_c) to a face (p_f h_f) at the distance Δ, with constant G, the flux is
//! that of the exponential profile (Scharfetter and Gummel 1969):
//!
//! ```text
//! J = α − β p_f,   α = (D/Δ) B(−Pe) ψ_c + V δ,   β = (D/Δ) B(Pe) h_f,   B(x) = x/(eˣ − 1),
//! D = G h̄,   V = w + G (h_f − h_c)/Δ,   Pe = V Δ/D = w Δ/D + ln(h_f/h_c).
//! ```
//!
//! h̄ = (h_f − h_c)/ln(h_f/h_c) makes p = const an exact solution without wind. Pressure is continuous at a face;
//! height is not, where an etched step lies on the face. The two outward fluxes cancel when p_f = (α_l + α_r)/(β_l +
//! β_r). A step on a face is therefore exact, p h = const is reproduced where convection dominates, and the scheme does
//! not oscillate because D and B are positive.
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
//! g keeps ψ at the face positive for any slope. ω leaves diffusion unchanged, which the exponential profile resolves.
//! There is no slope across an etched step.
//!
//! With G = G(ψ_c) everywhere J is not monotone. Without wind it is G(ψ_c) (ψ_c − ψ_f)/Δ where the height is
//! constant, which grows with ψ_c only where ψ_f − ψ_c < G/G′. In front of a pad's inlet p_f is up to ten times p_c. Without
//! slip (G = ψ) or with little of it, an emptier cell then lets less gas flow back from the pad and stays empty: a film
//! has several steady states. With ψ_o at the centre across the face, behind an etched step p_o h_c, at the slider's edge
//! p_a h_f, G is therefore
//!
//! ```text
//! with slip       max(G(ψ_c), (ψ_o − ψ_c + G(ψ_c))/2)
//! without slip    (ψ_c + ψ_o)/2
//! ```
//!
//! The first is G(ψ_c) up to ψ_o − ψ_c = G; from there on J grows with ψ_c as well, because 1 − G′ is not negative in any model.
//! The second gives the exact flux of p² without wind, and the gas that a layer at a trailing edge lacks, where p_f =
//! p_o, h (ψ_c² − ψ_f²)/(2 w).
//!
//! The force integrates the same profiles. Without wind, the mean pressure over a half cell is that of the straight
//! line to p_f. Where the wind dominates, ψ changes linearly and a layer of thickness D/V stands at the face that the
//! wind blows to. The layers at the pads' trailing edges are less than a micrometre thick and carry about 1 % of the
//! load; no cell resolves them.
//!
//! Everything here maps numbers to numbers without calls, and both branches of every choice are cheap, so that loops
//! over faces compile to vector instructions ([`crate::lanes`]). A single call, even of `map`, prevents that for a
//! whole loop. `UP` says that the wind blows towards the face; else it blows away from it.

use super::exponential::{Profile, SMALL, convective_share, growth, profile};
use super::heights::LogarithmicMean;

/// What a half cell is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfCell {
    /// ψ at the centre, Pa m, and its inverse.
    pub(super) psi: f64,
    pub(super) inverse_psi: f64,
    /// ψ in the next cell away from the face, Pa m.
    pub(super) psi_behind: f64,
    /// Δ over the distance to that cell's centre; 0 where the film has a step in between or where
    /// there is no such cell.
    pub(super) reach: f64,
    /// G, its inverse, and its derivative by ψ.
    pub(super) g: f64,
    pub(super) inverse_g: f64,
    pub(super) g_slope: f64,
    /// Height at the centre, its inverse, and the height at this side of the face, m.
    pub(super) h_centre: f64,
    pub(super) inverse_h: f64,
    pub(super) h_face: f64,
    /// As from [`super::heights::inverses`]; not used without wind.
    pub(super) inverses: [f64; 2],
    /// Δ, m, and its inverse.
    pub(super) distance: f64,
    pub(super) inverse_distance: f64,
    /// 6 μ U · (outward normal), Pa s · m/s.
    pub(super) wind: f64,
}

/// What drives gas through a half cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drive {
    /// D/Δ.
    pub(super) conductance: f64,
    /// The wind's part of Pe.
    pub(super) blow: f64,
    /// Pe.
    pub(super) pe: f64,
}

/// α, β of a half cell and what its derivatives share.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfFlux {
    pub(super) alpha: f64,
    pub(super) beta: f64,
    /// Pe, 1/Pe and B(Pe).
    pe: f64,
    inverse_pe: f64,
    b: f64,
    /// The wind's part of Pe.
    blow: f64,
    /// δ and its derivatives by ψ, by ψ behind, by Pe and by the wind's part of it.
    pub(super) rise: f64,
    rise_by: [f64; 4],
    /// (D/Δ) B(Pe), (D/Δ) B′(Pe) and D/Δ.
    k: f64,
    k_slope: f64,
    conductance: f64,
}

/// Smallest β: keeps the face pressure finite where the wind blows away from the face on both sides.
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
    /// Of both by G.
    pub(super) by_g: [f64; 2],
}

impl HalfPartials {
    /// All derivatives zero.
    pub(super) const NONE: Self = Self {
        flux: [0.0; 4],
        excess: [0.0; 4],
        excess_by_p: 0.0,
        by_g: [0.0; 2],
    };
}

impl HalfCell {
    /// α and β whatever the wind.
    pub(super) fn coefficients(&self) -> (f64, f64) {
        if self.wind == 0.0 {
            return self.still();
        }
        let flux = if self.wind > 0.0 {
            self.flux::<true>(&self.logarithmic_mean::<true>())
        } else {
            self.flux::<false>(&self.logarithmic_mean::<true>())
        };
        (flux.alpha, flux.beta)
    }

    /// What drives the gas over heights of the logarithmic mean `mean`.
    #[inline(always)]
    pub(super) fn drive(&self, mean: &LogarithmicMean) -> Drive {
        let blow = (self.wind * self.distance) * (self.inverse_g * mean.inverse);
        Drive {
            conductance: self.g * mean.value * self.inverse_distance,
            blow,
            pe: blow + mean.log_ratio,
        }
    }

    /// Outward flux coefficients with wind over heights of the logarithmic mean `mean`.
    #[inline(always)]
    pub(super) fn flux<const UP: bool>(&self, mean: &LogarithmicMean) -> HalfFlux {
        let drive = self.drive(mean);
        self.driven::<UP>(&drive, growth(drive.pe))
    }

    /// The same by `drive`, of which `e` is the [`growth`] of Pe.
    #[inline(always)]
    pub(super) fn driven<const UP: bool>(&self, drive: &Drive, e: f64) -> HalfFlux {
        let Drive {
            conductance,
            blow,
            pe,
        } = *drive;
        let profile = profile::<UP>(pe, e);
        let k = conductance * profile.b;
        let (rise, rise_by) = if UP {
            self.rise(pe, &profile, blow)
        } else {
            (0.0, [0.0; 4])
        };
        let beta = k * self.h_face;
        HalfFlux {
            alpha: k.mul_add(self.psi, conductance * pe * (self.psi + rise)),
            beta: if beta > SMALLEST_BETA {
                beta
            } else {
                SMALLEST_BETA
            },
            pe,
            inverse_pe: profile.inverse_pe,
            b: profile.b,
            blow,
            rise,
            rise_by,
            k,
            k_slope: conductance * profile.b_slope,
            conductance,
        }
    }

    /// α and β without wind, where the exponential profile is J = G h_c h_f/Δ (ψ/h_c − p): what
    /// [`HalfCell::flux`] tends to as the wind falls to 0.
    #[inline(always)]
    pub(super) fn still(&self) -> (f64, f64) {
        let c = self.g * self.h_face * self.inverse_distance;
        (c * self.psi, c * self.h_centre)
    }

    /// [`HalfCell::mean_excess`] without wind.
    #[inline(always)]
    pub(super) fn still_excess(&self, p: f64) -> f64 {
        0.5 * (p - self.psi * self.inverse_h)
    }

    /// [`HalfCell::partials`] without wind: J = c (ψ − h_c p) with c = G h_f/Δ.
    #[inline(always)]
    pub(super) fn still_partials(&self, p: f64) -> HalfPartials {
        let per_g = self.h_face * self.inverse_distance;
        let drive = self.psi - self.h_centre * p;
        let c = self.g * per_g;
        HalfPartials {
            flux: [
                c + self.g_slope * per_g * drive,
                0.0,
                -c * p,
                self.g * self.inverse_distance * drive,
            ],
            excess: [
                -0.5 * self.inverse_h,
                0.0,
                0.5 * self.psi * self.inverse_h * self.inverse_h,
                0.0,
            ],
            excess_by_p: 0.5,
            by_g: [per_g * drive, 0.0],
        }
    }

    /// δ = ψ (g(s) − 1), s = ω reach (1 − ψ_behind/ψ), ω = (1 − Pe/sinh Pe) Pe_wind/Pe, with
    /// derivatives by ψ, ψ behind, Pe and Pe_wind.
    #[inline(always)]
    fn rise(&self, pe: f64, profile: &Profile, blow: f64) -> (f64, [f64; 4]) {
        let Profile {
            r,
            inverse_pe,
            inverse_half,
            ..
        } = *profile;
        let q = pe * pe;
        let near = pe * q.mul_add(-7.0 / 360.0, 1.0 / 6.0);
        let near_slope = q.mul_add(-7.0 / 120.0, 1.0 / 6.0);
        // Pe/sinh(Pe) and coth(Pe) from coth(Pe/2) = 1 + 2/(exp(Pe) − 1).
        let half = r.mul_add(2.0, 1.0);
        let coth = 0.5 * (half + inverse_half);
        let sink = pe * 0.5 * (half - inverse_half);
        let far = (1.0 - sink) * inverse_pe;
        let far_slope = sink.mul_add(coth - inverse_pe, -far) * inverse_pe;
        let small = pe.abs() < SMALL;
        let per_blow = if small { near } else { far };
        let slope = if small { near_slope } else { far_slope };
        let weight = blow * per_blow;
        let ratio = self.psi_behind * self.inverse_psi;
        let per_weight = self.reach * (1.0 - ratio);
        let s = weight * per_weight;
        let down = 1.0 / (1.0 - s);
        let rising = s >= 0.0;
        let gain = if rising { s } else { s * down };
        let gain_slope = if rising { 1.0 } else { down * down };
        let lever = gain_slope * weight * self.reach;
        (
            self.psi * gain,
            [
                lever.mul_add(ratio, gain),
                -lever,
                self.psi * gain_slope * per_weight * blow * slope,
                self.psi * gain_slope * per_weight * per_blow,
            ],
        )
    }

    /// Mean over the half cell of the pressure's excess over its centre, with wind.
    #[inline(always)]
    pub(super) fn mean_excess<const UP: bool>(&self, flux: &HalfFlux, p: f64) -> f64 {
        let per_height = self.mean_inverse_height()[0];
        self.excess::<UP>((flux.rise, flux.convective::<UP>()), per_height, p)
    }

    /// The same of δ with the convective share of the profile, and the mean of 1/h.
    #[inline(always)]
    pub(super) fn excess<const UP: bool>(
        &self,
        (rise, convective): (f64, f64),
        per_height: f64,
        p: f64,
    ) -> f64 {
        let over = |p: f64| (-self.psi).mul_add(self.inverse_h, p);
        let carried = self.carried_mean::<UP>(rise, p) * per_height;
        convective.mul_add(over(carried), 0.5 * (1.0 - convective) * over(p))
    }

    /// Mean of ψ outside the exponential layer.
    #[inline(always)]
    fn carried_mean<const UP: bool>(&self, rise: f64, p: f64) -> f64 {
        if UP {
            rise.mul_add(0.5, self.psi)
        } else {
            0.5 * p.mul_add(self.h_face, self.psi)
        }
    }

    /// Mean of 1/h (Simpson) and its derivatives by h_centre and h_face.
    #[inline(always)]
    pub(super) fn mean_inverse_height(&self) -> [f64; 3] {
        let (a, [m, b]) = (self.inverse_h, self.inverses);
        [
            (m.mul_add(8.0, a) + b) * (1.0 / 6.0),
            (a * a + 8.0 * m * m) * (-1.0 / 6.0),
            (b * b + 8.0 * m * m) * (-1.0 / 6.0),
        ]
    }

    /// As [`LogarithmicMean::new`].
    #[inline(always)]
    pub(super) fn logarithmic_mean<const STEEP: bool>(&self) -> LogarithmicMean {
        let (heights, inverse_sum) = ([self.h_centre, self.h_face], self.inverses[0]);
        LogarithmicMean::new::<STEEP>(heights, self.inverse_h, inverse_sum)
    }

    /// All derivatives at constant face pressure p, with wind; `flux` is that of `mean`.
    #[inline(always)]
    pub(super) fn partials<const UP: bool>(
        &self,
        mean: &LogarithmicMean,
        flux: &HalfFlux,
        p: f64,
    ) -> HalfPartials {
        let (inverse_mean, [mean_centre, mean_face]) = (mean.inverse, mean.by);
        let inverse_face = self.inverses[1];
        // Relative derivatives of D/Δ, then those of Pe and its wind part, then of δ.
        let log = [
            self.g_slope * self.inverse_g,
            0.0,
            mean_centre * inverse_mean,
            mean_face * inverse_mean,
        ];
        let mut blow = [0.0; 4];
        for v in 0..4 {
            blow[v] = -flux.blow * log[v];
        }
        let pe = [
            blow[0],
            0.0,
            blow[2] - self.inverse_h,
            blow[3] + inverse_face,
        ];
        let [rise_psi, rise_behind, rise_pe, rise_blow] = flux.rise_by;
        let mut rise = [rise_psi, rise_behind, 0.0, 0.0];
        for v in 0..4 {
            rise[v] += rise_pe * pe[v] + rise_blow * blow[v];
        }

        // α − β p = K (ψ − p h_f) + V (ψ + δ) with K = (D/Δ) B(Pe), V = w + G (h_f − h_c)/Δ.
        let g = self.g * self.inverse_distance;
        let g_slope = self.g_slope * self.inverse_distance;
        let drive = self.psi - p * self.h_face;
        let carried = self.psi + flux.rise;
        let velocity = flux.conductance * flux.pe;
        let mut k = [0.0; 4];
        for v in 0..4 {
            k[v] = (flux.k * log[v] + flux.k_slope * pe[v]) * drive + velocity * rise[v];
        }
        let by_flux = [
            k[0] + carried * g_slope * (self.h_face - self.h_centre) + flux.k + velocity,
            velocity * rise[1],
            k[2] - carried * g,
            k[3] + carried * g - p * flux.k,
        ];

        let centre = self.psi * self.inverse_h;
        let centre_by = [self.inverse_h, -centre * self.inverse_h];
        let [per_blow, per_blow_slope] = convective_share(flux.pe, flux.inverse_pe, flux.b);
        let strength = strength::<UP>(flux);
        let convective = strength * per_blow;
        let [q, q_centre, q_face] = self.mean_inverse_height();
        let mean_psi = self.carried_mean::<UP>(flux.rise, p);
        let gain = mean_psi * q - 0.5 * (p + centre);
        let at_centre = 0.5 * (1.0 + convective);
        let (mean_by, mean_by_p) = if UP {
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
        let signed = if UP { per_blow } else { -per_blow };
        let mut part = [0.0; 4];
        for v in 0..4 {
            part[v] = gain * (strength * per_blow_slope * pe[v] + signed * blow[v])
                + convective * q * mean_by[v];
        }
        let pe_by_g = -flux.blow * self.inverse_g;
        let rise_by_g = (rise_pe + rise_blow) * pe_by_g;
        let k_by_g = flux.k.mul_add(self.inverse_g, flux.k_slope * pe_by_g);
        let lean = (self.h_face - self.h_centre) * self.inverse_distance;
        let mean_by_g = if UP { 0.5 * rise_by_g } else { 0.0 };
        let by_g = [
            k_by_g * drive + velocity * rise_by_g + carried * lean,
            gain * (strength * per_blow_slope + signed) * pe_by_g + convective * q * mean_by_g,
        ];
        HalfPartials {
            by_g,
            flux: by_flux,
            excess: [
                part[0] - at_centre * centre_by[0],
                part[1],
                part[2] - at_centre * centre_by[1] + convective * mean_psi * q_centre,
                part[3] + convective * mean_psi * q_face,
            ],
            excess_by_p: 0.5 * (1.0 - convective) + convective * q * mean_by_p,
        }
    }
}

impl HalfFlux {
    /// Share of the exponential profile in the mean pressure.
    #[inline(always)]
    pub(super) fn convective<const UP: bool>(&self) -> f64 {
        strength::<UP>(self) * convective_share(self.pe, self.inverse_pe, self.b)[0]
    }
}

/// |Pe_wind|.
#[inline(always)]
fn strength<const UP: bool>(flux: &HalfFlux) -> f64 {
    if UP { flux.blow } else { -flux.blow }
}

#[cfg(test)]
mod tests;
