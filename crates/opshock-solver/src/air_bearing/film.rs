//! The discrete film: grid, geometry, gas and flux balance of every cell.
//!
//! ```text
//! 12 μ A dψ/dt + R(ψ, attitude) = 0,   R = sum of outward face fluxes
//! ```
//!
//! ψ = p h is the mass in a cell's column over R T, so the balance is conservative and squeeze
//! enters through dψ/dt alone. Faces are [two half cells](super::flux); at the slider's edges the
//! face pressure is the ambient one.

use super::flow_factor::FlowFactor;
use super::flux::{HalfCell, HalfFlux};
use super::layout;
use super::thickness::Floor;
use super::{Attitude, FilmResolution, FlowModel};
use crate::gas::GasParameters;
use crate::grid::Lines;
use crate::linalg::banded::BandMatrix;
use crate::slider::SliderParameters;
use crate::slider::clearance::{Clearance, ClearanceMap};
use crate::slider::surface::Surface;
use thiserror::Error;

/// Why a film could not be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FilmError {
    /// A quantity that must be positive and finite is not.
    #[error("{quantity} must be positive and finite, found {value}")]
    NotPositive {
        /// What it is.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// Grid lines do not rise strictly over the slider's extent.
    #[error("grid lines along {direction} must rise strictly from 0 to {extent_m} m")]
    Lines {
        /// x or y.
        direction: char,
        /// Length or width, m.
        extent_m: f64,
    },
    /// A rail leaves no region whose shape could be resolved.
    #[error("rail {rail} has a corner that is not finite or fewer than three corners")]
    Rail {
        /// Index in the list of rails.
        rail: usize,
    },
}

/// Height of a place: the constant part and the lever arms of pitch and roll.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Form, without recess, m.
    form: f64,
    /// x − x_c, m.
    x: f64,
    /// y − y_c, m.
    y: f64,
}

impl Place {
    fn new(surface: &Surface, x: f64, y: f64) -> Self {
        let [xc, yc] = surface.centre_m();
        Self {
            form: surface.form_m(x, y),
            x: x - xc,
            y: y - yc,
        }
    }

    #[inline]
    fn height(&self, attitude: &Attitude) -> f64 {
        attitude.centre_height_m - attitude.pitch_rad * self.x
            + attitude.roll_rad * self.y
            + self.form
    }

    /// Derivatives of the height by attitude.
    #[inline]
    fn arms(&self) -> [f64; 3] {
        [1.0, -self.x, self.y]
    }
}

#[derive(Clone, Copy, Debug)]
struct Cell {
    place: Place,
    recess: f64,
    area: f64,
}

/// Face between two cells; the normal points from the first to the second.
#[derive(Clone, Copy, Debug)]
struct Face {
    cells: [usize; 2],
    place: Place,
    recess: [f64; 2],
    /// 1/Δ of both half cells.
    inverse_distance: [f64; 2],
    length: f64,
    /// 6 μ U · normal.
    wind: f64,
}

/// Face on the slider's edge.
#[derive(Clone, Copy, Debug)]
struct EdgeFace {
    cell: usize,
    place: Place,
    recess: f64,
    inverse_distance: f64,
    length: f64,
    /// 6 μ U · outward normal.
    wind: f64,
}

/// Film under one slider: immutable once built.
#[derive(Clone, Debug)]
pub struct Film {
    lines: [Lines; 2],
    cells: Vec<Cell>,
    faces: Vec<Face>,
    edge_faces: Vec<EdgeFace>,
    capacity: Vec<f64>,
    half_bandwidth: usize,
    /// Cells are numbered fastest along y (the usual case) or along x.
    along_y: bool,
    flow: FlowFactor,
    floor: Floor,
    ambient_pa: f64,
    clearance: ClearanceMap,
}

