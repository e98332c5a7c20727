//! Derivatives of the film's flux balance and of its force by ψ = p h and attitude.
//!
//! The derivatives of a face are written in columns, face by face, as the balance does with fluxes. The diagonals of
//! the matrix and the derivatives of the force are gathered from them afterwards, because the cells of face k, and of
//! the row it leaves and enters, lie at fixed distances from k.

#![expect(
    clippy::needless_range_loop,
    reason = "many columns are walked in step, which an index says plainest"
)]

use super::attitude::Attitude;
use super::balance::{Moments, any_steep, net};
use super::derivatives::{Arms, FaceDerivatives, edge, height_by_attitude, still, windy};
use super::faces::{BLOCK, Block, Columns, Interior, block};
use super::film::Film;
use super::state::{FaceConductance, FilmScratch, Picked, SideBlock, block_mut};
use crate::lanes::{Kernel, SUMS, total, widest};
use crate::linalg::diagonals::Diagonals;

/// Residual and derivatives of the flux balance at one state.
#[derive(Clone, Debug)]
pub struct FilmLinearisation {
    /// R, as from [`Film::flux_residual_and_force`]; length n_cells.
    pub residual: Vec<f64>,
    /// dR/dψ.
    pub by_psi: Diagonals,
    /// dR/d(h_c, pitch, roll); each of length n_cells.
    pub by_attitude: [Vec<f64>; 3],
    /// [F_z, M_pitch, M_roll], as from [`Film::force`].
    pub force: [f64; 3],
    /// Derivatives of each force by every cell's ψ; each of length n_cells.
    pub force_by_psi: [Vec<f64>; 3],
    /// Derivatives of each force by (h_c, pitch, roll) at constant ψ: `[force][q]`.
    pub force_by_attitude: [[f64; 3]; 3],
    by_face: [ByFace; 2],
}

/// Derivatives of the fluxes through the faces of one direction and of the loads at them, padded like
/// states: by ψ of the up cell, of the down cell and of the cell behind the up cell, and by attitude.
#[derive(Clone, Debug)]
struct ByFace {
    flux_by_psi: [Vec<f64>; 3],
    flux_by_attitude: [Vec<f64>; 3],
    load_by_psi: [Vec<f64>; 3],
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
        let front = self.columns.front;
        let offsets = self
            .columns
            .interior
            .iter()
            .flat_map(|faces| faces.offsets(front));
        FilmLinearisation {
            residual: vec![0.0; n],
            by_psi: Diagonals::zeros(n, offsets.flatten().collect()),
            by_attitude: [0, 1, 2].map(|_| vec![0.0; n]),
            force: [0.0; 3],
            force_by_psi: [0, 1, 2].map(|_| vec![0.0; n]),
            force_by_attitude: [[0.0; 3]; 3],
            by_face: [0, 1].map(|_| ByFace {
                flux_by_psi: columns(),
                flux_by_attitude: columns(),
                load_by_psi: columns(),
            }),
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
        let film = self;
        let totals = match self.height_limit.is_rough() {
            true => widest(Linearise::<true> {
                film,
                psi,
                attitude,
                out,
                scratch,
            }),
            false => widest(Linearise::<false> {
                film,
                psi,
                attitude,
                out,
                scratch,
            }),
        };
        out.force_by_attitude = totals.force_by_attitude.map(|row| row.map(total));
        out.force = totals.moments.total();
        let cells = scratch.cell_states(attitude);
        let gap_forces = self.gap_forces.iter();
        let gap_loads =
            gap_forces.map(|(_, force)| force.load(self, &cells, &mut out.force_by_psi));
        let defect = self.defect.iter().map(|defect| defect.load(attitude));
        for load in gap_loads.chain(defect) {
            for f in 0..3 {
                out.force[f] += load.force[f];
                for q in 0..3 {
                    out.force_by_attitude[f][q] += load.by_attitude[f][q];
                }
            }
        }
    }
}

struct Linearise<'a, const ROUGH: bool> {
    film: &'a Film,
    psi: &'a [f64],
    attitude: &'a Attitude,
    out: &'a mut FilmLinearisation,
    scratch: &'a mut FilmScratch,
}

impl<const ROUGH: bool> Kernel for Linearise<'_, ROUGH> {
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
        scratch.fill::<ROUGH>(film, psi, attitude);
        centres(film, scratch, &mut totals);
        for d in 0..2 {
            between_cells::<ROUGH>(film, attitude, d, scratch, out, &mut totals);
        }
        gather_rows(columns, scratch, out);
        gather_gradients(columns, scratch, out);
        on_edges::<ROUGH>(film, attitude, scratch, out, &mut totals);
        totals
    }
}

