//! Answers of [`Knob::HeldFilm`](opshock_solver::scene::knob::Knob::HeldFilm): the shock as it is, its smallest
//! clearance on another film held still.
//!
//! A bar asks this of survivors that were just run: their lowest attitudes are kept. Whether one is at hand or
//! the shock is run again does not reach the answer.

use opshock_solver::air_bearing::Attitude;
use opshock_solver::scene::knob::{Knob, Levels};
use opshock_solver::simulation::held::{Other, held_clearance};
use opshock_solver::simulation::{Model, Outcome, Verdict as SolverVerdict};

use super::probed::not_built;
use crate::search::{ProbeResult, RunCost, Verdict};

/// Where a survivor came closest to the disk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lowest {
    attitude: Attitude,
    time_s: f64,
}

impl Lowest {
    /// That of a survivor; `None` of other runs.
    pub(super) fn of(outcome: &Outcome) -> Option<Lowest> {
        let survives = matches!(outcome.verdict, SolverVerdict::Survives);
        let (attitude, time_s) = outcome.lowest.zip(outcome.t_min_clearance_s)?;
        survives.then_some(Lowest { attitude, time_s })
    }
}

/// The smallest clearance that a survivor on `model` would have on a film `steps` finer (1: continued) or
/// coarser (-1: half the cells), held still where it came closest. The cost is that of the held film.
pub(super) fn held_still(model: &Model, lowest: Lowest, steps: i8) -> ProbeResult {
    let scene = model.scene();
    let Some(bearing) = model.bearing() else {
        unreachable!("what came closest to the disk has a film")
    };
    let other = match steps {
        1.. => Other::Continued,
        _ => {
            let coarser = Levels::NONE.turned(Knob::FilmGrid, steps);
            Other::Cells(scene.at_levels(coarser).film_resolution.cells)
        }
    };
    match held_clearance(scene, bearing, &lowest.attitude, other) {
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
