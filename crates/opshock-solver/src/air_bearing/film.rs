//! The discrete film: gas, geometry and grid of one slider, built once.
//!
//! ```text
//! M dψ/dt + R(ψ, attitude) = 0,   R = sum of outward face fluxes
//! ```
//!
//! ψ = p h is the mass in a cell's column over R T, so the balance is conservative and squeeze
//! enters through dψ/dt alone. Fluxes are those of [two half cells](super::flux) at every face, at
//! the slider's edges with the ambient pressure on the face; the balance itself is in
//! `balance`, the choice of the grid in [`super::layout`].

use super::defect::{Defect, ReferenceForces};
use super::faces::{BLOCK, Block, Columns, block};
use super::flow_factor::FlowFactor;
use super::flux::HalfCell;
use super::heights::inverses;
use super::layout;
use super::mesh::{Cell, Mesh, Side};
use super::steady::{SteadyError, usual_attitude};
use super::storage::storage;
use super::surface_forces::{Interaction, SurfaceLoad};
use super::thickness::Floor;
use super::{Attitude, FilmResolution, FlowModel};
use crate::gas::GasParameters;
use crate::grid::Lines;
use crate::lanes::{Kernel, widest};
use crate::linalg::banded::BandedLu;
use crate::linalg::diagonals::Diagonals;
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

/// A roll that moves no point of a slider by an atom's thousandth, rad.
const LEAN_RAD: f64 = 1e-11;