/// Pressures at the centres, each over its whole cell.
#[inline(always)]
fn centres(film: &Film, state: &FilmScratch, totals: &mut Totals) {
    let columns = &film.columns;
    for first in (0..columns.area.len()).step_by(BLOCK) {
        let at = columns.front + first;
        let (psi, inverse_h) = (block(&state.psi, at), block(&state.inverse_h, at));
        let (h_slope, area) = (block(&state.h_slope, at), block(&columns.area, first));
        let places = &columns.places;
        let arms = height_by_attitude([block(&places.x, first), block(&places.y, first)]);
        let mut load = [0.0; BLOCK];
        let mut per_height = [0.0; BLOCK];
        for k in 0..BLOCK {
            let per_psi = area[k] * inverse_h[k];
            load[k] = (psi[k] * inverse_h[k] - film.ambient_pa) * area[k];
            per_height[k] = -psi[k] * per_psi * h_slope[k] * inverse_h[k];
        }
        totals.moments.add(&load, places, first);
        totals.add_by_height(&per_height, &arms);
    }
}

#[inline(always)]
fn between_cells<const ROUGH: bool>(
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
    let mut all = FaceDerivatives::zero();
    for first in (0..faces.length.len()).step_by(BLOCK) {
        let mut kept = None;
        let [up, down] = faces.sides(film, state, first, &mut kept);
        let base = faces.places.heights(first, attitude);
        let faces_at = [
            film.limited_block::<ROUGH>(&base, up.recess),
            film.limited_block::<ROUGH>(&base, down.recess),
        ];
        let length = block(&faces.length, first);
        let centre = |cell: usize| {
            let [x, y] = [&columns.centre_x, &columns.centre_y].map(|c| block(c, cell + first));
            height_by_attitude([x, y])
        };
        let arms = Arms {
            face: height_by_attitude([
                block(&faces.places.x, first),
                block(&faces.places.y, first),
            ]),
            up: centre(faces.up),
            down: centre(faces.down),
        };
        if faces.wind == 0.0 {
            still(&mut all, &up, &down, &faces_at, length, &arms)
        } else if any_steep(&up, &down, &[faces_at[0][0], faces_at[1][0]], length) {
            windy::<true>(&mut all, &up, &down, &faces_at, length, &arms)
        } else {
            windy::<false>(&mut all, &up, &down, &faces_at, length, &arms)
        }
        all.add_across([&up, &down], block(&faces.step, first), &arms);
        *block_mut(&mut through, front + first) = all.flux;
        let by_face = &mut out.by_face[d];
        for s in 0..3 {
            *block_mut(&mut by_face.flux_by_psi[s], front + first) = all.flux_by_psi[s];
            *block_mut(&mut by_face.flux_by_attitude[s], front + first) = all.flux_by_attitude[s];
            *block_mut(&mut by_face.load_by_psi[s], front + first) = all.load_by_psi[s];
        }
        totals.moments.add(&all.load, &faces.places, first);
        totals.add_by_attitude(&all.load_by_attitude, &arms.face);
    }
    state.flux[d] = through;
}

impl Totals {
    /// Adds loads by attitude, which act where a height changes by `arms`.
    #[inline(always)]
    pub(super) fn add_by_attitude(&mut self, by_attitude: &[Block; 3], arms: &[Block; 3]) {
        for f in 0..3 {
            for q in 0..3 {
                let sums = &mut self.force_by_attitude[f][q];
                add_products(sums, &arms[f], &by_attitude[q]);
            }
        }
    }

    /// Adds loads by the height where they act, which changes by `arms`.
    #[inline(always)]
    pub(super) fn add_by_height(&mut self, by_height: &Block, arms: &[Block; 3]) {
        let mut by_attitude = [[0.0; BLOCK]; 3];
        for q in 0..3 {
            for k in 0..BLOCK {
                by_attitude[q][k] = by_height[k] * arms[q][k];
            }
        }
        self.add_by_attitude(&by_attitude, arms);
    }
}

/// Adds the products of a block to sums.
#[inline(always)]
fn add_products(sums: &mut [f64; SUMS], a: &Block, b: &Block) {
    let mut local = *sums;
    for (a, b) in a.as_chunks::<SUMS>().0.iter().zip(b.as_chunks::<SUMS>().0) {
        for k in 0..SUMS {
            local[k] += a[k] * b[k];
        }
    }
    *sums = local;
}

/// Rows from the faces between cells.
#[inline(always)]
fn gather_rows(columns: &Columns, state: &FilmScratch, out: &mut FilmLinearisation) {
    let [x, y] = &state.flux;
    net([x, y], columns, &mut out.residual);
    for q in 0..3 {
        let [x, y] = [0, 1].map(|d: usize| out.by_face[d].flux_by_attitude[q].as_slice());
        net([x, y], columns, &mut out.by_attitude[q]);
    }
    out.by_psi.clear();
    let front = columns.front;
    for (faces, by_face) in columns.interior.iter().zip(&out.by_face) {
        for (offsets, column) in faces.offsets(front).zip(&by_face.flux_by_psi) {
            let [leaving, entering] = offsets;
            let diagonal = out.by_psi.column_mut(leaving).expect("made for it");
            for (entry, flux) in diagonal.iter_mut().zip(&column[front..]) {
                *entry += flux;
            }
            let diagonal = out.by_psi.column_mut(entering).expect("made for it");
            for (entry, flux) in diagonal.iter_mut().zip(&column[front - faces.stride..]) {
                *entry -= flux;
            }
        }
    }
}

