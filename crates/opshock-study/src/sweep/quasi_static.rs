//! Answers of [`Discretisation::QuasiStaticFilm`](opshock_solver::scene::discretisation::Discretisation::QuasiStaticFilm): smallest
//! clearance of a shock on another film grid, quasi-static at a fixed attitude.
//!
//! An uncertainty interval requests this of survivors that were just run: their lowest attitudes are kept. A shock
//! whose attitude is no longer kept is run again, with the same answer.

use opshock_solver::air_bearing::Attitude;
use opshock_solver::scene::discretisation::{Discretisation, Levels};
use opshock_solver::simulation::quasi_static::{Other, quasi_static_clearance};
use opshock_solver::simulation::{Model, Outcome, Verdict as SolverVerdict};

use super::probed::not_built;
use crate::search::{ProbeResult, RunCost, Verdict};

/// Attitude and time at which a survivor came closest to the disk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lowest {
    attitude: Attitude,
    time_s: f64,
}

impl Lowest {
    /// That of a survivor; `None` of other runs.
    pub(super) fn of(outcome: &Outcome) -> Option<Lowest> {
        let survives = outcome.verdict == Some(SolverVerdict::Survives);
        let (attitude, time_s) = outcome.lowest.zip(outcome.t_min_clearance_s)?;
        survives.then_some(Lowest { attitude, time_s })
    }
}

/// The smallest clearance that a survivor on `model` would have on a film `steps` finer (1: extrapolated) or coarser
/// (-1: half the cells), quasi-static at its lowest attitude. The cost is that of this film.
pub(super) fn quasi_static(model: &Model, lowest: Lowest, steps: i8) -> ProbeResult {
    let scene = model.scene();
    let Some(bearing) = model.bearing() else {
        unreachable!("what came closest to the disk has a film")
    };
    let other = match steps {
        1.. => Other::Continued,
        _ => {
            let coarser = Levels::NONE.changed(Discretisation::FilmGrid, steps);
            Other::Cells(scene.at_levels(coarser).film_resolution.cells)
        }
    };
    match quasi_static_clearance(scene, bearing, &lowest.attitude, other) {
        Err(error) => not_built(&error),
        Ok(held) => ProbeResult {
            verdict: Verdict::Survives,
            h_min_m: Some(held.min_clearance_m),
            t_min_s: Some(lowest.time_s),
            cost: RunCost {
                // The film and its three derivatives by the attitude.
                film_solves: 4 * held.n_iterations as u64,
                factorisations: held.n_iterations as u64,
                film_unknowns: held.n_cells as u64,
                ..RunCost::default()
            },
        },
    }
}