/// Scratch of the flux balance, one per thread.
#[derive(Clone, Debug)]
pub struct FilmScratch {
    /// Height, its derivative by the true height, G and dG/dψ of every cell.
    columns: Vec<Column>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Column {
    h: f64,
    h_slope: f64,
    g: f64,
    g_slope: f64,
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
}

impl Film {
    /// Discretises the film of `slider` in `gas` over a disk turning at `spin_rad_per_s`.
    ///
    /// The disk's velocity is taken uniform over the slider, Ω r at its centre, turned by the skew.
    ///
    /// # Errors
    ///
    /// [`FilmError`] when a size, a gas property or the floor is not positive, or a rail is not a
    /// polygon.
    pub fn build(
        slider: &SliderParameters,
        gas: &GasParameters,
        flow: FlowModel,
        spin_rad_per_s: f64,
        resolution: &FilmResolution,
    ) -> Result<Self, FilmError> {
        check(slider, gas, resolution.floor_m)?;
        let lines = layout::lines(&Surface::new(slider), resolution.cells);
        Self::on_lines(slider, gas, flow, spin_rad_per_s, resolution.floor_m, lines)
    }

    /// The same on given grid lines, along x and along y, instead of the built-in layout.
    ///
    /// # Errors
    ///
    /// As [`Film::build`], and when the lines do not span the slider.
    pub fn on_grid(
        slider: &SliderParameters,
        gas: &GasParameters,
        flow: FlowModel,
        spin_rad_per_s: f64,
        floor_m: f64,
        lines_m: [&[f64]; 2],
    ) -> Result<Self, FilmError> {
        check(slider, gas, floor_m)?;
        let lines = |k: usize, direction: char, extent_m: f64| {
            let error = FilmError::Lines {
                direction,
                extent_m,
            };
            let lines = Lines::new(lines_m[k].to_vec()).ok_or(error.clone())?;
            let (first, last) = (lines_m[k][0], lines_m[k][lines_m[k].len() - 1]);
            let tolerance = 1e-9 * extent_m;
            if first.abs() > tolerance || (last - extent_m).abs() > tolerance {
                return Err(error);
            }
            Ok(lines)
        };
        let lines = [
            lines(0, 'x', slider.length_m)?,
            lines(1, 'y', slider.width_m)?,
        ];
        Self::on_lines(slider, gas, flow, spin_rad_per_s, floor_m, lines)
    }

