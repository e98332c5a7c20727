//! Net mass flux out of every cell of the air-bearing film, and the film's force on the slider.
//!
//! Faces are taken a block at a time, direction by direction, the slider's edges last. Each face gives a flux from cell
//! to cell, and the loads of its two half cells beyond the pressure at the cell centres.

#![expect(
    clippy::needless_range_loop,
    reason = "many columns are walked in step, which an index says plainest"
)]

use super::attitude::Attitude;
use super::exponential::growth;
use super::faces::{BLOCK, Block, Columns, Places, block};
use super::film::Film;
use super::flux::Drive;
use super::heights::{inverses, inverses_of_both, is_steep};
use super::state::{FaceConductance, FilmScratch, Picked, SideBlock, block_mut};
use crate::lanes::{Kernel, SUMS, total, widest};

impl Film {
    /// Scratch for this film.
    pub fn scratch(&self) -> FilmScratch {
        FilmScratch::new(self)
    }

    /// Net outward flux R of every cell, `capacity` dψ/dt + `out` = 0, and the force and moments
    /// [F_z, M_pitch, M_roll] of the film and of forces beside its pressure on the slider, conjugate to
    /// (h_c, pitch, roll): N, N m, N m. ψ must be positive.
    ///
    /// The pressure is integrated over the profiles that the fluxes assume. The thin layers at the pads' edges
    /// therefore contribute, although no cell resolves them.
    ///
    /// # Panics
    ///
    /// When a slice has not n_cells entries or `scratch` belongs to another film.
    pub fn flux_residual_and_force(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        out: &mut [f64],
        scratch: &mut FilmScratch,
    ) -> [f64; 3] {
        assert_eq!(out.len(), self.n_cells());
        let mut force = self.balance(psi, attitude, out, None, scratch).total();
        let mut add = |more: [f64; 3]| (0..3).for_each(|f| force[f] += more[f]);
        let cells = scratch.cell_states(attitude);
        for (_, gap_force) in &self.gap_forces {
            add(gap_force.force(self, &cells));
        }
        if let Some(defect) = &self.defect {
            add(defect.force(attitude));
        }
        force
    }

    /// R alone, as from [`Film::flux_residual_and_force`].
    ///
    /// # Panics
    ///
    /// As [`Film::flux_residual_and_force`].
    pub fn flux_residual(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        out: &mut [f64],
        scratch: &mut FilmScratch,
    ) {
        self.flux_residual_and_force(psi, attitude, out, scratch);
    }

    /// The force alone, as from [`Film::flux_residual_and_force`].
    ///
    /// # Panics
    ///
    /// As [`Film::flux_residual_and_force`].
    pub fn force(&self, psi: &[f64], attitude: &Attitude, scratch: &mut FilmScratch) -> [f64; 3] {
        let mut out = std::mem::take(&mut scratch.spare);
        let force = self.flux_residual_and_force(psi, attitude, &mut out, scratch);
        scratch.spare = out;
        force
    }

    /// The share of the air's pressure in [`Film::force`].
    ///
    /// # Panics
    ///
    /// As [`Film::flux_residual_and_force`].
    pub fn air_force(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        scratch: &mut FilmScratch,
    ) -> [f64; 3] {
        let force = self.force(psi, attitude, scratch);
        let beside = self.gap_force(attitude, scratch);
        std::array::from_fn(|f| force[f] - beside[f])
    }

    /// Normal force of the air on every cell, N, over the same profiles as the whole force.
    ///
    /// # Panics
    ///
    /// When a slice has not n_cells entries or `scratch` belongs to another film.
    pub fn cell_forces(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        out: &mut [f64],
        scratch: &mut FilmScratch,
    ) {
        assert_eq!(out.len(), self.n_cells());
        let mut residual = std::mem::take(&mut scratch.spare);
        self.balance(psi, attitude, &mut residual, Some(out), scratch);
        scratch.spare = residual;
    }

    fn balance(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        out: &mut [f64],
        cell_loads: Option<&mut [f64]>,
        scratch: &mut FilmScratch,
    ) -> Moments {
        let film = self;
        match self.height_limit.is_rough() {
            true => widest(Balance::<true> {
                film,
                psi,
                attitude,
                out,
                cell_loads,
                scratch,
            }),
            false => widest(Balance::<false> {
                film,
                psi,
                attitude,
                out,
                cell_loads,
                scratch,
            }),
        }
    }
}

