//! Derivatives of the flux balance and of the force by ψ and attitude.
//!
//! With the face pressure eliminated, a change of one side reaches the flux through the other
//! side's share of β, and the face pressure through 1/(β_up + β_down).

#![expect(
    clippy::needless_range_loop,
    reason = "many columns are walked in step, which an index says plainest"
)]

use super::Attitude;
use super::balance::{Moments, any_steep};
use super::faces::{BLOCK, Block, Interior, block};
use super::film::Film;
use super::flux::HalfPartials;
use super::state::{FilmScratch, Picked, SideBlock};
use crate::lanes::{Kernel, widest};
use crate::linalg::banded::BandMatrix;

/// Residual and derivatives of the flux balance at one state.
#[derive(Clone, Debug)]
pub struct FilmLinearisation {
    /// R, as from [`Film::flux_residual_and_force`]; length n_cells.
    pub residual: Vec<f64>,
    /// dR/dψ.
    pub by_psi: BandMatrix,
    /// dR/d(h_c, pitch, roll); each of length n_cells.
    pub by_attitude: [Vec<f64>; 3],
    /// [F_z, M_pitch, M_roll], as from [`Film::force`].
    pub force: [f64; 3],
    /// Derivatives of each force by every cell's ψ; each of length n_cells.
    pub force_by_psi: [Vec<f64>; 3],
    /// Derivatives of each force by (h_c, pitch, roll) at constant ψ: `[force][q]`.
    pub force_by_attitude: [[f64; 3]; 3],
}

impl FilmLinearisation {
    fn clear(&mut self) {
        self.residual.fill(0.0);
        self.by_psi.clear();
        self.by_attitude.iter_mut().for_each(|c| c.fill(0.0));
        self.force_by_attitude = [[0.0; 3]; 3];
    }
}

impl Film {
    /// Zeroed linearisation of the right shape.
    pub fn linearisation(&self) -> FilmLinearisation {
        let n = self.n_cells();
        FilmLinearisation {
            residual: vec![0.0; n],
            by_psi: BandMatrix::zeros(n, self.mesh.band()),
            by_attitude: [0, 1, 2].map(|_| vec![0.0; n]),
            force: [0.0; 3],
            force_by_psi: [0, 1, 2].map(|_| vec![0.0; n]),
            force_by_attitude: [[0.0; 3]; 3],
        }
    }

    /// R and the force with all their derivatives.
    ///
    /// # Panics
    ///
    /// When `psi`, `out` or `scratch` belong to another film.
    pub fn linearise(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        out: &mut FilmLinearisation,
        scratch: &mut FilmScratch,
    ) {
        assert_eq!(out.residual.len(), self.n_cells());
        widest(Linearise {
            film: self,
            psi,
            attitude,
            out,
            scratch,
        });
    }
}

struct Linearise<'a> {
    film: &'a Film,
    psi: &'a [f64],
    attitude: &'a Attitude,
    out: &'a mut FilmLinearisation,
    scratch: &'a mut FilmScratch,
}

impl Kernel for Linearise<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            film,
            psi,
            attitude,
            out,
            scratch,
        } = self;
        scratch.fill(film, psi, attitude);
        out.clear();
        let mut moments = Moments::default();
        centres(film, scratch, out, &mut moments);
        for faces in &film.columns.interior {
            between_cells(film, attitude, faces, scratch, out, &mut moments);
        }
        on_edges(film, attitude, scratch, out, &mut moments);
        out.force = moments.total();
    }
}

