//! Statements that are built into the program: who reads a match file hands in theirs.

use std::fmt::Debug;

use super::observation::Observation;
use crate::store::summary::Summary;
use crate::study::Study;
use opshock_solver::scene::knob::Levels;
use opshock_solver::scene::plan::Plan;
use opshock_solver::simulation::Model;

/// A set of statements whose numbers a match may ask for.
pub trait Statements: Debug + Sync {
    /// What a match file calls all of them.
    fn name(&self) -> &'static str;

    /// Each as an observation of its name, with [`super::Quantity::Statement`].
    fn observations(&self) -> Vec<Observation>;

    /// Numbers of statements about single shocks, in the order of `ids`; nothing when the study has no answer to one of
    /// these shocks. Parts of `models` are shared, and those made are added to them.
    fn of_shocks(
        &self,
        ids: &[&str],
        study: &Study,
        plan: &Plan,
        levels: Levels,
        models: &mut Vec<Model>,
    ) -> Vec<Option<f64>>;

    /// Number of a statement about critical shocks.
    fn of_critical_shocks(&self, id: &str, summary: &Summary) -> Option<f64>;
}