/// The balance as a kernel.
struct Balance<'a, const ROUGH: bool> {
    film: &'a Film,
    psi: &'a [f64],
    attitude: &'a Attitude,
    out: &'a mut [f64],
    cell_loads: Option<&'a mut [f64]>,
    scratch: &'a mut FilmScratch,
}

impl<const ROUGH: bool> Kernel for Balance<'_, ROUGH> {
    /// Added up outside, so that the sums stay in whole registers ([`crate::lanes::abreast`]).
    type Output = Moments;

    #[inline(always)]
    fn call(self) -> Moments {
        let Self {
            film,
            psi,
            attitude,
            out,
            mut cell_loads,
            scratch,
        } = self;
        let columns = &film.columns;
        scratch.fill::<ROUGH>(film, psi, attitude);
        let mut moments = Moments::default();
        let front = columns.front;

        for first in (0..columns.area.len()).step_by(BLOCK) {
            let psi = block(&scratch.psi, front + first);
            let inverse_h = block(&scratch.inverse_h, front + first);
            let area = block(&columns.area, first);
            let mut load = [0.0; BLOCK];
            for k in 0..BLOCK {
                load[k] = (psi[k] * inverse_h[k] - film.ambient_pa) * area[k];
            }
            moments.add(&load, &columns.places, first);
            if let Some(loads) = cell_loads.as_deref_mut() {
                for (out, load) in loads.iter_mut().skip(first).zip(load) {
                    *out = load;
                }
            }
        }

        for (d, faces) in columns.interior.iter().enumerate() {
            let mut through = std::mem::take(&mut scratch.flux[d]);
            for first in (0..faces.length.len()).step_by(BLOCK) {
                let mut kept = None;
                let [up, down] = faces.sides(film, scratch, first, &mut kept);
                let base = faces.places.heights(first, attitude);
                let h_faces = [
                    film.limited_block::<ROUGH>(&base, up.recess)[0],
                    film.limited_block::<ROUGH>(&base, down.recess)[0],
                ];
                let length = block(&faces.length, first);
                let values = if faces.wind == 0.0 {
                    still(&up, &down, &h_faces, length)
                } else if any_steep(&up, &down, &h_faces, length) {
                    windy::<true>(&up, &down, &h_faces, length)
                } else {
                    windy::<false>(&up, &down, &h_faces, length)
                };
                *block_mut(&mut through, front + first) = values.flux;
                moments.add(&values.load(), &faces.places, first);
                if let Some(loads) = cell_loads.as_deref_mut() {
                    for k in 0..BLOCK {
                        for (at, load) in [
                            (faces.up + first + k, values.loads[0][k]),
                            (faces.down + first + k, values.loads[1][k]),
                        ] {
                            // Entries outside the film belong to faces of zero length and zero area.
                            if let Some(sum) = loads.get_mut(at.wrapping_sub(front)) {
                                *sum += load;
                            }
                        }
                    }
                }
            }
            scratch.flux[d] = through;
        }
        let [x, y] = &scratch.flux;
        net([x, y], columns, out);

        for faces in &columns.edges {
            for first in (0..faces.length.len()).step_by(BLOCK) {
                let cells = &faces.cells[first..first + BLOCK];
                let behind = &faces.behind[first..first + BLOCK];
                let picked = Picked::new(scratch, cells, behind, front, faces.wind != 0.0);
                let mut kept = None;
                let side = SideBlock::new(picked.cells(), &faces.side, first, faces.wind);
                let base = faces.places.heights(first, attitude);
                let h_face = film.limited_block::<ROUGH>(&base, side.recess)[0];
                let side = FaceConductance::of_edge(film, side, &h_face, &mut kept);
                let values = edge(film, &side, &h_face, block(&faces.length, first));
                moments.add(&values.loads[0], &faces.places, first);
                for (k, &cell) in cells.iter().enumerate() {
                    out[cell] += values.flux[k];
                }
                if let Some(loads) = cell_loads.as_deref_mut() {
                    for (k, &cell) in cells.iter().enumerate() {
                        loads[cell] += values.loads[0][k];
                    }
                }
            }
        }
        moments
    }
}