/// Pressures at the centres, each over its whole cell.
#[inline(always)]
fn centres(film: &Film, state: &FilmScratch, out: &mut FilmLinearisation, moments: &mut Moments) {
    let columns = &film.columns;
    for first in (0..columns.area.len()).step_by(BLOCK) {
        let at = columns.front + first;
        let (psi, inverse_h) = (block(&state.psi, at), block(&state.inverse_h, at));
        let (h_slope, area) = (block(&state.h_slope, at), block(&columns.area, first));
        let mut load = [0.0; BLOCK];
        let (mut per_psi, mut per_height) = ([0.0; BLOCK], [0.0; BLOCK]);
        for k in 0..BLOCK {
            load[k] = (psi[k] * inverse_h[k] - film.ambient_pa) * area[k];
            per_psi[k] = area[k] * inverse_h[k];
            per_height[k] = -psi[k] * per_psi[k] * h_slope[k] * inverse_h[k];
        }
        moments.add(&load, &columns.places, first);
        for k in 0..BLOCK.min(columns.n_cells - first) {
            let cell = first + k;
            let arms = [1.0, -columns.places.x[cell], columns.places.y[cell]];
            for f in 0..3 {
                out.force_by_psi[f][cell] = per_psi[k] * arms[f];
                for q in 0..3 {
                    out.force_by_attitude[f][q] += per_height[k] * arms[f] * arms[q];
                }
            }
        }
    }
}

#[inline(always)]
fn between_cells(
    film: &Film,
    attitude: &Attitude,
    faces: &Interior,
    state: &FilmScratch,
    out: &mut FilmLinearisation,
    moments: &mut Moments,
) {
    let columns = &film.columns;
    let front = columns.front;
    for first in (0..faces.length.len()).step_by(BLOCK) {
        let [up, down] = faces.sides(state, first);
        let base = faces.places.heights(first, attitude);
        let faces_at = [
            film.floored_block(&base, up.recess),
            film.floored_block(&base, down.recess),
        ];
        let length = block(&faces.length, first);
        let arms = Arms {
            face: [&faces.places.x, &faces.places.y].map(|c| *block(c, first)),
            up: [&columns.centre_x, &columns.centre_y].map(|c| *block(c, faces.up + first)),
            down: [&columns.centre_x, &columns.centre_y].map(|c| *block(c, faces.down + first)),
        };
        let all = if faces.wind == 0.0 {
            still(&up, &down, &faces_at, length, &arms)
        } else if any_steep(&up, &down, &[faces_at[0][0], faces_at[1][0]], length) {
            windy::<true>(&up, &down, &faces_at, length, &arms)
        } else {
            windy::<false>(&up, &down, &faces_at, length, &arms)
        };
        moments.add(&all.load, &faces.places, first);
        for k in 0..BLOCK {
            if length[k] == 0.0 {
                continue;
            }
            let low = first + k;
            let cells = [
                faces.up + low - front,
                (faces.behind + low).wrapping_sub(front),
                faces.down + low - front,
            ];
            // Without a cell behind, nothing depends on it.
            let has_behind = up.reach[k] > 0.0;
            for (row, sign) in [(low, 1.0), (low + faces.stride, -1.0)] {
                out.residual[row] += sign * all.flux[k];
                for (s, &cell) in cells.iter().enumerate() {
                    if s != 1 || has_behind {
                        out.by_psi.add(row, cell, sign * all.flux_by_psi[s][k]);
                    }
                }
                for q in 0..3 {
                    out.by_attitude[q][row] += sign * all.flux_by_attitude[q][k];
                }
            }
            all.add_force(k, &arms, &cells, has_behind, out);
        }
    }
}

