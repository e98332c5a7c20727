//! The discrete film: grid, geometry, gas and flux balance of every cell.
//!
//! ```text
//! 12 μ A dψ/dt + R(ψ, attitude) = 0,   R = sum of outward face fluxes
//! ```
//!
//! ψ = p h is the mass in a cell's column over R T, so the balance is conservative and squeeze
//! enters through dψ/dt alone. Faces are [two half cells](super::flux); at the slider's edges the
//! face pressure is the ambient one.

use super::corner::{Widths, conductance_factors};
use super::flow_factor::FlowFactor;
use super::flux::{HalfCell, Partials};
use super::layout;
use super::steady::usual_attitude;
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

/// Recesses closer than this belong to one smooth stretch of film.
const SAME_RECESS_M: f64 = 1e-12;

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

/// One cell's side of a face.
#[derive(Clone, Copy, Debug)]
struct Side {
    cell: usize,
    /// The next cell away from the face; `cell` itself when `reach` is 0.
    behind: usize,
    /// See [`HalfCell::reach`].
    reach: f64,
    recess: f64,
    /// 1/Δ.
    inverse_distance: f64,
    /// 6 μ U · outward normal.
    wind: f64,
    /// Area of the half cell.
    area: f64,
}

/// Face between two cells.
#[derive(Clone, Copy, Debug)]
struct Face {
    sides: [Side; 2],
    place: Place,
    length: f64,
}

/// Face on the slider's edge.
#[derive(Clone, Copy, Debug)]
struct EdgeFace {
    side: Side,
    place: Place,
    length: f64,
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
    #[inline]
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

/// Film under one slider: immutable once built.
#[derive(Clone, Debug)]
pub struct Film {
    lines: [Lines; 2],
    cells: Vec<Cell>,
    faces: Vec<Face>,
    edge_faces: Vec<EdgeFace>,
    capacity: Vec<f64>,
    half_bandwidth: usize,
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
    /// [F_z, M_pitch, M_roll], as from [`Film::force`].
    pub force: [f64; 3],
    /// Derivatives of each force by every cell's ψ; each of length n_cells.
    pub force_by_psi: [Vec<f64>; 3],
    /// Derivatives of each force by (h_c, pitch, roll) at constant ψ: `[force][q]`.
    pub force_by_attitude: [[f64; 3]; 3],
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
        let surface = Surface::new(slider);
        let film =
            |lines| Self::on_lines(slider, gas, flow, spin_rad_per_s, resolution.floor_m, lines);
        let lines = |cells| {
            layout::plain(&surface, cells).ok_or(FilmError::Lines {
                direction: 'x',
                extent_m: slider.length_m,
            })
        };
        let estimate = layout::estimate_cells(resolution.cells);
        let mut built = film(lines(estimate)?)?;
        for round in 1..=layout::ROUNDS {
            let cells = if round == layout::ROUNDS {
                resolution.cells
            } else {
                estimate
            };
            match layout::refined(&built, &surface, cells) {
                Some(lines) => built = film(lines)?,
                None => return film(lines(resolution.cells)?),
            }
        }
        Ok(built)
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
        let index = |i: usize, j: usize| j * nx + i;
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
            // Side of cell k, whose outward normal points along `sign`.
            let side = |k: usize, sign: f64| {
                let half_width = 0.5 * lines[d].width(k);
                let blows_here = sign * wind[d] > 0.0;
                let behind = if sign > 0.0 {
                    k.checked_sub(1)
                } else {
                    Some(k + 1).filter(|&b| b < n)
                };
                // Numbering runs along x, so a second neighbour along x costs no bandwidth.
                let behind = behind.filter(|&b| {
                    d == 0
                        && blows_here
                        && (cells[cell(b)].recess - cells[cell(k)].recess).abs() < SAME_RECESS_M
                });
                Side {
                    cell: cell(k),
                    behind: cell(behind.unwrap_or(k)),
                    reach: behind.map_or(0.0, |b| {
                        lines[d].width(k) / (lines[d].width(k) + lines[d].width(b))
                    }),
                    recess: cells[cell(k)].recess,
                    inverse_distance: 1.0 / half_width,
                    wind: sign * wind[d],
                    area: half_width * length,
                }
            };
            if line == 0 {
                edge_faces.push(EdgeFace {
                    side: side(0, -1.0),
                    place,
                    length,
                });
            } else if line == n {
                edge_faces.push(EdgeFace {
                    side: side(n - 1, 1.0),
                    place,
                    length,
                });
            } else {
                faces.push(Face {
                    sides: [side(line - 1, 1.0), side(line, -1.0)],
                    place,
                    length,
                });
            }
        };
        for across in 0..ny {
            for line in 0..=nx {
                add(0, line, across);
            }
        }
        for line in 0..=ny {
            for across in 0..nx {
                add(1, line, across);
            }
        }

