//! Fluxes and loads of a block of cell faces, with their derivatives by pressure state and attitude.
//!
//! The face pressure is eliminated. A change on one side reaches the flux through the other side's share of β, and the
//! face pressure through 1/(β_up + β_down).

use super::faces::{BLOCK, Block};
use super::film::Film;
use super::flux::HalfPartials;
use super::heights::{inverses, inverses_of_both};
use super::state::SideBlock;

/// Derivatives by attitude of the heights of a block of faces and of the cells on either side.
pub(super) struct Arms {
    pub(super) face: [Block; 3],
    pub(super) up: [Block; 3],
    pub(super) down: [Block; 3],
}

/// Derivatives by (h_c, pitch, roll) of the heights at (x, y) from the slider's centre.
#[inline(always)]
pub(super) fn height_by_attitude([x, y]: [&Block; 2]) -> [Block; 3] {
    let mut by_pitch = [0.0; BLOCK];
    for k in 0..BLOCK {
        by_pitch[k] = -x[k];
    }
    [[1.0; BLOCK], by_pitch, *y]
}

/// Fluxes and loads of a block with their derivatives: by ψ of the up cell, of the down cell
/// and of the cell behind the up cell, and by attitude.
pub(super) struct FaceDerivatives {
    pub(super) flux: Block,
    pub(super) flux_by_psi: [Block; 3],
    pub(super) flux_by_attitude: [Block; 3],
    pub(super) load: Block,
    pub(super) load_by_psi: [Block; 3],
    pub(super) load_by_attitude: [Block; 3],
    /// Of flux and load by G of either half cell.
    by_g: [[Block; 2]; 2],
}

impl FaceDerivatives {
    #[inline(always)]
    pub(super) fn zero() -> Self {
        Self {
            flux: [0.0; BLOCK],
            flux_by_psi: [[0.0; BLOCK]; 3],
            flux_by_attitude: [[0.0; BLOCK]; 3],
            load: [0.0; BLOCK],
            load_by_psi: [[0.0; BLOCK]; 3],
            load_by_attitude: [[0.0; BLOCK]; 3],
            by_g: [[[0.0; BLOCK]; 2]; 2],
        }
    }

    /// Sets face k from its sides.
    #[inline(always)]
    fn set(&mut self, k: usize, [up, down]: [&SideDerivatives; 2], load_by_p: f64, arms: &Arms) {
        let (up_flux, up_load) = up.reaching(load_by_p);
        let (down_flux, down_load) = down.reaching(load_by_p);
        self.flux_by_psi[0][k] = up_flux[0];
        self.flux_by_psi[1][k] = down_flux[0];
        self.flux_by_psi[2][k] = up_flux[1];
        self.load_by_psi[0][k] = up_load[0];
        self.load_by_psi[1][k] = down_load[0];
        self.load_by_psi[2][k] = up_load[1];
        for (s, side) in [up, down].into_iter().enumerate() {
            let [flux, excess] = side.partials.by_g;
            self.by_g[0][s][k] = side.share * flux;
            self.by_g[1][s][k] = side.area * excess + load_by_p * flux;
        }
        let height = [up.slopes, down.slopes];
        for q in 0..3 {
            let face = arms.face[q][k];
            let at = [height[0][0] * arms.up[q][k], height[1][0] * arms.down[q][k]];
            let at_face = [height[0][1] * face, height[1][1] * face];
            self.flux_by_attitude[q][k] = (up_flux[2] * at[0] + up_flux[3] * at_face[0])
                + (down_flux[2] * at[1] + down_flux[3] * at_face[1]);
            self.load_by_attitude[q][k] = (up_load[2] * at[0] + up_load[3] * at_face[0])
                + (down_load[2] * at[1] + down_load[3] * at_face[1]);
        }
    }
}