#[inline(always)]
fn on_edges(
    film: &Film,
    attitude: &Attitude,
    state: &FilmScratch,
    out: &mut FilmLinearisation,
    moments: &mut Moments,
) {
    let columns = &film.columns;
    let front = columns.front;
    for faces in &columns.edges {
        for first in (0..faces.length.len()).step_by(BLOCK) {
            let cells = &faces.cells[first..first + BLOCK];
            let behind = &faces.behind[first..first + BLOCK];
            let picked = Picked::new(state, cells, behind, front);
            let side = SideBlock::new(picked.cells(), &faces.side, first, faces.wind);
            let base = faces.places.heights(first, attitude);
            let length = block(&faces.length, first);
            let centre = [&columns.centre_x, &columns.centre_y].map(|column| {
                let mut out = [0.0; BLOCK];
                for (out, cell) in out.iter_mut().zip(cells) {
                    *out = column[front + cell];
                }
                out
            });
            let arms = Arms {
                face: [&faces.places.x, &faces.places.y].map(|c| *block(c, first)),
                up: centre,
                down: centre,
            };
            let all = edge(film, &side, &base, length, &arms);
            moments.add(&all.load, &faces.places, first);
            for k in 0..BLOCK {
                if length[k] == 0.0 {
                    continue;
                }
                let (row, has_behind) = (cells[k], side.reach[k] > 0.0);
                out.residual[row] += all.flux[k];
                out.by_psi.add(row, row, all.flux_by_psi[0][k]);
                if has_behind {
                    out.by_psi.add(row, behind[k], all.flux_by_psi[1][k]);
                }
                for q in 0..3 {
                    out.by_attitude[q][row] += all.flux_by_attitude[q][k];
                }
                all.add_force(k, &arms, &[row, behind[k], row], has_behind, out);
            }
        }
    }
}

/// x and y of a block of faces and of the cells on either side, from the slider's centre.
struct Arms {
    face: [Block; 2],
    up: [Block; 2],
    down: [Block; 2],
}

/// Derivatives of the height at (x, y) by attitude.
#[inline(always)]
fn height_by_attitude([x, y]: &[Block; 2], k: usize) -> [f64; 3] {
    [1.0, -x[k], y[k]]
}

/// Fluxes and loads of a block with their derivatives: by ψ of the up cell, of the cell behind it
/// and of the down cell, and by attitude.
struct FaceDerivatives {
    flux: Block,
    flux_by_psi: [Block; 3],
    flux_by_attitude: [Block; 3],
    load: Block,
    load_by_psi: [Block; 3],
    load_by_attitude: [Block; 3],
}

impl FaceDerivatives {
    #[inline(always)]
    fn zero() -> Self {
        Self {
            flux: [0.0; BLOCK],
            flux_by_psi: [[0.0; BLOCK]; 3],
            flux_by_attitude: [[0.0; BLOCK]; 3],
            load: [0.0; BLOCK],
            load_by_psi: [[0.0; BLOCK]; 3],
            load_by_attitude: [[0.0; BLOCK]; 3],
        }
    }

    /// Adds face k's part of the force gradients.
    #[inline(always)]
    fn add_force(
        &self,
        k: usize,
        arms: &Arms,
        cells: &[usize; 3],
        has_behind: bool,
        out: &mut FilmLinearisation,
    ) {
        let face = height_by_attitude(&arms.face, k);
        for f in 0..3 {
            for (s, &cell) in cells.iter().enumerate() {
                if s != 1 || has_behind {
                    out.force_by_psi[f][cell] += face[f] * self.load_by_psi[s][k];
                }
            }
            for q in 0..3 {
                out.force_by_attitude[f][q] += face[f] * self.load_by_attitude[q][k];
            }
        }
    }

    /// Sets face k from its sides. `sides`: share of the flux, area, partials, and the floor's
    /// derivatives at the centre and at the face.
    #[inline(always)]
    fn set(&mut self, k: usize, sides: [&SideDerivatives; 2], load_by_p: f64, arms: &Arms) {
        let face = height_by_attitude(&arms.face, k);
        let mut by_psi = [[0.0; 2]; 3];
        let mut by_attitude = [[0.0; 3]; 2];
        for (s, side) in sides.into_iter().enumerate() {
            let centre = height_by_attitude([&arms.up, &arms.down][s], k);
            let (flux, excess) = (&side.partials.flux, &side.partials.excess);
            let by = [0, 1, 2, 3].map(|v| side.share * flux[v]);
            let load = [0, 1, 2, 3].map(|v| side.area * excess[v] + load_by_p * flux[v]);
            let at = [0, 2][s];
            by_psi[at] = [by[0], load[0]];
            if s == 0 {
                by_psi[1] = [by[1], load[1]];
            }
            for q in 0..3 {
                by_attitude[0][q] +=
                    by[2] * side.slopes[0] * centre[q] + by[3] * side.slopes[1] * face[q];
                by_attitude[1][q] +=
                    load[2] * side.slopes[0] * centre[q] + load[3] * side.slopes[1] * face[q];
            }
        }
        for s in 0..3 {
            self.flux_by_psi[s][k] = by_psi[s][0];
            self.load_by_psi[s][k] = by_psi[s][1];
            self.flux_by_attitude[s][k] = by_attitude[0][s];
            self.load_by_attitude[s][k] = by_attitude[1][s];
        }
    }
}

