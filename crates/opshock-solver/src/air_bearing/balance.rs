//! Flux balance of all cells and force on the slider.
//!
//! Faces are taken a block at a time, direction by direction, the slider's edges last; each gives a
//! flux from cell to cell and the loads of its half cells beyond their centres' pressure.

#![expect(
    clippy::needless_range_loop,
    reason = "many columns are walked in step, which an index says plainest"
)]

use super::Attitude;
use super::faces::{BLOCK, Block, Columns, Interior, Places, block};
use super::film::Film;
use super::flux::{Drive, growth, inverses, inverses_of_both, is_steep};
use super::state::{FilmScratch, Picked, SideBlock, block_mut};
use crate::lanes::{Kernel, SUMS, total, widest};

impl Film {
    /// Scratch for this film.
    pub fn scratch(&self) -> FilmScratch {
        FilmScratch::new(self)
    }

    /// Net outward flux R of every cell, `capacity` dψ/dt + `out` = 0, and the force and moments
    /// [F_z, M_pitch, M_roll] of the film and of surface forces beside it on the slider, conjugate to
    /// (h_c, pitch, roll): N, N m, N m. ψ must be positive.
    ///
    /// The pressure is integrated over the same profiles the fluxes assume, so that the thin
    /// layers at the pads' edges count although no cell resolves them.
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
        let force = widest(Balance {
            film: self,
            psi,
            attitude,
            out,
            cell_loads: None,
            scratch,
        })
        .total();
        match &self.interaction {
            None => force,
            Some(_) => {
                let surface = self.surface_force(attitude);
                std::array::from_fn(|f| force[f] + surface[f])
            }
        }
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

    /// The air's share of [`Film::force`], without surface forces.
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
        let (force, surface) = (
            self.force(psi, attitude, scratch),
            self.surface_force(attitude),
        );
        std::array::from_fn(|f| force[f] - surface[f])
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
        widest(Balance {
            film: self,
            psi,
            attitude,
            out: &mut residual,
            cell_loads: Some(out),
            scratch,
        });
        scratch.spare = residual;
    }
}

/// The balance as a kernel.
struct Balance<'a> {
    film: &'a Film,
    psi: &'a [f64],
    attitude: &'a Attitude,
    out: &'a mut [f64],
    cell_loads: Option<&'a mut [f64]>,
    scratch: &'a mut FilmScratch,
}

