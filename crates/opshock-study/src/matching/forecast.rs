//! Forecast of a match's cost.

use std::time::Instant;

use super::file::MatchProblem;
use super::observation::Stage;
use super::outputs::{self, Printed};
use super::refinement::population_size;
use crate::draws::draw;
use serde::Serialize;

/// Parameter sets that are timed.
const TIMED: u64 = 3;

/// Cost of a stage.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StageCost {
    /// Stage.
    pub stage: &'static str,
    /// Time of a parameter set on one core, s: the mean of three draws of the prior.
    pub seconds_each: f64,
    /// Parameter sets: draws of the prior and measurements of the numerical uncertainty; then also every set of every
    /// wave and of the refinement, if none of them is ruled out before.
    pub sets: [u64; 2],
    /// Core-hours of both.
    pub core_h: [f64; 2],
    /// Parameter sets of the searches for one conflicting group of observations, in addition for each such group.
    pub sets_a_conflict: u64,
}

/// Times a few parameter sets of every stage in use.
pub fn forecast(problem: &MatchProblem, printed: &dyn Printed) -> Vec<StageCost> {
    let effort = &problem.effort;
    let cost = |stage: Stage| {
        let began = Instant::now();
        let timed = TIMED.min(problem.draws(stage));
        for index in 0..timed {
            let unit = draw(problem.seed, index, problem.parameters.len());
            if let Ok(study) = problem.study_of(stage, &unit) {
                outputs::numbers(problem, printed, &study, stage, false);
            }
        }
        let seconds_each = began.elapsed().as_secs_f64() / timed as f64;
        let probes = match stage {
            Stage::CriticalShocks => 0,
            _ => 2 * effort.probes,
        };
        let least = problem.draws(stage) + probes;
        let promoted = match effort.refinement {
            0 => 0,
            _ => u64::from(effort.starts) * population_size(problem) as u64,
        };
        let waves = (u64::from(effort.waves) + 1) * effort.samples;
        let most = least + waves + promoted + effort.refinement;
        let sets = [least, most];
        StageCost {
            stage: stage.words(),
            seconds_each,
            sets,
            sets_a_conflict: effort.conflict_searches
                * (effort.conflict_evaluations + population_size(problem) as u64),
            core_h: sets.map(|count| count as f64 * seconds_each / 3600.0),
        }
    };
    problem.stages().map(cost).collect()
}
