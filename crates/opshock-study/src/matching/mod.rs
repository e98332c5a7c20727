//! Matching: finds parameters of a study with which a set of observations holds.
//!
//! Observations come in three stages of cost: disk and ramp (milliseconds), single shocks with the head, critical
//! shocks. The first wave draws parameter sets independently from the prior; shares of the prior and their bounds rest
//! on these draws alone. Later waves explore what is left, and a refinement maximises the smallest margin (`search`). A
//! set is ruled out where an observation's implausibility reaches 3 (`observation`): history matching (Craig,
//! Goldstein, Seheult and Smith 1997, in *Case Studies in Bayesian Statistics III*; Vernon, Goldstein and Bower 2010,
//! Bayesian Analysis 5, 619) without an emulator, as the model itself is fast.
//!
//! Every number of a parameter set is kept in the store by its content (`evaluations`). The search is a function of the
//! match file and these numbers alone, so that an interrupted run continues when it is run again.

mod answer;
mod conflicts;
mod contradiction;
mod emulator;
mod evaluations;
mod file;
mod forecast;
mod measured;
mod observation;
mod observed;
mod outputs;
mod refinement;
mod sample;
mod search;
mod searched;
mod statements;

pub use answer::{BestOfEach, MatchAnswer, MatchingSet, Narrowing, ObservationRow, ParameterRow};
pub use conflicts::Conflict;
pub use evaluations::Evaluations;
pub use file::{Effort, MatchProblem, is_match_file};
pub use forecast::{StageCost, forecast};
pub use observation::{
    Combination, Known, Measure, Observation, Quantity, RULED_OUT, Scalar, ShockChoice, Stage,
};
pub use outputs::Printed;
pub use sample::Sample;
pub use search::search;
pub use searched::{Ended, Searched, WaveReport};
pub use statements::Statements;
