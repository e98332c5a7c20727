//! A film whose empty cells are of first order: no straight line continues ψ to a face beside one of them, and no storage is
//! shared through it. The reason stands where a run takes cells to it (`head/first_order_cells.rs`).

use super::attitude::Attitude;
use super::faces::Columns;
use super::film::Film;
use super::storage::storage;

/// Share of the ambient pressure below which a cell counts as empty.
const EMPTY: f64 = 1e-3;

impl Film {
    /// The same film of first order at `cells`, rising: no straight line continues ψ to a face beside one of them, and no
    /// storage is shared through it.
    #[must_use]
    pub fn of_first_order_at(&self, cells: &[usize]) -> Self {
        let mut film = self.clone();
        film.mesh.flatten_at(cells);
        film.columns = Columns::new(&film.mesh);
        film.storage = storage(&film);
        film
    }

    /// Whether a cell of the pressure `pressure_pa` counts as empty.
    pub fn is_empty_at(&self, pressure_pa: f64) -> bool {
        pressure_pa < EMPTY * self.ambient_pa
    }

    /// Cells that count as empty, rising.
    pub fn empty_cells(&self, psi: &[f64], attitude: &Attitude) -> impl Iterator<Item = usize> {
        let cells = self.mesh.cells.iter().zip(psi).enumerate();
        let pressure_pa = |cell, psi: f64| psi / self.cell_height(cell, attitude).0;
        let empty =
            cells.filter(move |(_, (cell, psi))| self.is_empty_at(pressure_pa(cell, **psi)));
        empty.map(|(place, _)| place)
    }
}
