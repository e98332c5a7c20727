//! Flux balance of all cells and force on the slider, with their derivatives.
//!
//! One sweep over the faces yields, per face, the flux from cell to cell and the force of the two
//! half cells beyond their centres' pressure. Everything public here is a choice of what to add up.

use super::Attitude;
use super::film::Film;
use super::flux::{HalfCell, Partials};
use super::mesh::{Cell, Place, Side};
use crate::linalg::banded::BandMatrix;

/// Scratch of the flux balance, one per thread.
#[derive(Clone, Debug)]
pub struct FilmScratch {
    /// Height, its derivative by the true height, G and dG/dψ of every cell.
    columns: Vec<Column>,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Column {
    pub(super) h: f64,
    pub(super) h_slope: f64,
    pub(super) g: f64,
    pub(super) g_slope: f64,
}

/// Residual and derivatives of the flux balance at one state.
#[derive(Clone, Debug)]
pub struct FilmLinearisation {
    /// R, as from [`Film::flux_residual`]; length n_cells.
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

/// Flux and load of one face with their derivatives.
struct FaceDerivatives {
    /// Cell the flux leaves, and cell it enters.
    cells: [Option<usize>; 2],
    /// Cells whose ψ the derivatives are by; may repeat.
    sources: [usize; 4],
    arms: [f64; 3],
    flux: f64,
    flux_by_psi: [f64; 4],
    flux_by_attitude: [f64; 3],
    load: f64,
    load_by_psi: [f64; 4],
    load_by_attitude: [f64; 3],
}

impl FaceDerivatives {
    #[inline(always)]
    fn add_force_gradients(&self, by_psi: &mut [Vec<f64>; 3], by_attitude: &mut [[f64; 3]; 3]) {
        for (f, arm) in self.arms.into_iter().enumerate() {
            for (cell, by) in self.sources.into_iter().zip(self.load_by_psi) {
                by_psi[f][cell] += arm * by;
            }
            for (sum, by) in by_attitude[f].iter_mut().zip(self.load_by_attitude) {
                *sum += arm * by;
            }
        }
    }
}

impl Film {
    /// Scratch for this film.
    pub fn scratch(&self) -> FilmScratch {
        FilmScratch {
            columns: vec![Column::default(); self.n_cells()],
        }
    }

    /// Zeroed linearisation of the right shape.
    pub fn linearisation(&self) -> FilmLinearisation {
        let n = self.n_cells();
        FilmLinearisation {
            residual: vec![0.0; n],
            by_psi: BandMatrix::zeros(n, self.mesh.half_bandwidth()),
            by_attitude: std::array::from_fn(|_| vec![0.0; n]),
            force: [0.0; 3],
            force_by_psi: std::array::from_fn(|_| vec![0.0; n]),
            force_by_attitude: [[0.0; 3]; 3],
        }
    }

    #[inline(always)]
    pub(super) fn column(&self, cell: &Cell, psi: f64, attitude: &Attitude) -> Column {
        let (h, h_slope) = self.cell_height(cell, attitude);
        let (g, g_slope) = self.flow.conductance(psi);
        Column {
            h,
            h_slope,
            g,
            g_slope,
        }
    }

    fn fill_columns(&self, psi: &[f64], attitude: &Attitude, scratch: &mut FilmScratch) {
        assert_eq!(psi.len(), self.n_cells());
        assert_eq!(scratch.columns.len(), self.n_cells());
        for ((column, &psi), cell) in scratch.columns.iter_mut().zip(psi).zip(&self.mesh.cells) {
            *column = self.column(cell, psi, attitude);
        }
    }

    /// Half cell of `side` and the floor's derivative at its face, whose true height without recess
    /// is `base`.
    #[inline(always)]
    pub(super) fn half_cell(
        &self,
        side: &Side,
        psi: &[f64],
        column: &Column,
        base: f64,
    ) -> (HalfCell, f64) {
        let (h_face, slope) = self.face_height(base + side.recess);
        (
            HalfCell {
                psi: psi[side.cell],
                psi_behind: psi[side.behind],
                reach: side.reach,
                g: column.g,
                g_slope: column.g_slope,
                h_centre: column.h,
                h_face,
                inverse_distance: side.inverse_distance,
                wind: side.wind,
            },
            slope,
        )
    }