impl Kernel for Balance<'_> {
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
        scratch.fill(film, psi, attitude);
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
                let [up, down] = faces.sides(scratch, first);
                let base = faces.places.heights(first, attitude);
                let h_faces = [
                    film.floored_block(&base, up.recess)[0],
                    film.floored_block(&base, down.recess)[0],
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
                            // Places outside the film belong to faces of no length and no area.
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
                let picked =
                    Picked::new(scratch, cells, &faces.behind[first..first + BLOCK], front);
                let side = SideBlock::new(picked.cells(), &faces.side, first, faces.wind);
                let base = faces.places.heights(first, attitude);
                let h_face = film.floored_block(&base, side.recess)[0];
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

impl Interior {
    /// Both sides of the faces from `first`.
    #[inline(always)]
    pub(super) fn sides<'a>(&'a self, state: &'a FilmScratch, first: usize) -> [SideBlock<'a>; 2] {
        let (up, down) = (self.up + first, self.down + first);
        [
            SideBlock::new(
                state.cells(up, self.behind + first),
                &self.up_side,
                first,
                self.wind,
            ),
            SideBlock::new(state.cells(down, down), &self.down_side, first, -self.wind),
        ]
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

/// A number of both sides of every face of a block.
type Both = [Block; 2];

/// In four passes over the block: each face is one long chain of results that wait for one another, and
/// within a pass the processor works on several.
#[inline(always)]
fn windy<const STEEP: bool>(
    up: &SideBlock<'_>,
    down: &SideBlock<'_>,
    [h_up, h_down]: &[Block; 2],
    length: &Block,
) -> FaceValues {
    let zero: Both = [[0.0; BLOCK]; 2];
    let (mut conductance, mut blow, mut pe, mut per_height) = (zero, zero, zero, zero);
    for k in 0..BLOCK {
        let [u, d] = inverses_of_both([up.h(k), down.h(k)], [h_up[k], h_down[k]]);
        let (u, d) = (up.half(k, h_up[k], u), down.half(k, h_down[k], d));
        for (side, half) in [(0, &u), (1, &d)] {
            let drive = half.drive(&half.logarithmic_mean::<STEEP>());
            conductance[side][k] = drive.conductance;
            blow[side][k] = drive.blow;
            pe[side][k] = drive.pe;
            per_height[side][k] = half.mean_inverse_height()[0];
        }
    }
    let mut e = zero;
    for side in 0..2 {
        for k in 0..BLOCK {
            e[side][k] = growth(pe[side][k]);
        }
    }
    let (mut alpha, mut beta, mut convective) = (zero, zero, zero);
    let mut rise = [0.0; BLOCK];
    for k in 0..BLOCK {
        let drive = |side: usize| Drive {
            conductance: conductance[side][k],
            blow: blow[side][k],
            pe: pe[side][k],
        };
        let half = up.half(k, h_up[k], [0.0; 2]);
        let flux = half.driven::<true>(&drive(0), e[0][k]);
        (alpha[0][k], beta[0][k]) = (flux.alpha, flux.beta);
        convective[0][k] = flux.convective::<true>();
        rise[k] = flux.rise;
        let half = down.half(k, h_down[k], [0.0; 2]);
        let flux = half.driven::<false>(&drive(1), e[1][k]);
        (alpha[1][k], beta[1][k]) = (flux.alpha, flux.beta);
        convective[1][k] = flux.convective::<false>();
    }
    let (mut flux, mut loads) = ([0.0; BLOCK], zero);
    for k in 0..BLOCK {
        let p = (alpha[0][k] + alpha[1][k]) / (beta[0][k] + beta[1][k]);
        flux[k] = length[k] * (alpha[0][k] - beta[0][k] * p);
        let half = up.half(k, h_up[k], [0.0; 2]);
        let excess = half.excess::<true>(rise[k], convective[0][k], per_height[0][k], p);
        loads[0][k] = up.area[k] * excess;
        let half = down.half(k, h_down[k], [0.0; 2]);
        let excess = half.excess::<false>(0.0, convective[1][k], per_height[1][k], p);
        loads[1][k] = down.area[k] * excess;
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
        let (u, d) = (
            up.half(k, h_up[k], [0.0; 2]),
            down.half(k, h_down[k], [0.0; 2]),
        );
        let ((a, b), (c, e)) = (u.still(), d.still());
        let p = (a + c) / (b + e);
        flux[k] = length[k] * (a - b * p);
        loads[0][k] = up.area[k] * u.still_excess(p);
        loads[1][k] = down.area[k] * d.still_excess(p);
    }
    FaceValues { flux, loads }
}

/// Faces on the slider's edge, where the ambient pressure stands.
#[inline(always)]
fn edge(film: &Film, side: &SideBlock<'_>, h_face: &Block, length: &Block) -> FaceValues {
    let (mut flux, mut loads) = ([0.0; BLOCK], [[0.0; BLOCK]; 2]);
    let p = film.ambient_pa;
    let mut put = |k: usize, (alpha, beta): (f64, f64), excess: f64| {
        flux[k] = length[k] * (alpha - beta * p);
        loads[0][k] = side.area[k] * excess;
    };
    for k in 0..BLOCK {
        let half = side.half(k, h_face[k], inverses(side.h(k), h_face[k]));
        if side.wind == 0.0 {
            put(k, half.still(), half.still_excess(p));
        } else if side.wind > 0.0 {
            let flux = half.flux::<true>(&half.logarithmic_mean::<true>());
            put(
                k,
                (flux.alpha, flux.beta),
                half.mean_excess::<true>(&flux, p),
            );
        } else {
            let flux = half.flux::<false>(&half.logarithmic_mean::<true>());
            put(
                k,
                (flux.alpha, flux.beta),
                half.mean_excess::<false>(&flux, p),
            );
        }
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
                pitch[k] -= load[k] * x[k];
            }
            for k in 0..SUMS {
                roll[k] += load[k] * y[k];
            }
        }
        self.sums = [force, pitch, roll];
    }

    pub(super) fn total(&self) -> [f64; 3] {
        self.sums.map(total)
    }
}
