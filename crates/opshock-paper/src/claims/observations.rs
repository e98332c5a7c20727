//! Gives the paper's statements as observations of a match, which finds parameters that make them true.

use super::catalogue::{CLAIMS, Claim, Source};
use super::finding::of_parts;
use super::shocks::{ShockError, Shocks};
use opshock_solver::scene::discretisation::Levels;
use opshock_solver::scene::plan::Plan;
use opshock_solver::simulation::Model;
use opshock_study::matching::{Observation, Quantity, Stage, Statements};
use opshock_study::store::summary::Summary;
use opshock_study::study::Study;
use std::sync::Arc;

/// The paper's statements, for a match file that asks for them.
#[derive(Clone, Copy, Debug)]
pub struct Paper;

impl Statements for Paper {
    fn name(&self) -> &'static str {
        "paper"
    }

    fn observations(&self) -> Vec<Observation> {
        CLAIMS.iter().map(observation).collect()
    }

    fn of_shocks(
        &self,
        ids: &[&str],
        study: &Study,
        plan: &Plan,
        levels: Levels,
        models: &mut Vec<Model>,
    ) -> Vec<Option<f64>> {
        let mut run = || -> Result<Shocks, ShockError> {
            let tasks = Shocks::planned(study, plan, levels)?;
            let cases = tasks
                .iter()
                .map(|task| task.run_after(models).map(Arc::new));
            Ok(Shocks::of(cases.collect::<Result<_, _>>()?))
        };
        let Ok(shocks) = run() else {
            return Vec::new();
        };
        let number = |id: &&str| match claim(id)?.source {
            Source::DiskAndRamp(number) | Source::Shocks(number) => number(&shocks).0,
            Source::Critical(_) => None,
        };
        ids.iter().map(number).collect()
    }

    fn of_critical_shocks(&self, id: &str, summary: &Summary) -> Option<f64> {
        let claim = claim(id)?;
        match claim.source {
            Source::Critical(parts) => of_parts(claim, parts(summary))?.value,
            _ => None,
        }
    }
}

fn claim(id: &str) -> Option<&'static Claim> {
    CLAIMS.iter().find(|claim| claim.id == id)
}

fn observation(claim: &Claim) -> Observation {
    Observation {
        name: claim.id.to_owned(),
        quantity: Quantity::Statement {
            id: claim.id,
            unit: claim.unit,
        },
        range: Some(match claim.bounds {
            // None of the numbers is negative whose bounds begin at 0.
            (0.0, high) if high > 0.0 => [f64::NEG_INFINITY, high],
            (low, high) => [low, high],
        }),
        observed_u: 0.0,
        weight: 1.0,
        discrepancy_u: 0.0,
        numerical_u: None,
        stage: match claim.source {
            Source::DiskAndRamp(_) => Stage::DiskAndRamp,
            Source::Shocks(_) => Stage::SingleShocks,
            Source::Critical(_) => Stage::CriticalShocks,
        },
        source: format!("the paper, {}: {}", claim.place, claim.words),
    }
}