    /// Net outward flux R of every cell: `capacity` dψ/dt + `out` = 0.
    ///
    /// ψ must be positive.
    ///
    /// # Panics
    ///
    /// When a slice has not n_cells entries.
    pub fn flux_residual(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        out: &mut [f64],
        scratch: &mut FilmScratch,
    ) {
        assert_eq!(out.len(), self.n_cells());
        self.fill_columns(psi, attitude, scratch);
        out.fill(0.0);
        self.sweep(
            psi,
            attitude,
            |c| scratch.columns[c],
            |cells, flux, _, _| {
                for (cell, sign) in cells.into_iter().zip([1.0, -1.0]) {
                    if let Some(cell) = cell {
                        out[cell] += sign * flux;
                    }
                }
            },
        );
    }

    /// [`Film::flux_residual`] and [`Film::force`] in one pass over the faces.
    ///
    /// # Panics
    ///
    /// When a slice has not n_cells entries.
    pub fn flux_residual_and_force(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        out: &mut [f64],
        scratch: &mut FilmScratch,
    ) -> [f64; 3] {
        assert_eq!(out.len(), self.n_cells());
        self.fill_columns(psi, attitude, scratch);
        out.fill(0.0);
        let mut force = self.centre_force(psi, attitude);
        self.sweep(
            psi,
            attitude,
            |c| scratch.columns[c],
            |cells, flux, loads, place| {
                for (cell, sign) in cells.into_iter().zip([1.0, -1.0]) {
                    if let Some(cell) = cell {
                        out[cell] += sign * flux;
                    }
                }
                for (f, arm) in force.iter_mut().zip(place.arms()) {
                    *f += (loads[0] + loads[1]) * arm;
                }
            },
        );
        force
    }

    /// Force and moments [F_z, M_pitch, M_roll] of the film on the slider, conjugate to (h_c,
    /// pitch, roll): N, N m, N m.
    ///
    /// The pressure is integrated over the same profiles the fluxes assume, so that the thin
    /// layers at the pads' edges count although no cell resolves them.
    ///
    /// # Panics
    ///
    /// When `psi` has not n_cells entries.
    pub fn force(&self, psi: &[f64], attitude: &Attitude) -> [f64; 3] {
        assert_eq!(psi.len(), self.n_cells());
        let mut force = self.centre_force(psi, attitude);
        let column = |c: usize| self.column(&self.mesh.cells[c], psi[c], attitude);
        self.sweep(psi, attitude, column, |_, _, loads, place| {
            for (f, arm) in force.iter_mut().zip(place.arms()) {
                *f += (loads[0] + loads[1]) * arm;
            }
        });
        force
    }

    /// Normal force on every cell, N, over the same profiles as [`Film::force`].
    ///
    /// # Panics
    ///
    /// When a slice has not n_cells entries.
    pub fn cell_forces(&self, psi: &[f64], attitude: &Attitude, out: &mut [f64]) {
        assert_eq!(psi.len(), self.n_cells());
        assert_eq!(out.len(), self.n_cells());
        for ((force, psi), cell) in out.iter_mut().zip(psi).zip(&self.mesh.cells) {
            let p = psi / self.cell_height(cell, attitude).0;
            *force = (p - self.ambient_pa) * cell.area;
        }
        let column = |c: usize| self.column(&self.mesh.cells[c], psi[c], attitude);
        self.sweep(psi, attitude, column, |cells, _, loads, _| {
            for (cell, load) in cells.into_iter().zip(loads) {
                if let Some(cell) = cell {
                    out[cell] += load;
                }
            }
        });
    }

    /// Force of the pressures at the cells' centres, each over its whole cell.
    fn centre_force(&self, psi: &[f64], attitude: &Attitude) -> [f64; 3] {
        let mut force = [0.0; 3];
        for (psi, cell) in psi.iter().zip(&self.mesh.cells) {
            let p = psi / self.cell_height(cell, attitude).0;
            let load = (p - self.ambient_pa) * cell.area;
            for (f, arm) in force.iter_mut().zip(cell.place.arms()) {
                *f += load * arm;
            }
        }
        force
    }