/// Film under one slider: immutable once built.
#[derive(Clone, Debug)]
pub struct Film {
    pub(super) mesh: Mesh,
    pub(super) columns: Columns,
    capacity: Vec<f64>,
    storage: Diagonals,
    pub(super) flow: FlowFactor,
    floor: Floor,
    pub(super) ambient_pa: f64,
    clearance: ClearanceMap,
    usual: Attitude,
    /// ψ in the usual attitude, roughly.
    usual_psi: Vec<f64>,
    /// Surface forces beside the film; none unless asked for.
    pub(super) interaction: Option<Interaction>,
    /// What the grid leaves out, put back; none unless asked for.
    pub(super) defect: Option<Defect>,
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
            let start = std::mem::take(&mut built.usual_psi);
            let Some((lines, held)) = layout::refined(built, start, &surface, cells) else {
                return film(lines(resolution.cells)?);
            };
            built = film(lines)?;
            built.usual_psi = held.carried_to(&built);
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
        let speed = spin_rad_per_s * slider.radius_m;
        let wind = [slider.skew_rad.cos(), slider.skew_rad.sin()]
            .map(|part| 6.0 * gas.viscosity_pa_s * speed * part);
        let flow = FlowFactor::new(flow, gas.mean_free_path_m * gas.pressure_pa);
        let clearance = ClearanceMap::new(&surface);
        let usual = usual_attitude(&clearance, slider.length_m, wind[0]);
        let mut mesh = Mesh::new(&surface, lines, wind);
        mesh.correct_corners(&surface, &usual, |h| {
            flow.conductance(gas.pressure_pa * h).0 * h * h
        });
        let per_area = 12.0 * gas.viscosity_pa_s;
        let mut film = Self {
            columns: Columns::new(&mesh),
            capacity: mesh.cells.iter().map(|c| per_area * c.area).collect(),
            storage: Diagonals::zeros(0, Vec::new()),
            mesh,
            flow,
            floor: Floor { h0: floor_m },
            ambient_pa: gas.pressure_pa,
            clearance,
            usual,
            usual_psi: Vec::new(),
            interaction: None,
            defect: None,
        };
        film.usual_psi = film.ambient(&usual);
        film.storage = storage(&film, &film.capacity, &film.usual_psi, per_area);
        Ok(film)
    }

    /// The same film with what its grid leaves out of force and moments put back: [`Film::force`] and the
    /// linearisation hold it from then on, pressures and fluxes do not.
    ///
    /// # Errors
    ///
    /// [`SteadyError`] when the film does not settle under a slider held still.
    pub fn corrected_by(mut self, reference: &ReferenceForces) -> Result<Self, SteadyError> {
        self.defect = None;
        self.defect = Some(reference.defect_of(&self)?);
        Ok(self)
    }

    /// What [`Film::corrected_by`] adds to force and moments at an attitude; `None` of a film as its grid has it.
    pub fn correction(&self, attitude: &Attitude) -> Option<SurfaceLoad> {
        Some(self.defect.as_ref()?.load(attitude))
    }

    /// Number of cells n, the length of every ψ.
    pub fn n_cells(&self) -> usize {
        self.mesh.cells.len()
    }

    /// Grid lines along x and along y, m.
    pub fn lines_m(&self) -> [&[f64]; 2] {
        [self.mesh.lines[0].as_slice(), self.mesh.lines[1].as_slice()]
    }

    /// Index in ψ of the cell between lines `i`, `i + 1` along x and `j`, `j + 1` along y.
    pub fn cell_index(&self, i: usize, j: usize) -> usize {
        self.mesh.index(i, j)
    }

    /// M, Pa s m2: what multiplies dψ/dt (`air_bearing/storage.rs` derives it). Its columns add up to the [`Film::capacity`].
    pub fn storage(&self) -> &Diagonals {
        &self.storage
    }

    /// Turns M dψ/dt into dψ/dt in place.
    ///
    /// # Panics
    ///
    /// When `stored` has not n_cells entries.
    pub fn spread_by_storage(&self, stored: &mut [f64]) {
        let (storage, n) = (&self.storage, self.n_cells());
        let mut lu = BandedLu::<f64>::new(n, storage.band());
        lu.factor(storage, 0.0, &Diagonals::zeros(n, Vec::new()))
            .expect("columns with more on the diagonal than beside it");
        lu.solve(stored);
    }

    /// 12 μ A of every cell, Pa s m2: ψ times it is the gas that the cell holds.
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
        self.usual
    }

    /// Length and width of the slider, m.
    pub fn extent_m(&self) -> [f64; 2] {
        [0, 1].map(|d| {
            let lines = self.mesh.lines[d].as_slice();
            lines[lines.len() - 1] - lines[0]
        })
    }

    /// Height h0 of the film's floor, m.
    pub fn floor_m(&self) -> f64 {
        self.floor.h0
    }

    /// Height the film sees in a cell and its derivative by the true height.
    #[inline]
    pub(super) fn cell_height(&self, cell: &Cell, attitude: &Attitude) -> (f64, f64) {
        self.floor.apply(cell.place.height(attitude) + cell.recess)
    }

    /// Height the film sees where the true height is `h`, and its derivative.
    #[inline(always)]
    pub(super) fn floored(&self, h: f64) -> (f64, f64) {
        self.floor.apply(h)
    }

    /// Heights the film sees in a block where the true ones are `base` + `recess`, and their
    /// derivatives.
    #[inline(always)]
    pub(super) fn floored_block(&self, base: &Block, recess: &Block) -> [Block; 2] {
        self.floor.apply_block(base, recess)
    }

    /// Half cell of `side` where the height is `h_centre` at the centre and `base` at the face,
    /// without recess.
    pub(super) fn half_cell(&self, side: &Side, psi: &[f64], h_centre: f64, base: f64) -> HalfCell {
        let (g, g_slope) = self.flow.conductance(psi[side.cell]);
        let h_face = self.floored(base + side.recess).0;
        HalfCell {
            psi: psi[side.cell],
            inverse_psi: 1.0 / psi[side.cell],
            psi_behind: psi[side.behind],
            reach: side.reach,
            g,
            inverse_g: 1.0 / g,
            g_slope,
            h_centre,
            inverse_h: 1.0 / h_centre,
            h_face,
            inverses: inverses(h_centre, h_face),
            distance: 1.0 / side.inverse_distance,
            inverse_distance: side.inverse_distance,
            wind: side.wind,
        }
    }

    /// ψ of the undisturbed ambient pressure, Pa m.
    ///
    /// # Panics
    ///
    /// When `out` has not n_cells entries.
    pub fn ambient_psi(&self, attitude: &Attitude, out: &mut [f64]) {
        assert_eq!(out.len(), self.n_cells());
        for (psi, cell) in out.iter_mut().zip(&self.mesh.cells) {
            *psi = self.ambient_pa * self.cell_height(cell, attitude).0;
        }
    }

    /// ψ where the pressure is ambient everywhere, Pa m, one for each cell.
    pub(super) fn ambient(&self, attitude: &Attitude) -> Vec<f64> {
        let mut psi = vec![0.0; self.n_cells()];
        self.ambient_psi(attitude, &mut psi);
        psi
    }

    /// ψ from which to seek the film in the usual attitude, Pa m: what the grids before had there,
    /// ambient pressure on a given grid.
    pub(super) fn usual_psi(&self) -> &[f64] {
        &self.usual_psi
    }

    /// Pressure at the cells' centres, Pa.
    ///
    /// # Panics
    ///
    /// When a slice has not n_cells entries.
    pub fn pressure(&self, psi: &[f64], attitude: &Attitude, out: &mut [f64]) {
        assert_eq!(psi.len(), self.n_cells());
        assert_eq!(out.len(), self.n_cells());
        for ((p, psi), cell) in out.iter_mut().zip(psi).zip(&self.mesh.cells) {
            *p = psi / self.cell_height(cell, attitude).0;
        }
    }

    /// Lowest pressure at a cell's centre, Pa; cells without a number do not count.
    ///
    /// # Panics
    ///
    /// When `psi` has not n_cells entries.
    pub fn lowest_pressure_pa(&self, psi: &[f64], attitude: &Attitude) -> f64 {
        assert_eq!(psi.len(), self.n_cells());
        let film = self;
        let lowest = widest(LowestPressure {
            film,
            psi,
            attitude,
        });
        lowest.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Height of the slider's surface over the disk at the cells' centres, m, not floored.
    ///
    /// # Panics
    ///
    /// When `out` has not n_cells entries.
    pub fn heights(&self, attitude: &Attitude, out: &mut [f64]) {
        assert_eq!(out.len(), self.n_cells());
        for (h, cell) in out.iter_mut().zip(&self.mesh.cells) {
            *h = cell.place.height(attitude) + cell.recess;
        }
    }

    /// `attitude` rolled by next to nothing to the side to which wind across the slider rolls it: of two points that mirror
    /// each other it tells the one that comes closer, so that skews of either sign have grids that mirror each other.
    pub(super) fn leaning(&self, attitude: &Attitude) -> Attitude {
        let lean_rad = match self.blows_across() {
            true if self.blows_inwards() => -LEAN_RAD,
            true => LEAN_RAD,
            false => 0.0,
        };
        Attitude {
            roll_rad: attitude.roll_rad + lean_rad,
            ..*attitude
        }
    }

    /// Whether the wind blows across the slider as well.
    pub(super) fn blows_across(&self) -> bool {
        self.columns.interior[1].wind != 0.0
    }

    /// Whether the wind blows across the slider towards its inner side.
    pub(super) fn blows_inwards(&self) -> bool {
        let across = &self.columns.interior[1];
        across.up > across.down
    }

    /// Smallest clearance of the true surface over the disk's plane.
    pub fn min_clearance(&self, attitude: &Attitude) -> Clearance {
        self.clearance.minimum(
            attitude.centre_height_m,
            attitude.pitch_rad,
            attitude.roll_rad,
        )
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

struct LowestPressure<'a> {
    film: &'a Film,
    psi: &'a [f64],
    attitude: &'a Attitude,
}

impl Kernel for LowestPressure<'_> {
    type Output = Block;

    #[inline(always)]
    fn call(self) -> Block {
        let columns = &self.film.columns;
        let mut lowest = [f64::INFINITY; BLOCK];
        for (at, cells) in self.psi.chunks(BLOCK).enumerate() {
            let first = at * BLOCK;
            let base = columns.places.heights(first, self.attitude);
            let [h, _] = self
                .film
                .floored_block(&base, block(&columns.recess, first));
            // What is left of the last block has no gas to be low in.
            let mut psi = [f64::INFINITY; BLOCK];
            psi[..cells.len()].copy_from_slice(cells);
            for k in 0..BLOCK {
                let p = psi[k] / h[k];
                lowest[k] = if p < lowest[k] { p } else { lowest[k] };
            }
        }
        lowest
    }
}
