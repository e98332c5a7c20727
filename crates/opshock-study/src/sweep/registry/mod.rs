//! Registry of a sweep: the searches of a study with every simulation finished so far. It answers their requests from
//! known runs, and reads table and runs from them.

mod interval_order;
mod jobs;
mod results;
mod rounds;
mod searches;
mod stage;
mod uncertainties;

pub(super) use jobs::Job;
pub(super) use rounds::next_round;
pub(super) use searches::{AnsweredProbe, Registry};
pub(super) use stage::{Depth, seen, uncertainty_asked, uncertainty_probe};
pub(super) use uncertainties::interval_input;
