//! Cells of the film that run empty in the course of a run, and are of first order from then on.
//!
//! No gas leaves an empty cell in the exact equation. Two parts of the film's balance that make it accurate do not know
//! that. The storage shared between cells takes gas from a cell according to the rates of its neighbours. The straight line
//! that continues ψ to a face takes gas from it where the film thins towards the face faster than the wind carries gas there
//! (Pe < 0 in the fluxes). Where slider and disk close or part within microseconds, as under a corner, such a cell would be
//! emptied below zero within picoseconds, however short the steps. Without both parts at its faces the balance is that of
//! a first-order upwind scheme, in which nothing takes gas from an empty cell. M and R change then; mass is conserved
//! before and after.

use crate::air_bearing::{Attitude, Film};
use std::sync::Arc;

/// The cells, rising, and the film with them; none in most runs.
#[derive(Clone, Debug, Default)]
pub(super) struct FirstOrderCells {
    cells: Vec<usize>,
    film: Option<Arc<Film>>,
}

impl FirstOrderCells {
    /// `cells` of `film`, rising.
    pub fn new(film: &Film, cells: &[usize]) -> Self {
        let flattened = (!cells.is_empty()).then(|| film.of_first_order_at(cells));
        Self {
            cells: cells.to_vec(),
            film: flattened.map(Arc::new),
        }
    }

    /// The cells, rising.
    pub fn cells(&self) -> &[usize] {
        &self.cells
    }

    /// The film whose fluxes and storage hold now; `film` is that of the model.
    pub fn film<'a>(&'a self, film: &'a Film) -> &'a Film {
        self.film.as_deref().unwrap_or(film)
    }

    /// Adds the cells that are empty at `psi`; whether there are new ones.
    pub fn add_empty(&mut self, film: &Film, psi: &[f64], attitude: &Attitude) -> bool {
        let is_old = |cell: &usize| self.cells.binary_search(cell).is_ok();
        let empty = film.empty_cells(psi, attitude);
        let mut cells: Vec<usize> = empty.filter(|cell| !is_old(cell)).collect();
        if cells.is_empty() {
            return false;
        }
        cells.extend(&self.cells);
        cells.sort_unstable();
        *self = Self::new(film, &cells);
        true
    }
}
