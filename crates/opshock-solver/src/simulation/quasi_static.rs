//! Estimates a shock's smallest clearance on another grid from quasi-static films at a fixed attitude.
//!
//! Under quasi-static compression the slider is nearly in equilibrium. The force of its film at the fixed lowest
//! attitude q is then the force that the film of any grid has to carry. On another grid it does so at another attitude
//! q', and the smallest clearances differ by the effect of the grids on the shock:
//!
//! ```text
//! F'(q') = F(q),   h' - h = h(q') - h(q)
//! ```
//!
//! F and F' are forces and moments of quasi-static films at fixed attitudes. With every cell of a grid cut in two the
//! error of second order falls to a quarter, so that the limit of infinitely many cells is a third of the difference
//! further (Roache 1994, J. Fluids Eng. 116, 405): h'' + (h'' - h')/3 for clearances h' on the grid and h'' on the cut
//! one. That grid is the film's own. For a film with defect correction ([`crate::air_bearing::CorrectionForces`]) it has
//! twice the cells of the defect-correction grid, so that a grid without part in the correction measures the remaining
//! error.

use super::model::{Bearing, BuildError};
use crate::air_bearing::steady::{fixed_attitude, fly_near};
use crate::air_bearing::{Attitude, Film};
use crate::scene::Scene;

/// The film that the quasi-static film is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// The layout with this number of cells.
    Cells(usize),
    /// Every cell cut in two along both directions, extrapolated to infinitely many cells.
    Continued,
}

/// Smallest clearance on another film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuasiStaticClearance {
    /// Smallest clearance there, m; negative where that film would not carry the slider above the disk.
    pub min_clearance_m: f64,
    /// Cells of the other film.
    pub n_cells: usize,
    /// Number of linearisations on it.
    pub n_iterations: usize,
}

/// Estimate of a shock's smallest clearance with the film of `scene` on the grid `other`; `lowest` is the attitude over
/// the disk at which the shock has its smallest clearance with the film of `bearing`.
///
/// # Errors
///
/// [`BuildError`] when there is no such film, or a film does not settle.
pub fn quasi_static_clearance(
    scene: &Scene,
    bearing: &Bearing,
    lowest: &Attitude,
    other: Other,
) -> Result<QuasiStaticClearance, BuildError> {
    let film = &*bearing.film;
    let carried = fixed_attitude(film, lowest)?.force;
    let on = |film: &Film| -> Result<QuasiStaticClearance, BuildError> {
        let flight = fly_near(film, carried, lowest)?;
        Ok(QuasiStaticClearance {
            min_clearance_m: flight.min_clearance_m,
            n_cells: film.n_cells(),
            n_iterations: flight.n_iterations,
        })
    };
    let cut = |film: &Film| on(&scene.film_cut_in_two(film)?);
    let (held, coarse_m) = match (other, &bearing.reference) {
        (Other::Cells(cells), _) => {
            let other = Bearing::build(&scene.with_film_cells(cells), Some(bearing))?;
            return on(&other.film);
        }
        (Other::Continued, None) => (cut(film)?, film.min_clearance(lowest).value_m),
        (Other::Continued, Some(_)) => {
            let cells = 2 * scene.film_resolution.correction_cells;
            let apart = scene.with_film_cells(cells).film()?;
            (cut(&apart)?, on(&apart)?.min_clearance_m)
        }
    };
    let fine_m = held.min_clearance_m;
    Ok(QuasiStaticClearance {
        min_clearance_m: fine_m + (fine_m - coarse_m) / 3.0,
        ..held
    })
}