        let flow = FlowFactor::new(flow, gas.mean_free_path_m * gas.pressure_pa);
        let clearance = ClearanceMap::new(&surface);
        let usual = usual_attitude(&clearance, slider.length_m);
        let kappa = |cell: usize, place: &Place| {
            let h = place.height(&usual) + cells[cell].recess;
            flow.conductance(gas.pressure_pa * h).0 * h * h
        };
        for (i, &x) in xs.iter().enumerate().take(nx).skip(1) {
            for (j, &y) in ys.iter().enumerate().take(ny).skip(1) {
                // Counter-clockwise from the cell left below, as the faces between them.
                let around = [
                    index(i - 1, j - 1),
                    index(i, j - 1),
                    index(i, j),
                    index(i - 1, j),
                ];
                let depth = around.map(|c| cells[c].recess);
                if depth.iter().all(|d| (d - depth[0]).abs() < SAME_RECESS_M) {
                    continue;
                }
                let place = Place::new(&surface, x, y);
                let widths = Widths {
                    left: lines[0].width(i - 1),
                    right: lines[0].width(i),
                    below: lines[1].width(j - 1),
                    above: lines[1].width(j),
                };
                let factors = conductance_factors(around.map(|c| kappa(c, &place)), &widths);
                let x_face = |j: usize| j * (nx - 1) + (i - 1);
                let y_face = |i: usize| ny * (nx - 1) + (j - 1) * nx + i;
                let meeting = [x_face(j - 1), y_face(i), x_face(j), y_face(i - 1)];
                for (face, factor) in meeting.into_iter().zip(factors) {
                    for side in &mut faces[face].sides {
                        side.inverse_distance *= factor;
                    }
                }
            }
        }