/// What a side contributes to a face's derivatives.
struct SideDerivatives {
    partials: HalfPartials,
    /// Of a change of the side's α − β p, what reaches the flux.
    share: f64,
    area: f64,
    /// Derivatives of the floored by the true height at the centre and at the face.
    slopes: [f64; 2],
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
fn windy<const STEEP: bool>(
    up: &SideBlock<'_>,
    down: &SideBlock<'_>,
    [[h_up, slope_up], [h_down, slope_down]]: &[[Block; 2]; 2],
    length: &Block,
    arms: &Arms,
) -> FaceDerivatives {
    let mut all = FaceDerivatives::zero();
    for k in 0..BLOCK {
        let (u, d) = (up.half(k, h_up[k]), down.half(k, h_down[k]));
        let (a, b) = (u.flux::<true, STEEP>(), d.flux::<false, STEEP>());
        let total = a.beta + b.beta;
        let p = (a.alpha + b.alpha) / total;
        all.flux[k] = length[k] * (a.alpha - a.beta * p);
        join(
            &mut all,
            k,
            [
                (
                    u.partials::<true>(&a, p),
                    a.beta,
                    u.mean_excess::<true>(&a, p),
                    up.area[k],
                    [up.h_slope(k), slope_up[k]],
                ),
                (
                    d.partials::<false>(&b, p),
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
    all
}

#[inline(always)]
fn still(
    up: &SideBlock<'_>,
    down: &SideBlock<'_>,
    [[h_up, slope_up], [h_down, slope_down]]: &[[Block; 2]; 2],
    length: &Block,
    arms: &Arms,
) -> FaceDerivatives {
    let mut all = FaceDerivatives::zero();
    for k in 0..BLOCK {
        let (u, d) = (up.half(k, h_up[k]), down.half(k, h_down[k]));
        let ((alpha_up, beta_up), (alpha_down, beta_down)) = (u.still(), d.still());
        let total = beta_up + beta_down;
        let p = (alpha_up + alpha_down) / total;
        all.flux[k] = length[k] * (alpha_up - beta_up * p);
        join(
            &mut all,
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
    all
}

/// Faces on the slider's edge; only the up side counts.
#[inline(always)]
fn edge(
    film: &Film,
    side: &SideBlock<'_>,
    base: &Block,
    length: &Block,
    arms: &Arms,
) -> FaceDerivatives {
    let mut all = FaceDerivatives::zero();
    let p = film.ambient_pa;
    for k in 0..BLOCK {
        let (h_face, slope) = film.floored(base[k] + side.recess[k]);
        let half = side.half(k, h_face);
        let (partials, (alpha, beta), excess) = if side.wind == 0.0 {
            (half.still_partials(p), half.still(), half.still_excess(p))
        } else if side.wind > 0.0 {
            let flux = half.flux::<true, true>();
            (
                half.partials::<true>(&flux, p),
                (flux.alpha, flux.beta),
                half.mean_excess::<true>(&flux, p),
            )
        } else {
            let flux = half.flux::<false, true>();
            (
                half.partials::<false>(&flux, p),
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
    all
}