/// What flows out of every cell: through the face of its own number, less through the one before.
#[inline(always)]
pub(super) fn net(of: [&[f64]; 2], columns: &Columns, out: &mut [f64]) {
    let (front, n) = (columns.front, columns.n_cells);
    let [x, y] = of;
    let (x_stride, y_stride) = (columns.interior[0].stride, columns.interior[1].stride);
    let x_out = &x[front..front + n];
    let x_in = &x[front - x_stride..front - x_stride + n];
    let y_out = &y[front..front + n];
    let y_in = &y[front - y_stride..front - y_stride + n];
    let out = &mut out[..n];
    for k in 0..n {
        out[k] = (x_out[k] - x_in[k]) + (y_out[k] - y_in[k]);
    }
}

/// Flux through the faces of a block and the loads of their half cells beyond the centres'
/// pressure.
struct FaceValues {
    flux: Block,
    loads: [Block; 2],
}

impl FaceValues {
    #[inline(always)]
    fn load(&self) -> Block {
        let mut out = [0.0; BLOCK];
        for k in 0..BLOCK {
            out[k] = self.loads[0][k] + self.loads[1][k];
        }
        out
    }
}

/// Whether a half cell of a face that exists is steep.
#[inline(always)]
pub(super) fn any_steep(
    up: &SideBlock<'_>,
    down: &SideBlock<'_>,
    [h_up, h_down]: &[Block; 2],
    length: &Block,
) -> bool {
    let mut any = false;
    for k in 0..BLOCK {
        let u = is_steep(up.h(k), h_up[k]);
        let d = is_steep(down.h(k), h_down[k]);
        any |= (u | d) & (length[k] != 0.0);
    }
    any
}

/// What the half cells of one side of a block give: α, β, δ and the convective share of the profile.
///
/// Each half cell is one long chain of results that wait for one another; in passes over the block the
/// processor works on several.
struct Halves {
    per_height: Block,
    alpha: Block,
    beta: Block,
    rise: Block,
    convective: Block,
}

impl Halves {
    #[inline(always)]
    fn new<const UP: bool, const STEEP: bool>(
        side: &SideBlock<'_>,
        h_face: &Block,
        inverses: &[Block; 2],
    ) -> Self {
        let [mut conductance, mut blow, mut pe, mut e] = [[0.0; BLOCK]; 4];
        let [
            mut per_height,
            mut alpha,
            mut beta,
            mut rise,
            mut convective,
        ] = [[0.0; BLOCK]; 5];
        for k in 0..BLOCK {
            let half = side.half(k, h_face[k], [inverses[0][k], inverses[1][k]]);
            let drive = half.drive(&half.logarithmic_mean::<STEEP>());
            conductance[k] = drive.conductance;
            blow[k] = drive.blow;
            pe[k] = drive.pe;
            per_height[k] = half.mean_inverse_height()[0];
        }
        for k in 0..BLOCK {
            e[k] = growth(pe[k]);
        }
        for k in 0..BLOCK {
            let drive = Drive {
                conductance: conductance[k],
                blow: blow[k],
                pe: pe[k],
            };
            let half = side.bare_half(k, h_face[k]);
            let flux = half.driven::<UP>(&drive, e[k]);
            alpha[k] = flux.alpha;
            beta[k] = flux.beta;
            rise[k] = flux.rise;
            convective[k] = flux.convective::<UP>();
        }
        Self {
            per_height,
            alpha,
            beta,
            rise,
            convective,
        }
    }

    /// The load of half cell k under the face pressure p.
    #[inline(always)]
    fn load<const UP: bool>(&self, side: &SideBlock<'_>, h_face: &Block, k: usize, p: f64) -> f64 {
        let half = side.bare_half(k, h_face[k]);
        let shares = (self.rise[k], self.convective[k]);
        side.area[k] * half.excess::<UP>(shares, self.per_height[k], p)
    }
}