impl FaceDerivatives {
    /// Adds what reaches faces through G by ψ across them.
    #[inline(always)]
    pub(super) fn add_across(
        &mut self,
        [up, down]: [&SideBlock<'_>; 2],
        step: &Block,
        arms: &Arms,
    ) {
        let (Some(up_by), Some(down_by)) = (up.by_across, down.by_across) else {
            return;
        };
        // Derivatives of the other side's G by a side's ψ, of its own G and of the other's by its height. At a step a side's
        // pressure acts on the other's G; it falls with the side's own height at constant ψ.
        let [mut by_psi, mut own_by_height, mut other_by_height] = [[[0.0; BLOCK]; 2]; 3];
        let sides = [(up, down, up_by, down_by), (down, up, down_by, up_by)];
        for (s, (side, other, own_by, other_by)) in sides.into_iter().enumerate() {
            for k in 0..BLOCK {
                let slope = step[k] * side.h_slope(k);
                by_psi[s][k] = other_by[k] * side.height_ratio(other, step, k);
                own_by_height[s][k] = slope * (own_by[k] * other.p(k));
                other_by_height[s][k] = -slope * (by_psi[s][k] * side.p(k));
            }
        }
        let quantities = [
            (&mut self.flux_by_psi, &mut self.flux_by_attitude),
            (&mut self.load_by_psi, &mut self.load_by_attitude),
        ];
        for ((to_psi, to_attitude), by_g) in quantities.into_iter().zip(&self.by_g) {
            for (s, arms) in [&arms.up, &arms.down].into_iter().enumerate() {
                let (own, other) = (&by_g[s], &by_g[1 - s]);
                let mut by_height = [0.0; BLOCK];
                for k in 0..BLOCK {
                    to_psi[s][k] += other[k] * by_psi[s][k];
                    by_height[k] = own[k] * own_by_height[s][k] + other[k] * other_by_height[s][k];
                }
                for q in 0..3 {
                    for k in 0..BLOCK {
                        to_attitude[q][k] += by_height[k] * arms[q][k];
                    }
                }
            }
        }
    }

    /// The same on the slider's edge, where the pressure is `p` and `h_slope` the derivative of the height that the film
    /// sees by the true one.
    #[inline(always)]
    pub(super) fn add_across_edge(
        &mut self,
        p: f64,
        side: &SideBlock<'_>,
        h_slope: &Block,
        arms: &Arms,
    ) {
        let Some(by_across) = side.by_across else {
            return;
        };
        for (k, h_slope) in h_slope.iter().enumerate() {
            for q in 0..3 {
                let at = by_across[k] * p * h_slope * arms.face[q][k];
                self.flux_by_attitude[q][k] += self.by_g[0][0][k] * at;
                self.load_by_attitude[q][k] += self.by_g[1][0][k] * at;
            }
        }
    }
}

/// What a side contributes to a face's derivatives.
struct SideDerivatives {
    partials: HalfPartials,
    /// The part of a change of the side's α − β p that reaches the flux.
    share: f64,
    area: f64,
    /// Derivatives of the limited height by the true height, at the centre and at the face.
    slopes: [f64; 2],
}

impl SideDerivatives {
    /// Derivatives of flux and load by the side's own four numbers, with the face pressure following.
    #[inline(always)]
    fn reaching(&self, load_by_p: f64) -> ([f64; 4], [f64; 4]) {
        let (flux, excess) = (&self.partials.flux, &self.partials.excess);
        let (mut by, mut load) = ([0.0; 4], [0.0; 4]);
        for v in 0..4 {
            by[v] = self.share * flux[v];
            load[v] = self.area * excess[v] + load_by_p * flux[v];
        }
        (by, load)
    }
}

/// Both sides of a face joined.
#[inline(always)]
fn join(
    all: &mut FaceDerivatives,
    k: usize,
    [up, down]: [(HalfPartials, f64, f64, f64, [f64; 2]); 2],
    inverse_total: f64,
    length: f64,
    arms: &Arms,
) {
    let (up, up_beta, up_excess, up_area, up_slopes) = up;
    let (down, down_beta, down_excess, down_area, down_slopes) = down;
    all.load[k] = up_area * up_excess + down_area * down_excess;
    let load_by_p = inverse_total * (up_area * up.excess_by_p + down_area * down.excess_by_p);
    let up = SideDerivatives {
        partials: up,
        share: length * down_beta * inverse_total,
        area: up_area,
        slopes: up_slopes,
    };
    let down = SideDerivatives {
        partials: down,
        share: -length * up_beta * inverse_total,
        area: down_area,
        slopes: down_slopes,
    };
    all.set(k, [&up, &down], load_by_p, arms);
}

#[inline(always)]
pub(super) fn windy<const STEEP: bool>(
    all: &mut FaceDerivatives,
    up: &SideBlock<'_>,
    down: &SideBlock<'_>,
    [[h_up, slope_up], [h_down, slope_down]]: &[[Block; 2]; 2],
    length: &Block,
    arms: &Arms,
) {
    for k in 0..BLOCK {
        let [u, d] = inverses_of_both([up.h(k), down.h(k)], [h_up[k], h_down[k]]);
        let (u, d) = (up.half(k, h_up[k], u), down.half(k, h_down[k], d));
        let (mean_up, mean_down) = (u.logarithmic_mean::<STEEP>(), d.logarithmic_mean::<STEEP>());
        let (a, b) = (u.flux::<true>(&mean_up), d.flux::<false>(&mean_down));
        let total = a.beta + b.beta;
        let p = (a.alpha + b.alpha) / total;
        all.flux[k] = length[k] * (a.alpha - a.beta * p);
        join(
            all,
            k,
            [
                (
                    u.partials::<true>(&mean_up, &a, p),
                    a.beta,
                    u.mean_excess::<true>(&a, p),
                    up.area[k],
                    [up.h_slope(k), slope_up[k]],
                ),
                (
                    d.partials::<false>(&mean_down, &b, p),
                    b.beta,
                    d.mean_excess::<false>(&b, p),
                    down.area[k],
                    [down.h_slope(k), slope_down[k]],
                ),
            ],
            1.0 / total,
            length[k],
            arms,
        );
    }
}

#[inline(always)]
pub(super) fn still(
    all: &mut FaceDerivatives,
    up: &SideBlock<'_>,
    down: &SideBlock<'_>,
    [[h_up, slope_up], [h_down, slope_down]]: &[[Block; 2]; 2],
    length: &Block,
    arms: &Arms,
) {
    for k in 0..BLOCK {
        let (u, d) = (up.bare_half(k, h_up[k]), down.bare_half(k, h_down[k]));
        let ((alpha_up, beta_up), (alpha_down, beta_down)) = (u.still(), d.still());
        let total = beta_up + beta_down;
        let p = (alpha_up + alpha_down) / total;
        all.flux[k] = length[k] * (alpha_up - beta_up * p);
        join(
            all,
            k,
            [
                (
                    u.still_partials(p),
                    beta_up,
                    u.still_excess(p),
                    up.area[k],
                    [up.h_slope(k), slope_up[k]],
                ),
                (
                    d.still_partials(p),
                    beta_down,
                    d.still_excess(p),
                    down.area[k],
                    [down.h_slope(k), slope_down[k]],
                ),
            ],
            1.0 / total,
            length[k],
            arms,
        );
    }
}

/// Faces on the slider's edge; only the up side contributes.
#[inline(always)]
pub(super) fn edge(
    all: &mut FaceDerivatives,
    film: &Film,
    side: &SideBlock<'_>,
    [h_faces, h_slopes]: &[Block; 2],
    length: &Block,
    arms: &Arms,
) {
    let p = film.ambient_pa;
    for k in 0..BLOCK {
        let (h_face, slope) = (h_faces[k], h_slopes[k]);
        let half = side.half(k, h_face, inverses(side.h(k), h_face));
        let mean = half.logarithmic_mean::<true>();
        let (partials, (alpha, beta), excess) = if side.wind == 0.0 {
            (half.still_partials(p), half.still(), half.still_excess(p))
        } else if side.wind > 0.0 {
            let flux = half.flux::<true>(&mean);
            (
                half.partials::<true>(&mean, &flux, p),
                (flux.alpha, flux.beta),
                half.mean_excess::<true>(&flux, p),
            )
        } else {
            let flux = half.flux::<false>(&mean);
            (
                half.partials::<false>(&mean, &flux, p),
                (flux.alpha, flux.beta),
                half.mean_excess::<false>(&flux, p),
            )
        };
        all.flux[k] = length[k] * (alpha - beta * p);
        all.load[k] = side.area[k] * excess;
        let own = SideDerivatives {
            partials,
            share: length[k],
            area: side.area[k],
            slopes: [side.h_slope(k), slope],
        };
        let nothing = SideDerivatives {
            partials: HalfPartials::NONE,
            share: 0.0,
            area: 0.0,
            slopes: [0.0; 2],
        };
        all.set(k, [&own, &nothing], 0.0, arms);
    }
}