    fn on_lines(
        slider: &SliderParameters,
        gas: &GasParameters,
        flow: FlowModel,
        spin_rad_per_s: f64,
        floor_m: f64,
        lines: [Lines; 2],
    ) -> Result<Self, FilmError> {
        let surface = Surface::new(slider);
        let [nx, ny] = [lines[0].n_cells(), lines[1].n_cells()];
        let along_y = ny <= nx;
        let index = |i: usize, j: usize| if along_y { i * ny + j } else { j * nx + i };
        let speed = spin_rad_per_s * slider.radius_m;
        let wind = [
            6.0 * gas.viscosity_pa_s * speed * slider.skew_rad.cos(),
            6.0 * gas.viscosity_pa_s * speed * slider.skew_rad.sin(),
        ];

        let blank = Cell {
            place: Place {
                form: 0.0,
                x: 0.0,
                y: 0.0,
            },
            recess: 0.0,
            area: 0.0,
        };
        let mut cells = vec![blank; nx * ny];
        let (xs, ys) = (lines[0].as_slice(), lines[1].as_slice());
        for i in 0..nx {
            for j in 0..ny {
                cells[index(i, j)] = Cell {
                    place: Place::new(&surface, lines[0].centre(i), lines[1].centre(j)),
                    recess: surface.mean_recess_m([xs[i], xs[i + 1]], [ys[j], ys[j + 1]]),
                    area: lines[0].width(i) * lines[1].width(j),
                };
            }
        }

        let mut faces = Vec::with_capacity(2 * nx * ny);
        let mut edge_faces = Vec::with_capacity(2 * (nx + ny));
        let mut add = |d: usize, line: usize, across: usize| {
            // Cells before and behind the line, if any, along direction d.
            let n = lines[d].n_cells();
            let cell = |k: usize| {
                if d == 0 {
                    index(k, across)
                } else {
                    index(across, k)
                }
            };
            let middle = lines[1 - d].centre(across);
            let at = lines[d].as_slice()[line];
            let (x, y) = if d == 0 { (at, middle) } else { (middle, at) };
            let place = Place::new(&surface, x, y);
            let length = lines[1 - d].width(across);
            let inverse = |k: usize| 2.0 / lines[d].width(k);
            if line == 0 || line == n {
                let k = if line == 0 { 0 } else { n - 1 };
                edge_faces.push(EdgeFace {
                    cell: cell(k),
                    place,
                    recess: cells[cell(k)].recess,
                    inverse_distance: inverse(k),
                    length,
                    wind: if line == 0 { -wind[d] } else { wind[d] },
                });
            } else {
                let pair = [cell(line - 1), cell(line)];
                faces.push(Face {
                    cells: pair,
                    place,
                    recess: pair.map(|c| cells[c].recess),
                    inverse_distance: [inverse(line - 1), inverse(line)],
                    length,
                    wind: wind[d],
                });
            }
        };
        for line in 0..=nx {
            for across in 0..ny {
                add(0, line, across);
            }
        }
        for across in 0..nx {
            for line in 0..=ny {
                add(1, line, across);
            }
        }

        Ok(Self {
            capacity: cells
                .iter()
                .map(|c| 12.0 * gas.viscosity_pa_s * c.area)
                .collect(),
            half_bandwidth: nx.min(ny),
            along_y,
            cells,
            faces,
            edge_faces,
            lines,
            flow: FlowFactor::new(flow, gas.mean_free_path_m * gas.pressure_pa),
            floor: Floor { h0: floor_m },
            ambient_pa: gas.pressure_pa,
            clearance: ClearanceMap::new(&surface),
        })
    }

    /// Number of cells n, the length of every ψ.
    pub fn n_cells(&self) -> usize {
        self.cells.len()
    }

    /// Grid lines along x and along y, m.
    pub fn lines_m(&self) -> [&[f64]; 2] {
        [self.lines[0].as_slice(), self.lines[1].as_slice()]
    }

    /// Index in ψ of the cell between lines `i`, `i + 1` along x and `j`, `j + 1` along y.
    pub fn cell_index(&self, i: usize, j: usize) -> usize {
        if self.along_y {
            i * self.lines[1].n_cells() + j
        } else {
            j * self.lines[0].n_cells() + i
        }
    }

    /// 12 μ A of every cell, Pa s m2; what multiplies dψ/dt.
    pub fn capacity(&self) -> &[f64] {
        &self.capacity
    }

    /// Ambient pressure, Pa.
    pub fn ambient_pa(&self) -> f64 {
        self.ambient_pa
    }