#[inline(always)]
fn windy<const STEEP: bool>(
    up: &SideBlock<'_>,
    down: &SideBlock<'_>,
    [h_up, h_down]: &[Block; 2],
    length: &Block,
) -> FaceValues {
    let mut inverses = [[[0.0; BLOCK]; 2]; 2];
    for k in 0..BLOCK {
        let both = inverses_of_both([up.h(k), down.h(k)], [h_up[k], h_down[k]]);
        for side in 0..2 {
            for i in 0..2 {
                inverses[side][i][k] = both[side][i];
            }
        }
    }
    let a = Halves::new::<true, STEEP>(up, h_up, &inverses[0]);
    let b = Halves::new::<false, STEEP>(down, h_down, &inverses[1]);
    let (mut flux, mut loads) = ([0.0; BLOCK], [[0.0; BLOCK]; 2]);
    for k in 0..BLOCK {
        let p = (a.alpha[k] + b.alpha[k]) / (a.beta[k] + b.beta[k]);
        flux[k] = length[k] * a.beta[k].mul_add(-p, a.alpha[k]);
        loads[0][k] = a.load::<true>(up, h_up, k, p);
        loads[1][k] = b.load::<false>(down, h_down, k, p);
    }
    FaceValues { flux, loads }
}

#[inline(always)]
fn still(
    up: &SideBlock<'_>,
    down: &SideBlock<'_>,
    [h_up, h_down]: &[Block; 2],
    length: &Block,
) -> FaceValues {
    let (mut flux, mut loads) = ([0.0; BLOCK], [[0.0; BLOCK]; 2]);
    for k in 0..BLOCK {
        let (u, d) = (up.bare_half(k, h_up[k]), down.bare_half(k, h_down[k]));
        let ((a, b), (c, e)) = (u.still(), d.still());
        let p = (a + c) / (b + e);
        flux[k] = length[k] * b.mul_add(-p, a);
        loads[0][k] = up.area[k] * u.still_excess(p);
        loads[1][k] = down.area[k] * d.still_excess(p);
    }
    FaceValues { flux, loads }
}

/// Faces on the slider's edge, where the ambient pressure stands.
#[inline(always)]
fn edge(film: &Film, side: &SideBlock<'_>, h_face: &Block, length: &Block) -> FaceValues {
    if side.wind > 0.0 {
        return windy_edge::<true>(film, side, h_face, length);
    }
    if side.wind < 0.0 {
        return windy_edge::<false>(film, side, h_face, length);
    }
    let (mut flux, mut loads) = ([0.0; BLOCK], [[0.0; BLOCK]; 2]);
    let p = film.ambient_pa;
    for k in 0..BLOCK {
        let half = side.bare_half(k, h_face[k]);
        let (alpha, beta) = half.still();
        flux[k] = length[k] * beta.mul_add(-p, alpha);
        loads[0][k] = side.area[k] * half.still_excess(p);
    }
    FaceValues { flux, loads }
}

#[inline(always)]
fn windy_edge<const UP: bool>(
    film: &Film,
    side: &SideBlock<'_>,
    h_face: &Block,
    length: &Block,
) -> FaceValues {
    let mut of_heights = [[0.0; BLOCK]; 2];
    for k in 0..BLOCK {
        [of_heights[0][k], of_heights[1][k]] = inverses(side.h(k), h_face[k]);
    }
    let halves = Halves::new::<UP, true>(side, h_face, &of_heights);
    let (mut flux, mut loads) = ([0.0; BLOCK], [[0.0; BLOCK]; 2]);
    let p = film.ambient_pa;
    for k in 0..BLOCK {
        flux[k] = length[k] * halves.beta[k].mul_add(-p, halves.alpha[k]);
        loads[0][k] = halves.load::<UP>(side, h_face, k, p);
    }
    FaceValues { flux, loads }
}

/// Sums of loads and of their moments.
#[derive(Default)]
pub(super) struct Moments {
    sums: [[f64; SUMS]; 3],
}

impl Moments {
    #[inline(always)]
    pub(super) fn add(&mut self, load: &Block, places: &Places, first: usize) {
        let (x, y) = (block(&places.x, first), block(&places.y, first));
        let (load, x, y) = (
            load.as_chunks::<SUMS>().0,
            x.as_chunks::<SUMS>().0,
            y.as_chunks::<SUMS>().0,
        );
        let [mut force, mut pitch, mut roll] = self.sums;
        for ((load, x), y) in load.iter().zip(x).zip(y) {
            for k in 0..SUMS {
                force[k] += load[k];
            }
            for k in 0..SUMS {
                pitch[k] = load[k].mul_add(-x[k], pitch[k]);
            }
            for k in 0..SUMS {
                roll[k] = load[k].mul_add(y[k], roll[k]);
            }
        }
        self.sums = [force, pitch, roll];
    }

    pub(super) fn total(&self) -> [f64; 3] {
        self.sums.map(total)
    }
}
