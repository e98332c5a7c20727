//! Input of an uncertainty interval, the runs it requests and their answers.

use crate::search::amplitude_grid::AmplitudeGrid;
use crate::search::evidence::AmplitudeVerdict;
use crate::search::probe::Retry;
use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::contributions::Uncertainty;

/// Steps of the interval's amplitude grid per step of the search.
pub const SUBDIVISIONS: i32 = 16;

/// A survivor that the search has found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Grid point of the interval's amplitude grid.
    pub index: i32,
    /// Smallest clearance above that called failure, m.
    pub h_min_m: f64,
    /// Its time, s.
    pub t_min_s: f64,
}

/// A bracket with the runs around it.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertaintyInput {
    /// Refinement levels of this scene; every other change is made from here.
    pub base: Levels,
    /// Amplitude grid of the interval: [`SUBDIVISIONS`] steps for each of the search.
    pub grid: AmplitudeGrid,
    /// Highest survivor, a point of that amplitude grid.
    pub survivor: i32,
    /// Lowest failure.
    pub failure: i32,
    /// Time of touch of the lowest failure, s.
    pub t_fail_s: Option<f64>,
    /// Survivors of the search with their clearances.
    pub survivors: Vec<Known>,
    /// Discretisation parameters that can change the answer.
    pub discretisations: Vec<Discretisation>,
    /// Times the film's cells may be halved; 0 where there is no film.
    pub film_halvings: i8,
    /// Times the study's elements of the ramp's solid may be halved; 0 where there are none.
    pub mesh_halvings: i8,
    /// The ramp's contact has no stiffness: each impact excites every disk mode.
    pub hard_contact: bool,
    /// The clearance called failure is below twice the minimum film height.
    pub below_continuum: bool,
    /// Target uncertainty, a share.
    pub target: f64,
}

/// A run that the interval requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ask {
    /// Refinement levels.
    pub levels: Levels,
    /// Grid point of the interval's amplitude grid.
    pub index: i32,
    /// How the run is made: the scene itself, refined or not, is retried as the search retries.
    pub retry: Retry,
}

/// The answer of such a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Verdict.
    pub verdict: AmplitudeVerdict,
    /// Smallest clearance above that called failure, m.
    pub h_min_m: Option<f64>,
    /// Its time, s.
    pub t_min_s: Option<f64>,
}

impl Seen {
    /// The run failed.
    pub fn fails(&self) -> bool {
        self.verdict == AmplitudeVerdict::Fails
    }
}

/// How far an interval has got.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress<T = Uncertainty> {
    /// This run is needed next.
    Wants(Ask),
    /// All is known.
    Done(T),
}
