//! Builds the discrete film: chooses or takes over its grid, then computes everything that does not change in time.

use super::attitude::usual_attitude;
use super::faces::Columns;
use super::film::Film;
use super::flow_factor::{FlowFactor, FlowModel};
use super::layout;
use super::mesh::Mesh;
use super::storage::{per_area, storage};
use super::thickness::HeightLimit;
use crate::gas::GasParameters;
use crate::grid::Lines;
use crate::linalg::diagonals::Diagonals;
use crate::slider::SliderParameters;
use crate::slider::clearance::ClearanceMap;
use crate::slider::surface::Surface;
use thiserror::Error;

/// Numerical resolution of the film.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct FilmResolution {
    /// Wanted number of cells; the grid fits the surface's edges and comes close to it.
    pub cells: usize,
    /// Minimum film height h0, m; from 2 h0 on the film sees the true height.
    pub min_height_m: f64,
    /// Wanted number of cells of the defect-correction grid, whose forces give the discretisation defect of the film's
    /// own grid ([`CorrectionForces`](super::CorrectionForces)); 0: no correction.
    pub correction_cells: usize,
}

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

impl Film {
    /// Discretises the film of `slider` in `gas` over a disk turning at `spin_rad_per_s`.
    ///
    /// The disk's velocity is taken uniform over the slider, Ω r at its centre, turned by the skew.
    ///
    /// # Errors
    ///
    /// [`FilmError`] when a size, a gas property or the minimum film height is not positive, or a rail is not a
    /// polygon.
    pub fn build(
        slider: &SliderParameters,
        gas: &GasParameters,
        flow: FlowModel,
        spin_rad_per_s: f64,
        resolution: &FilmResolution,
    ) -> Result<Self, FilmError> {
        check(slider, gas, resolution.min_height_m)?;
        let surface = Surface::new(slider);
        let film = |lines| {
            Self::on_lines(
                slider,
                gas,
                flow,
                spin_rad_per_s,
                resolution.min_height_m,
                lines,
            )
        };
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
        min_height_m: f64,
        lines_m: [&[f64]; 2],
    ) -> Result<Self, FilmError> {
        check(slider, gas, min_height_m)?;
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
        Self::on_lines(slider, gas, flow, spin_rad_per_s, min_height_m, lines)
    }

    fn on_lines(
        slider: &SliderParameters,
        gas: &GasParameters,
        flow: FlowModel,
        spin_rad_per_s: f64,
        min_height_m: f64,
        lines: [Lines; 2],
    ) -> Result<Self, FilmError> {
        let surface = Surface::new(slider);
        let speed = spin_rad_per_s * slider.radius_m;
        let direction = [slider.skew_rad.cos(), slider.skew_rad.sin()];
        let wind = direction.map(|part| 6.0 * gas.viscosity_pa_s * speed * part);
        let flow = FlowFactor::new(flow, gas.mean_free_path_m * gas.pressure_pa);
        let clearance = ClearanceMap::new(&surface);
        let usual = usual_attitude(&clearance, slider.length_m, wind[0]);
        let mut mesh = Mesh::new(&surface, lines, wind);
        mesh.correct_corners(&surface, &usual, |h| {
            flow.conductance(gas.pressure_pa * h).0 * h * h
        });
        let per_area = per_area(gas);
        let mut film = Self {
            columns: Columns::new(&mesh),
            capacity: mesh.cells.iter().map(|c| per_area * c.area).collect(),
            storage: Diagonals::zeros(0, Vec::new()),
            mesh,
            flow,
            height_limit: HeightLimit::new(min_height_m),
            gas: gas.clone(),
            ambient_pa: gas.pressure_pa,
            disk_velocity_m_per_s: direction.map(|part| speed * part),
            clearance,
            usual,
            usual_psi: Vec::new(),
            gap_forces: Vec::new(),
            defect: None,
        };
        film.usual_psi = film.ambient(&usual);
        film.storage = storage(&film);
        Ok(film)
    }
}

fn check(
    slider: &SliderParameters,
    gas: &GasParameters,
    min_height_m: f64,
) -> Result<(), FilmError> {
    for (quantity, value) in [
        ("slider length", slider.length_m),
        ("slider width", slider.width_m),
        ("ambient pressure", gas.pressure_pa),
        ("viscosity", gas.viscosity_pa_s),
        ("mean free path", gas.mean_free_path_m),
        ("minimum film height", min_height_m),
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
