//! Memory that simulations need, and whether a machine has it.

use super::{Study, StudyError};

/// Bytes that a worker keeps besides the film: disk modes, histories, program.
const BASE_BYTES: f64 = 60e6;

/// Bytes of the film's matrices and banded factors for n cells, at their peak while the steady flight
/// is found. Measured peaks at 5145, 20 370 and 50 464 cells, less the 17 MB of a process with 16
/// cells: 56, 427 and 1531 MB, which are 153, 147 and 135 bytes times n^1.5, as of bands √n wide.
pub fn film_bytes(cells: f64) -> f64 {
    150.0 * cells.powf(1.5)
}

/// Bytes that one worker needs for the finest film of a study: that of its points with their cells doubled `film_steps`
/// times, or the one that corrects their grids, which has every cell of the reference cut in four.
pub fn worker_bytes(study: &Study, film_steps: u32) -> f64 {
    let cells = study.points.iter().map(|point| {
        let film = &point.scene.film_resolution;
        (film.cells << film_steps).max(4 * film.reference_cells)
    });
    BASE_BYTES + film_bytes(cells.max().unwrap_or(0) as f64)
}

/// Checks that `workers` workers of `worker_bytes` each fit into `available_bytes`.
///
/// # Errors
/// E186 with the estimate and a number of workers that fits.
pub fn check_memory(
    workers: usize,
    worker_bytes: f64,
    available_bytes: f64,
) -> Result<(), Box<StudyError>> {
    let fitting = (available_bytes / worker_bytes).floor();
    if workers as f64 <= fitting {
        return Ok(());
    }
    let hint = if fitting >= 1.0 {
        format!("-j {fitting} fits")
    } else {
        "not even one fits: take fewer film_cells, or a machine with more memory".to_string()
    };
    let message = format!(
        "the sweep needs more memory than there is: about {} in each of {workers} workers",
        gigabytes(worker_bytes)
    );
    Err(Box::new(
        StudyError::in_file("E186", "-j", message)
            .value(gigabytes(worker_bytes * workers as f64))
            .allowed(format!("at most {}", gigabytes(available_bytes)))
            .hint(hint),
    ))
}

fn gigabytes(bytes: f64) -> String {
    format!("{:.2} GB", bytes / 1e9)
}