    /// Height h0 of the film's floor, m.
    pub fn floor_m(&self) -> f64 {
        self.floor.h0
    }

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
            by_psi: BandMatrix::zeros(n, self.half_bandwidth),
            by_attitude: std::array::from_fn(|_| vec![0.0; n]),
        }
    }

    /// Height the film sees in a cell and its derivative by the true height.
    #[inline]
    fn cell_height(&self, cell: &Cell, attitude: &Attitude) -> (f64, f64) {
        self.floor.apply(cell.place.height(attitude) + cell.recess)
    }

    /// ψ of the undisturbed ambient pressure, Pa m.
    ///
    /// # Panics
    ///
    /// When `out` has not n_cells entries.
    pub fn ambient_psi(&self, attitude: &Attitude, out: &mut [f64]) {
        assert_eq!(out.len(), self.n_cells());
        for (psi, cell) in out.iter_mut().zip(&self.cells) {
            *psi = self.ambient_pa * self.cell_height(cell, attitude).0;
        }
    }

    /// Pressure at the cells' centres, Pa.
    ///
    /// # Panics
    ///
    /// When a slice has not n_cells entries.
    pub fn pressure(&self, psi: &[f64], attitude: &Attitude, out: &mut [f64]) {
        assert_eq!(psi.len(), self.n_cells());
        assert_eq!(out.len(), self.n_cells());
        for ((p, psi), cell) in out.iter_mut().zip(psi).zip(&self.cells) {
            *p = psi / self.cell_height(cell, attitude).0;
        }
    }

    /// Smallest clearance of the true surface over the disk's plane.
    pub fn min_clearance(&self, attitude: &Attitude) -> Clearance {
        self.clearance.minimum(
            attitude.centre_height_m,
            attitude.pitch_rad,
            attitude.roll_rad,
        )
    }

    fn fill_columns(&self, psi: &[f64], attitude: &Attitude, scratch: &mut FilmScratch) {
        assert_eq!(psi.len(), self.n_cells());
        assert_eq!(scratch.columns.len(), self.n_cells());
        for ((column, &psi), cell) in scratch.columns.iter_mut().zip(psi).zip(&self.cells) {
            let (h, h_slope) = self.cell_height(cell, attitude);
            let (g, g_slope) = self.flow.conductance(psi);
            *column = Column {
                h,
                h_slope,
                g,
                g_slope,
            };
        }
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
        let columns = &scratch.columns;
        out.fill(0.0);
        for face in &self.faces {
            let [l, r] = face.cells;
            let base = face.place.height(attitude);
            let half = |side: usize, cell: usize, wind: f64| {
                self.half_cell(
                    psi[cell],
                    &columns[cell],
                    base + face.recess[side],
                    face.inverse_distance[side],
                    wind,
                )
                .0
                .flux()
            };
            let (left, right) = (half(0, l, face.wind), half(1, r, -face.wind));
            let pressure = (left.alpha + right.alpha) / (left.beta + right.beta);
            let flux = face.length * (left.alpha - left.beta * pressure);
            out[l] += flux;
            out[r] -= flux;
        }
        for face in &self.edge_faces {
            let base = face.place.height(attitude);
            let (half, _) = self.half_cell(
                psi[face.cell],
                &columns[face.cell],
                base + face.recess,
                face.inverse_distance,
                face.wind,
            );
            let flux = half.flux();
            out[face.cell] += face.length * (flux.alpha - flux.beta * self.ambient_pa);
        }
    }

    /// Half cell and the floor's derivative at its face.
    #[inline]
    fn half_cell(
        &self,
        psi: f64,
        column: &Column,
        face_height: f64,
        inverse_distance: f64,
        wind: f64,
    ) -> (HalfCell, f64) {
        let (h_face, slope) = self.floor.apply(face_height);
        (
            HalfCell {
                psi,
                g: column.g,
                g_slope: column.g_slope,
                h_centre: column.h,
                h_face,
                inverse_distance,
                wind,
            },
            slope,
        )
    }

    /// R with dR/dψ and dR/d(h_c, pitch, roll).
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

        for face in &self.faces {
            let base = face.place.height(attitude);
            let mut halves: [(HalfCell, f64); 2] = std::array::from_fn(|s| {
                let cell = face.cells[s];
                let wind = if s == 0 { face.wind } else { -face.wind };
                self.half_cell(
                    psi[cell],
                    &columns[cell],
                    base + face.recess[s],
                    face.inverse_distance[s],
                    wind,
                )
            });
            let flux: [HalfFlux; 2] = std::array::from_fn(|s| halves[s].0.flux());
            let total = flux[0].beta + flux[1].beta;
            let pressure = (flux[0].alpha + flux[1].alpha) / total;
            // J = α_l − β_l p_f; with the face pressure eliminated a change of one side reaches J
            // through the other side's share of β.
            let share = [
                face.length * flux[1].beta / total,
                -face.length * flux[0].beta / total,
            ];
            let j = face.length * (flux[0].alpha - flux[0].beta * pressure);
            let [l, r] = face.cells;
            out.residual[l] += j;
            out.residual[r] -= j;
            let mut by_attitude = [0.0; 3];
            for s in 0..2 {
                let (half, face_slope) = &mut halves[s];
                let [by_psi, by_centre, by_face] = half.derivatives(&flux[s], pressure);
                let cell = face.cells[s];
                out.by_psi.add(l, cell, share[s] * by_psi);
                out.by_psi.add(r, cell, -share[s] * by_psi);
                let centre = share[s] * by_centre * columns[cell].h_slope;
                let at_face = share[s] * by_face * *face_slope;
                let arms = self.cells[cell].place.arms();
                let face_arms = face.place.arms();
                for q in 0..3 {
                    by_attitude[q] += centre * arms[q] + at_face * face_arms[q];
                }
            }
            for (column, by) in out.by_attitude.iter_mut().zip(by_attitude) {
                column[l] += by;
                column[r] -= by;
            }
        }
        for face in &self.edge_faces {
            let c = face.cell;
            let base = face.place.height(attitude);
            let (half, face_slope) = self.half_cell(
                psi[c],
                &columns[c],
                base + face.recess,
                face.inverse_distance,
                face.wind,
            );
            let flux = half.flux();
            let p = self.ambient_pa;
            let [by_psi, by_centre, by_face] = half.derivatives(&flux, p);
            out.residual[c] += face.length * (flux.alpha - flux.beta * p);
            out.by_psi.add(c, c, face.length * by_psi);
            let centre = face.length * by_centre * columns[c].h_slope;
            let at_face = face.length * by_face * face_slope;
            let (arms, face_arms) = (self.cells[c].place.arms(), face.place.arms());
            for q in 0..3 {
                out.by_attitude[q][c] += centre * arms[q] + at_face * face_arms[q];
            }
        }
    }

    /// Force and moments [F_z, M_pitch, M_roll] of the film on the slider, conjugate to (h_c,
    /// pitch, roll): N, N m, N m.
    ///
    /// # Panics
    ///
    /// When `psi` has not n_cells entries.
    pub fn force(&self, psi: &[f64], attitude: &Attitude) -> [f64; 3] {
        assert_eq!(psi.len(), self.n_cells());
        let mut force = [0.0; 3];
        for (psi, cell) in psi.iter().zip(&self.cells) {
            let p = psi / self.cell_height(cell, attitude).0;
            let load = (p - self.ambient_pa) * cell.area;
            for (f, arm) in force.iter_mut().zip(cell.place.arms()) {
                *f += load * arm;
            }
        }
        force
    }

    /// Gradients of [`Film::force`]: `by_psi[f][cell]` and `by_attitude[f][q]`.
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
        *by_attitude = [[0.0; 3]; 3];
        for (k, (psi, cell)) in psi.iter().zip(&self.cells).enumerate() {
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

fn check(slider: &SliderParameters, gas: &GasParameters, floor_m: f64) -> Result<(), FilmError> {
    for (quantity, value) in [
        ("slider length", slider.length_m),
        ("slider width", slider.width_m),
        ("ambient pressure", gas.pressure_pa),
        ("viscosity", gas.viscosity_pa_s),
        ("mean free path", gas.mean_free_path_m),
        ("film floor", floor_m),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(FilmError::NotPositive { quantity, value });
        }
    }
    for (rail, shape) in slider.surface.rails.iter().enumerate() {
        let corners = shape.outline.corners_m();
        if corners.len() < 3 || corners.iter().flatten().any(|c| !c.is_finite()) {
            return Err(FilmError::Rail { rail });
        }
    }
    Ok(())
}