        Ok(Self {
            capacity: cells
                .iter()
                .map(|c| 12.0 * gas.viscosity_pa_s * c.area)
                .collect(),
            half_bandwidth: nx.max(2),
            cells,
            faces,
            edge_faces,
            lines,
            flow,
            floor: Floor { h0: floor_m },
            ambient_pa: gas.pressure_pa,
            clearance,
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
        j * self.lines[0].n_cells() + i
    }

    /// 12 μ A of every cell, Pa s m2; what multiplies dψ/dt.
    pub fn capacity(&self) -> &[f64] {
        &self.capacity
    }

    /// Ambient pressure, Pa.
    pub fn ambient_pa(&self) -> f64 {
        self.ambient_pa
    }

    /// Attitude of a slider in ordinary flight, the first guess of steady states and what the grid
    /// is laid out for.
    pub fn usual_attitude(&self) -> Attitude {
        usual_attitude(&self.clearance, self.extent_m()[0])
    }

    /// Length and width of the slider, m.
    pub fn extent_m(&self) -> [f64; 2] {
        [0, 1].map(|d| {
            let lines = self.lines[d].as_slice();
            lines[lines.len() - 1] - lines[0]
        })
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
            force: [0.0; 3],
            force_by_psi: std::array::from_fn(|_| vec![0.0; n]),
            force_by_attitude: [[0.0; 3]; 3],
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

    #[inline]
    fn column(&self, cell: &Cell, psi: f64, attitude: &Attitude) -> Column {
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
        for ((column, &psi), cell) in scratch.columns.iter_mut().zip(psi).zip(&self.cells) {
            *column = self.column(cell, psi, attitude);
        }
    }

    /// Half cell of `side` and the floor's derivative at its face, whose true height without recess
    /// is `base`.
    #[inline]
    fn half_cell(&self, side: &Side, psi: &[f64], column: &Column, base: f64) -> (HalfCell, f64) {
        let (h_face, slope) = self.floor.apply(base + side.recess);
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
        let column = |c: usize| self.column(&self.cells[c], psi[c], attitude);
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
        for ((force, psi), cell) in out.iter_mut().zip(psi).zip(&self.cells) {
            let p = psi / self.cell_height(cell, attitude).0;
            *force = (p - self.ambient_pa) * cell.area;
        }
        let column = |c: usize| self.column(&self.cells[c], psi[c], attitude);
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
        for (psi, cell) in psi.iter().zip(&self.cells) {
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
    #[inline]
    fn sweep(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        column: impl Fn(usize) -> Column,
        mut take: impl FnMut([Option<usize>; 2], f64, [f64; 2], &Place),
    ) {
        for face in &self.faces {
            let base = face.place.height(attitude);
            let half: [HalfCell; 2] = std::array::from_fn(|s| {
                let side = &face.sides[s];
                self.half_cell(side, psi, &column(side.cell), base).0
            });
            let [left, right] = [half[0].flux(), half[1].flux()];
            let p = (left.alpha + right.alpha) / (left.beta + right.beta);
            let loads = [
                face.sides[0].area * half[0].mean_excess(&left, p),
                face.sides[1].area * half[1].mean_excess(&right, p),
            ];
            take(
                face.sides.map(|side| Some(side.cell)),
                face.length * (left.alpha - left.beta * p),
                loads,
                &face.place,
            );
        }
        for face in &self.edge_faces {
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

    /// Error densities e_x of the strips between lines along x, and e_y: see [`layout`].
    pub(super) fn strip_errors(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        adjoint: &[f64],
    ) -> [Vec<f64>; 2] {
        let [nx, ny] = [self.lines[0].n_cells(), self.lines[1].n_cells()];
        let columns: Vec<Column> = (0..self.n_cells())
            .map(|c| self.column(&self.cells[c], psi[c], attitude))
            .collect();
        // Sum over both faces of a direction of face minus centre, of pressure and of adjoint.
        let mut bends = vec![[[0.0; 2]; 2]; self.n_cells()];
        for (k, face) in self.faces.iter().enumerate() {
            let d = usize::from(k >= (nx - 1) * ny);
            let base = face.place.height(attitude);
            let half: [HalfCell; 2] = std::array::from_fn(|s| {
                let side = &face.sides[s];
                self.half_cell(side, psi, &columns[side.cell], base).0
            });
            let [a, b] = [half[0].flux(), half[1].flux()];
            let p = (a.alpha + b.alpha) / (a.beta + b.beta);
            let weight = half.map(|h| h.g * h.h_centre * h.h_face * h.inverse_distance);
            let [l, r] = face.sides.map(|side| side.cell);
            let z = (weight[0] * adjoint[l] + weight[1] * adjoint[r]) / (weight[0] + weight[1]);
            for cell in [l, r] {
                bends[cell][d][0] += p - psi[cell] / columns[cell].h;
                bends[cell][d][1] += z - adjoint[cell];
            }
        }
        // Edge faces come in the order of their direction: both ends of every row, of every column.
        for (k, face) in self.edge_faces.iter().enumerate() {
            let (d, cell) = (usize::from(k >= 2 * ny), face.side.cell);
            bends[cell][d][0] += self.ambient_pa - psi[cell] / columns[cell].h;
            bends[cell][d][1] -= adjoint[cell];
        }
        let mut errors = [vec![0.0; nx], vec![0.0; ny]];
        for (c, (bend, column)) in bends.iter().zip(&columns).enumerate() {
            let at = [c % nx, c / nx];
            for d in 0..2 {
                let width = self.lines[d].width(at[d]);
                let across = self.lines[1 - d].width(at[1 - d]);
                let kappa = column.g * column.h * column.h;
                let product = bend[d][0] * bend[d][1];
                errors[d][at[d]] += across * kappa * product.abs() * (2.0 / width).powi(4);
            }
        }
        errors
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
        let column = |c: usize| self.column(&self.cells[c], psi[c], attitude);
        self.sweep_derivatives(psi, attitude, column, |face| {
            face.add_force_gradients(by_psi, by_attitude);
        });
    }

    /// Hands flux and load of every face with their derivatives to `take`.
    #[inline]
    fn sweep_derivatives(
        &self,
        psi: &[f64],
        attitude: &Attitude,
        column: impl Fn(usize) -> Column,
        mut take: impl FnMut(&FaceDerivatives),
    ) {
        for face in &self.faces {
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

        for face in &self.edge_faces {
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
    #[inline]
    fn add_by_attitude(
        &self,
        side: &Side,
        face_arms: &[f64; 3],
        slopes: [f64; 2],
        by: &Partials,
        out: &mut [f64; 3],
    ) {
        let centre_arms = self.cells[side.cell].place.arms();
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
