//! Converts an outcome of the simulation to the result of a probe.

use crate::search::{ProbeResult, RunCost, UndecidedCause, Verdict};
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{BuildError, Cause, Outcome, Verdict as SolverVerdict};

/// A scene that could not be built has no verdict.
pub(super) fn not_built(error: &BuildError) -> ProbeResult {
    ProbeResult {
        verdict: Verdict::Undecided {
            cause: UndecidedCause::NotBuilt,
            message: error.to_string(),
        },
        h_min_m: None,
        t_min_s: None,
        cost: RunCost::default(),
    }
}

/// An outcome of `scene` as the search sees it.
pub(super) fn probe_result(scene: &Scene, outcome: &Outcome) -> ProbeResult {
    let verdict = match &outcome.verdict {
        // Of disk and ramp alone nothing fails.
        None | Some(SolverVerdict::Survives) => Verdict::Survives,
        Some(SolverVerdict::Fails { t_fail_s, place }) => Verdict::Fails {
            t_fail_s: *t_fail_s,
            x_m: place.x_m,
            y_m: place.y_m,
        },
        Some(SolverVerdict::Undecided { cause }) => Verdict::Undecided {
            cause: match cause {
                Cause::NotConverged { .. } => UndecidedCause::NotConverged,
                Cause::StepLimit { .. } => UndecidedCause::StepLimit,
                Cause::NotFinite { .. } => UndecidedCause::NotFinite,
            },
            message: cause.to_string(),
        },
    };
    let cost = &outcome.cost;
    ProbeResult {
        verdict,
        // Up to damage it is no measure of the distance from it.
        h_min_m: outcome.min_clearance_m.filter(|_| scene.damage.is_none()),
        t_min_s: outcome.t_min_clearance_s,
        cost: RunCost {
            steps: cost.steps,
            rejected: cost.rejected,
            film_solves: cost.film_solves,
            factorisations: cost.factorisations,
            structure_steps: cost.structure_steps,
            film_unknowns: cost.film_unknowns,
        },
    }
}