/// Gradients of the force from the centres' pressures, each over its whole cell, and from the faces
/// between cells.
#[inline(always)]
fn gather_gradients(columns: &Columns, state: &FilmScratch, out: &mut FilmLinearisation) {
    let (n, front) = (columns.n_cells, columns.front);
    let [force, pitch, roll] = out.force_by_psi.each_mut().map(|g| &mut g[..n]);
    let inverse_h = &state.inverse_h[front..front + n];
    let places = &columns.places;
    let (area, x, y) = (&columns.area[..n], &places.x[..n], &places.y[..n]);
    for k in 0..n {
        let load = area[k] * inverse_h[k];
        force[k] = load;
        pitch[k] = -x[k] * load;
        roll[k] = y[k] * load;
    }
    for (faces, by_face) in columns.interior.iter().zip(&out.by_face) {
        for (cell, load) in faces.cells().zip(&by_face.load_by_psi) {
            // Faces whose cell is one of the film's; of others nothing depends on ψ.
            let (first, to) = (front.saturating_sub(cell), cell.saturating_sub(front));
            let m = n.saturating_sub(first.max(to));
            let load = &load[front + first..][..m];
            let (x, y) = (&faces.places.x[first..][..m], &faces.places.y[first..][..m]);
            let (force, pitch) = (&mut force[to..][..m], &mut pitch[to..][..m]);
            let roll = &mut roll[to..][..m];
            for k in 0..m {
                force[k] += load[k];
                pitch[k] -= x[k] * load[k];
                roll[k] += y[k] * load[k];
            }
        }
    }
}

impl Interior {
    /// Number of face 0's up cell, down cell and, with wind, cell behind the up cell, in the padded numbering.
    #[inline(always)]
    fn cells(&self) -> impl Iterator<Item = usize> {
        let used = if self.wind == 0.0 { 2 } else { 3 };
        [self.up, self.down, self.behind].into_iter().take(used)
    }

    /// How far these stand from the diagonal of a matrix in the row of the cell that face 0 leaves, and in
    /// that of the cell it enters.
    fn offsets(&self, front: usize) -> impl Iterator<Item = [isize; 2]> {
        let stride = self.stride.cast_signed();
        self.cells().map(move |cell| {
            let leaving = cell.cast_signed() - front.cast_signed();
            [leaving, leaving - stride]
        })
    }
}

#[inline(always)]
fn on_edges<const ROUGH: bool>(
    film: &Film,
    attitude: &Attitude,
    state: &FilmScratch,
    out: &mut FilmLinearisation,
    totals: &mut Totals,
) {
    let columns = &film.columns;
    let front = columns.front;
    let mut all = FaceDerivatives::zero();
    for faces in &columns.edges {
        for first in (0..faces.length.len()).step_by(BLOCK) {
            let cells = &faces.cells[first..first + BLOCK];
            let behind = &faces.behind[first..first + BLOCK];
            let picked = Picked::new(state, cells, behind, front, faces.wind != 0.0);
            let mut kept = None;
            let side = SideBlock::new(picked.cells(), &faces.side, first, faces.wind);
            let base = faces.places.heights(first, attitude);
            let at_face = film.limited_block::<ROUGH>(&base, side.recess);
            let side = FaceConductance::of_edge(film, side, &at_face[0], &mut kept);
            let length = block(&faces.length, first);
            let [x, y] = [&columns.centre_x, &columns.centre_y].map(|column| {
                let mut out = [0.0; BLOCK];
                for (out, cell) in out.iter_mut().zip(cells) {
                    *out = column[front + cell];
                }
                out
            });
            let centre = height_by_attitude([&x, &y]);
            let places = &faces.places;
            let arms = Arms {
                face: height_by_attitude([block(&places.x, first), block(&places.y, first)]),
                up: centre,
                down: centre,
            };
            edge(&mut all, film, &side, &at_face, length, &arms);
            all.add_across_edge(film.ambient_pa, &side, &at_face[1], &arms);
            totals.moments.add(&all.load, &faces.places, first);
            totals.add_by_attitude(&all.load_by_attitude, &arms.face);
            for k in 0..BLOCK {
                if length[k] == 0.0 {
                    continue;
                }
                let row = cells[k];
                out.residual[row] += all.flux[k];
                for q in 0..3 {
                    out.by_attitude[q][row] += all.flux_by_attitude[q][k];
                }
                let mut add = |cell: usize, s: usize| {
                    out.by_psi.add(row, cell, all.flux_by_psi[s][k]);
                    for f in 0..3 {
                        out.force_by_psi[f][cell] += arms.face[f][k] * all.load_by_psi[s][k];
                    }
                };
                add(row, 0);
                if side.reach[k] > 0.0 {
                    add(behind[k], 2);
                }
            }
        }
    }
}
