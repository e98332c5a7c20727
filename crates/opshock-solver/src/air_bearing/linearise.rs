//! Derivatives of the flux balance and of the force by ψ and attitude.
//!
//! What a face gives is written in columns, face by face, as the balance does with fluxes; rows of the
//! matrix are gathered from them afterwards: the cells of face k and of the row it leaves and enters
//! lie at fixed distances from k.

#![expect(
    clippy::needless_range_loop,
    reason = "many columns are walked in step, which an index says plainest"
)]

use super::Attitude;
use super::balance::{Moments, any_steep, net};
use super::derivatives::{Arms, edge, height_by_attitude, still, windy};
use super::faces::{BLOCK, Columns, Interior, block};
use super::film::Film;
use super::state::{FilmScratch, Picked, SideBlock, block_mut};
use crate::lanes::{Kernel, SUMS, total, widest};
use crate::linalg::banded::{Band, BandMatrix};

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
    by_face: [ByFace; 2],
    /// `force_by_psi`, padded like states.
    force_columns: [Vec<f64>; 3],
}

/// Derivatives of the fluxes through the faces of one direction, padded like states.
#[derive(Clone, Debug)]
struct ByFace {
    /// By ψ of the up cell, of the cell behind it and of the down cell.
    psi: [Vec<f64>; 3],
    attitude: [Vec<f64>; 3],
}

/// Sums over faces and cells.
#[derive(Default)]
pub(super) struct Totals {
    pub(super) moments: Moments,
    pub(super) force_by_attitude: [[[f64; SUMS]; 3]; 3],
}

