//! Estimates the memory of an air-bearing film from its number of cells, fitted to measured peaks.

/// Bytes of a film's matrices and banded factors over n^1.5 (n cells, bands √n wide): 54 and 45 at 5000 and 20 000.
const FLIGHT: f64 = 50.0;
/// The same of a quasi-static film at a fixed attitude, factors in single precision: 27 and 33 at 40 000 and 16 000.
const HELD: f64 = 30.0;

/// Bytes of a film of n cells while a shock is run.
pub fn film_bytes(cells: f64) -> f64 {
    FLIGHT * cells.powf(1.5)
}

/// Bytes while a grid of n cells, and the same with every cell cut in four, give the discretisation defect.
pub fn reference_bytes(cells: f64) -> f64 {
    HELD * (4.0 * cells).powf(1.5)
}
