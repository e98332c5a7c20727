//! Interface to statements, quantities built into the program: the caller that reads a match file supplies them.

use std::fmt::Debug;

use super::observation::Observation;
use crate::store::summary::Summary;
use crate::study::Study;
use opshock_solver::scene::discretisation::Levels;
use opshock_solver::scene::plan::Plan;
use opshock_solver::simulation::Model;

/// A set of statements whose numbers a match may use.
pub trait Statements: Debug + Sync {
    /// Name of the set in a match file.
    fn name(&self) -> &'static str;

    /// Each as an observation of its name, with [`super::Quantity::Statement`].
    fn observations(&self) -> Vec<Observation>;

    /// Numbers of statements about single shocks, in the order of `ids`; nothing when the study has no answer to one of
    /// these shocks. Parts of `models` are shared, and those built are added to them.
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
