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
//! F and F' are forces and moments of films in equilibrium under a held slider. With every cell cut in two the
//! error of second order is a quarter of what it was, so that the film without error is a third of the
//! difference further (Roache 1994, J. Fluids Eng. 116, 405): h + 4/3 (h' - h).

use super::model::BuildError;
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

/// Smallest clearance at the attitude `lowest` over the disk on `film`, the film of `scene`, if the grid were
/// `other`.
///
/// # Errors
///
/// [`BuildError`] when there is no such film, or a film does not settle.
pub fn held_clearance(
    scene: &Scene,
    film: &Film,
    lowest: &Attitude,
    other: Other,
) -> Result<HeldClearance, BuildError> {
    let carried = fixed_attitude(film, lowest)?.force;
    let own_m = film.min_clearance(lowest).value_m;
    let (finer, beyond) = match other {
        Other::Cells(cells) => {
            let mut scene = scene.clone();
            scene.film_resolution.cells = cells;
            (scene.film()?, 1.0)
        }
        Other::Continued => {
            let [x, y] = film.lines_m().map(halved);
            (scene.film_on([&x, &y])?, 4.0 / 3.0)
        }
    };
    let flight = fly_near(&finer, carried, lowest)?;
    Ok(HeldClearance {
        min_clearance_m: own_m + beyond * (flight.min_clearance_m - own_m),
        n_cells: finer.n_cells(),
        n_iterations: flight.n_iterations,
    })
}

/// These lines with one more in the middle between any two.
fn halved(lines_m: &[f64]) -> Vec<f64> {
    let between = lines_m.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]);
    between.chain(lines_m.last().copied()).collect()
}
