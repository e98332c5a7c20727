//! What another grid of the film would change where a slider came closest, read from films held still.
//!
//! A slider that is squeezed slowly follows its load nearly in equilibrium. What its film carries, held still at
//! the lowest attitude q, is what any film has to carry then; on another grid it does so at another attitude q',
//! and the smallest clearances differ by what the grids do to the shock:
//!
//! ```text
//! F'(q') = F(q),   h' - h = h(q') - h(q)
//! ```
//!
//! F and F' are forces and moments of films in equilibrium under a held slider. With every cell of a grid cut in
//! two the error of second order is a quarter of what it was, so that the film without error is a third of the
//! difference further (Roache 1994, J. Fluids Eng. 116, 405): h'' + (h'' - h')/3 of clearances h' on the grid and
//! h'' on the cut one. That grid is the film's own; of a film that is corrected already
//! ([`crate::air_bearing::ReferenceForces`]) it is one of twice the reference's cells, so that what is left of
//! the error is told by a grid that had no part in the correction.

use super::model::{Bearing, BuildError};
use crate::air_bearing::steady::{fixed_attitude, fly_near};
use crate::air_bearing::{Attitude, Film};
use crate::scene::Scene;

/// A film that a held one is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// The layout of so many cells.
    Cells(usize),
    /// Every cell cut in two along both directions, continued to infinitely many.
    Continued,
}

/// Clearance that another film leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldClearance {
    /// What the smallest clearance would be, m; negative where that film would not carry the slider above the
    /// disk.
    pub min_clearance_m: f64,
    /// Cells of the other film.
    pub n_cells: usize,
    /// Linearisations made on it.
    pub n_iterations: usize,
}

/// Smallest clearance at the attitude `lowest` over the disk on the film of `bearing`, which is that of `scene`,
/// if the grid were `other`.
///
/// # Errors
///
/// [`BuildError`] when there is no such film, or a film does not settle.
pub fn held_clearance(
    scene: &Scene,
    bearing: &Bearing,
    lowest: &Attitude,
    other: Other,
) -> Result<HeldClearance, BuildError> {
    let film = &*bearing.film;
    let carried = fixed_attitude(film, lowest)?.force;
    let on = |film: &Film| -> Result<HeldClearance, BuildError> {
        let flight = fly_near(film, carried, lowest)?;
        Ok(HeldClearance {
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
            let cells = 2 * scene.film_resolution.reference_cells;
            let apart = scene.with_film_cells(cells).film()?;
            (cut(&apart)?, on(&apart)?.min_clearance_m)
        }
    };
    let fine_m = held.min_clearance_m;
    Ok(HeldClearance {
        min_clearance_m: fine_m + (fine_m - coarse_m) / 3.0,
        ..held
    })
}