impl Film {
    /// Zeroed linearisation of the right shape.
    pub fn linearisation(&self) -> FilmLinearisation {
        let n = self.n_cells();
        let columns = || [0, 1, 2].map(|_| vec![0.0; self.columns.padded]);
        FilmLinearisation {
            residual: vec![0.0; n],
            by_psi: BandMatrix::zeros(n, self.mesh.band()),
            by_attitude: [0, 1, 2].map(|_| vec![0.0; n]),
            force: [0.0; 3],
            force_by_psi: [0, 1, 2].map(|_| vec![0.0; n]),
            force_by_attitude: [[0.0; 3]; 3],
            by_face: [0, 1].map(|_| ByFace {
                psi: columns(),
                attitude: columns(),
            }),
            force_columns: columns(),
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
        assert_eq!(out.by_psi.band(), self.mesh.band());
        let totals = widest(Linearise {
            film: self,
            psi,
            attitude,
            out,
            scratch,
        });
        out.force_by_attitude = totals.force_by_attitude.map(|row| row.map(total));
        out.force = totals.moments.total();
        let defect = self.defect.as_ref();
        let defect = defect.map(|defect| defect.load(attitude));
        for load in self.surface_load(attitude).into_iter().chain(defect) {
            for f in 0..3 {
                out.force[f] += load.force[f];
                for q in 0..3 {
                    out.force_by_attitude[f][q] += load.by_attitude[f][q];
                }
            }
        }
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
    type Output = Totals;

    #[inline(always)]
    fn call(self) -> Totals {
        let Self {
            film,
            psi,
            attitude,
            out,
            scratch,
        } = self;
        let columns = &film.columns;
        let mut totals = Totals::default();
        scratch.fill(film, psi, attitude);
        centres(film, scratch, out, &mut totals);
        for d in 0..2 {
            between_cells(film, attitude, d, scratch, out, &mut totals);
        }
        gather(columns, scratch, out);
        on_edges(film, attitude, scratch, out, &mut totals);
        for f in 0..3 {
            let column = &out.force_columns[f][columns.front..columns.front + columns.n_cells];
            out.force_by_psi[f].copy_from_slice(column);
        }
        totals
    }
}

/// Pressures at the centres, each over its whole cell.
#[inline(always)]
fn centres(film: &Film, state: &FilmScratch, out: &mut FilmLinearisation, totals: &mut Totals) {
    let columns = &film.columns;
    for column in &mut out.force_columns {
        column.fill(0.0);
    }
    for first in (0..columns.area.len()).step_by(BLOCK) {
        let at = columns.front + first;
        let (psi, inverse_h) = (block(&state.psi, at), block(&state.inverse_h, at));
        let (h_slope, area) = (block(&state.h_slope, at), block(&columns.area, first));
        let places = [&columns.places.x, &columns.places.y].map(|column| *block(column, first));
        let mut load = [0.0; BLOCK];
        let mut by_attitude = [[0.0; BLOCK]; 3];
        for k in 0..BLOCK {
            load[k] = (psi[k] * inverse_h[k] - film.ambient_pa) * area[k];
            let per_psi = area[k] * inverse_h[k];
            let per_height = -psi[k] * per_psi * h_slope[k] * inverse_h[k];
            let arms = height_by_attitude(&places, k);
            for q in 0..3 {
                out.force_columns[q][at + k] = per_psi * arms[q];
                by_attitude[q][k] = per_height * arms[q];
            }
        }
        totals.moments.add(&load, &columns.places, first);
        totals.add_by_attitude(&by_attitude, &places);
    }
}

#[inline(always)]
fn between_cells(
    film: &Film,
    attitude: &Attitude,
    d: usize,
    state: &mut FilmScratch,
    out: &mut FilmLinearisation,
    totals: &mut Totals,
) {
    let columns = &film.columns;
    let (faces, front) = (&columns.interior[d], columns.front);
    let mut through = std::mem::take(&mut state.flux[d]);
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
        *block_mut(&mut through, front + first) = all.flux;
        for s in 0..3 {
            *block_mut(&mut out.by_face[d].psi[s], front + first) = all.flux_by_psi[s];
            *block_mut(&mut out.by_face[d].attitude[s], front + first) = all.flux_by_attitude[s];
        }
        totals.moments.add(&all.load, &faces.places, first);
        totals.add_by_attitude(&all.load_by_attitude, &arms.face);
        let cells = [faces.up, faces.behind, faces.down];
        for s in 0..3 {
            for f in 0..3 {
                let column = block_mut(&mut out.force_columns[f], cells[s] + first);
                for k in 0..BLOCK {
                    column[k] += height_by_attitude(&arms.face, k)[f] * all.load_by_psi[s][k];
                }
            }
        }
    }
    state.flux[d] = through;
}

impl Totals {
    /// Adds loads by attitude, which act at `places`.
    #[inline(always)]
    pub(super) fn add_by_attitude(
        &mut self,
        by_attitude: &[[f64; BLOCK]; 3],
        places: &[[f64; BLOCK]; 2],
    ) {
        for f in 0..3 {
            for q in 0..3 {
                let mut sums = self.force_by_attitude[f][q];
                for first in (0..BLOCK).step_by(SUMS) {
                    for k in 0..SUMS {
                        let arm = height_by_attitude(places, first + k)[f];
                        sums[k] += arm * by_attitude[q][first + k];
                    }
                }
                self.force_by_attitude[f][q] = sums;
            }
        }
    }
}

/// Rows from the faces between cells.
#[inline(always)]
fn gather(columns: &Columns, state: &FilmScratch, out: &mut FilmLinearisation) {
    let [x, y] = &state.flux;
    net([x, y], columns, &mut out.residual);
    for q in 0..3 {
        let [x, y] = [0, 1].map(|d: usize| out.by_face[d].attitude[q].as_slice());
        net([x, y], columns, &mut out.by_attitude[q]);
    }
    let band = out.by_psi.band();
    let places = columns
        .interior
        .each_ref()
        .map(|f| f.in_row(columns.front, band));
    for (i, row) in out.by_psi.rows_mut().enumerate() {
        let at = columns.front + i;
        for places in places.as_flattened() {
            for place in places {
                row[*place] = 0.0;
            }
        }
        for d in 0..2 {
            let before = at - columns.interior[d].stride;
            for s in 0..3 {
                let column = &out.by_face[d].psi[s];
                row[places[d][0][s]] += column[at];
                row[places[d][1][s]] -= column[before];
            }
        }
    }
}

impl Interior {
    /// Where the up cell, the cell behind it and the down cell of face i, and those of the face
    /// before cell i, stand in row i of a matrix. Outside its band nothing but zeros is added,
    /// which may go anywhere.
    fn in_row(&self, front: usize, band: Band) -> [[usize; 3]; 2] {
        [0, self.stride].map(|before| {
            [self.up, self.behind, self.down].map(|cell| {
                let place = (cell + band.below).checked_sub(front + before);
                let is_inside = |at: &usize| *at <= band.below + band.above;
                place.filter(is_inside).unwrap_or(band.below)
            })
        })
    }
}

#[inline(always)]
fn on_edges(
    film: &Film,
    attitude: &Attitude,
    state: &FilmScratch,
    out: &mut FilmLinearisation,
    totals: &mut Totals,
) {
    let columns = &film.columns;
    let front = columns.front;
    for faces in &columns.edges {
        for first in (0..faces.length.len()).step_by(BLOCK) {
            let cells = &faces.cells[first..first + BLOCK];
            let behind = &faces.behind[first..first + BLOCK];
            let picked = Picked::new(state, cells, behind, front, faces.wind != 0.0);
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
            totals.moments.add(&all.load, &faces.places, first);
            totals.add_by_attitude(&all.load_by_attitude, &arms.face);
            for k in 0..BLOCK {
                if length[k] == 0.0 {
                    continue;
                }
                let (row, has_behind) = (cells[k], side.reach[k] > 0.0);
                out.residual[row] += all.flux[k];
                let face = height_by_attitude(&arms.face, k);
                for (s, cell) in [row, behind[k]].into_iter().enumerate() {
                    if s == 0 || has_behind {
                        out.by_psi.add(row, cell, all.flux_by_psi[s][k]);
                        for f in 0..3 {
                            out.force_columns[f][front + cell] += face[f] * all.load_by_psi[s][k];
                        }
                    }
                }
                for q in 0..3 {
                    out.by_attitude[q][row] += all.flux_by_attitude[q][k];
                }
            }
        }
    }
}