    /// Hands every face's flux (out of the first cell, into the second) and the forces of its
    /// half cells beyond their centre pressures to `take`.
    #[inline(always)]
    fn sweep(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        column: impl Fn(usize) -> Column,
        mut take: impl FnMut([Option<usize>; 2], f64, [f64; 2], &Place),
    ) {
        for face in &self.mesh.faces {
            let base = face.place.height(attitude);
            let half: [HalfCell; 2] = std::array::from_fn(|s| {
                let side = &face.sides[s];
                self.half_cell(side, psi, &column(side.cell), base).0
            });
            let (out, excess) = if face.sides[0].wind == 0.0 {
                let [(a, b), (c, d)] = half.map(|h| h.still());
                let p = (a + c) / (b + d);
                (a - b * p, half.map(|h| h.still_excess(p)))
            } else {
                let [left, right] = [half[0].flux(), half[1].flux()];
                let p = (left.alpha + right.alpha) / (left.beta + right.beta);
                let excess = [
                    half[0].mean_excess(&left, p),
                    half[1].mean_excess(&right, p),
                ];
                (left.alpha - left.beta * p, excess)
            };
            let loads = [
                face.sides[0].area * excess[0],
                face.sides[1].area * excess[1],
            ];
            take(
                face.sides.map(|side| Some(side.cell)),
                face.length * out,
                loads,
                &face.place,
            );
        }
        for face in &self.mesh.edge_faces {
            let side = &face.side;
            let base = face.place.height(attitude);
            let half = self.half_cell(side, psi, &column(side.cell), base).0;
            let (flux, p) = (half.flux(), self.ambient_pa);
            take(
                [Some(side.cell), None],
                face.length * (flux.alpha - flux.beta * p),
                [side.area * half.mean_excess(&flux, p), 0.0],
                &face.place,
            );
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
        self.fill_columns(psi, attitude, scratch);
        let columns = &scratch.columns;
        out.residual.fill(0.0);
        out.by_psi.clear();
        out.by_attitude.iter_mut().for_each(|c| c.fill(0.0));
        out.force = self.centre_force(psi, attitude);
        self.centre_gradients(
            psi,
            attitude,
            &mut out.force_by_psi,
            &mut out.force_by_attitude,
        );

        let by_psi = &mut out.by_psi;
        let (residual, by_attitude) = (&mut out.residual, &mut out.by_attitude);
        let (force, force_by_psi) = (&mut out.force, &mut out.force_by_psi);
        let force_by_attitude = &mut out.force_by_attitude;
        self.sweep_derivatives(
            psi,
            attitude,
            |c| columns[c],
            |face| {
                for (cell, sign) in face.cells.into_iter().zip([1.0, -1.0]) {
                    let Some(cell) = cell else { continue };
                    residual[cell] += sign * face.flux;
                    for (k, by) in face.sources.into_iter().zip(face.flux_by_psi) {
                        by_psi.add(cell, k, sign * by);
                    }
                    for (column, by) in by_attitude.iter_mut().zip(face.flux_by_attitude) {
                        column[cell] += sign * by;
                    }
                }
                for (f, arm) in force.iter_mut().zip(face.arms) {
                    *f += arm * face.load;
                }
                face.add_force_gradients(force_by_psi, force_by_attitude);
            },
        );
    }

    /// Gradients of [`Film::force`] alone: `by_psi[f][cell]` and `by_attitude[f][q]`, q at constant
    /// ψ. [`Film::linearise`] yields them too, at little more than its own cost.
    ///
    /// # Panics
    ///
    /// When a slice has not n_cells entries.
    pub fn force_gradients(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        by_psi: &mut [Vec<f64>; 3],
        by_attitude: &mut [[f64; 3]; 3],
    ) {
        assert_eq!(psi.len(), self.n_cells());
        assert!(by_psi.iter().all(|row| row.len() == self.n_cells()));
        self.centre_gradients(psi, attitude, by_psi, by_attitude);
        let column = |c: usize| self.column(&self.mesh.cells[c], psi[c], attitude);
        self.sweep_derivatives(psi, attitude, column, |face| {
            face.add_force_gradients(by_psi, by_attitude);
        });
    }

    /// Hands flux and load of every face with their derivatives to `take`.
    #[inline(always)]
    fn sweep_derivatives(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        column: impl Fn(usize) -> Column,
        mut take: impl FnMut(&FaceDerivatives),
    ) {
        for face in &self.mesh.faces {
            let base = face.place.height(attitude);
            let columns = [column(face.sides[0].cell), column(face.sides[1].cell)];
            let (a, a_slope) = self.half_cell(&face.sides[0], psi, &columns[0], base);
            let (b, b_slope) = self.half_cell(&face.sides[1], psi, &columns[1], base);
            let half = [a, b];
            let flux = [a.flux(), b.flux()];
            let inverse_total = 1.0 / (flux[0].beta + flux[1].beta);
            let p = (flux[0].alpha + flux[1].alpha) / (flux[0].beta + flux[1].beta);

            // J = α_l − β_l p_f; with the face pressure eliminated a change of one side reaches J
            // through the other side's share of β, and p_f through 1/(β_l + β_r).
            let share = [
                face.length * flux[1].beta * inverse_total,
                -face.length * flux[0].beta * inverse_total,
            ];
            let partials: [_; 2] = std::array::from_fn(|s| half[s].partials(&flux[s], p));
            let load_by_p = inverse_total
                * (face.sides[0].area * partials[0].excess_by_p
                    + face.sides[1].area * partials[1].excess_by_p);
            let mut all = FaceDerivatives {
                cells: face.sides.map(|side| Some(side.cell)),
                sources: [0; 4],
                arms: face.place.arms(),
                flux: face.length * (flux[0].alpha - flux[0].beta * p),
                flux_by_psi: [0.0; 4],
                flux_by_attitude: [0.0; 3],
                load: face.sides[0].area * half[0].mean_excess(&flux[0], p)
                    + face.sides[1].area * half[1].mean_excess(&flux[1], p),
                load_by_psi: [0.0; 4],
                load_by_attitude: [0.0; 3],
            };
            for (s, face_slope) in [a_slope, b_slope].into_iter().enumerate() {
                let (side, part) = (&face.sides[s], &partials[s]);
                let load: Partials =
                    std::array::from_fn(|v| side.area * part.excess[v] + load_by_p * part.flux[v]);
                let by = part.flux.map(|by| share[s] * by);
                all.sources[2 * s..2 * s + 2].copy_from_slice(&[side.cell, side.behind]);
                all.flux_by_psi[2 * s..2 * s + 2].copy_from_slice(&by[..2]);
                all.load_by_psi[2 * s..2 * s + 2].copy_from_slice(&load[..2]);
                let slopes = [columns[s].h_slope, face_slope];
                self.add_by_attitude(side, &all.arms, slopes, &by, &mut all.flux_by_attitude);
                self.add_by_attitude(side, &all.arms, slopes, &load, &mut all.load_by_attitude);
            }
            take(&all);
        }

        for face in &self.mesh.edge_faces {
            let side = &face.side;
            let column = column(side.cell);
            let base = face.place.height(attitude);
            let (half, face_slope) = self.half_cell(side, psi, &column, base);
            let (flux, p) = (half.flux(), self.ambient_pa);
            let partials = half.partials(&flux, p);
            let by = partials.flux.map(|by| face.length * by);
            let load = partials.excess.map(|by| side.area * by);
            let mut all = FaceDerivatives {
                cells: [Some(side.cell), None],
                sources: [side.cell, side.behind, side.cell, side.cell],
                arms: face.place.arms(),
                flux: face.length * (flux.alpha - flux.beta * p),
                flux_by_psi: [by[0], by[1], 0.0, 0.0],
                flux_by_attitude: [0.0; 3],
                load: side.area * half.mean_excess(&flux, p),
                load_by_psi: [load[0], load[1], 0.0, 0.0],
                load_by_attitude: [0.0; 3],
            };
            let slopes = [column.h_slope, face_slope];
            self.add_by_attitude(side, &all.arms, slopes, &by, &mut all.flux_by_attitude);
            self.add_by_attitude(side, &all.arms, slopes, &load, &mut all.load_by_attitude);
            take(&all);
        }
    }

    /// Adds derivatives by attitude that come through the heights at the cell's centre and at the
    /// face, whose floors have the derivatives `slopes`.
    #[inline(always)]
    fn add_by_attitude(
        &self,
        side: &Side,
        face_arms: &[f64; 3],
        slopes: [f64; 2],
        by: &Partials,
        out: &mut [f64; 3],
    ) {
        let centre_arms = self.mesh.cells[side.cell].place.arms();
        for q in 0..3 {
            out[q] += by[2] * slopes[0] * centre_arms[q] + by[3] * slopes[1] * face_arms[q];
        }
    }

    /// Gradients of [`Film::centre_force`].
    fn centre_gradients(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        by_psi: &mut [Vec<f64>; 3],
        by_attitude: &mut [[f64; 3]; 3],
    ) {
        *by_attitude = [[0.0; 3]; 3];
        for (k, (psi, cell)) in psi.iter().zip(&self.mesh.cells).enumerate() {
            let (h, h_slope) = self.cell_height(cell, attitude);
            let arms = cell.place.arms();
            let per_psi = cell.area / h;
            let per_height = -psi * cell.area * h_slope / (h * h);
            for f in 0..3 {
                by_psi[f][k] = per_psi * arms[f];
                for q in 0..3 {
                    by_attitude[f][q] += per_height * arms[f] * arms[q];
                }
            }
        }
    }
}
