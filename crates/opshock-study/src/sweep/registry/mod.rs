//! Registry of a sweep: the searches of a study with every simulation finished so far. It answers their requests from
//! known runs, and reads table and runs from them.

mod jobs;
mod results;
mod searches;
mod stage;
mod uncertainties;

pub(super) use jobs::Job;
pub(super) use searches::{AnsweredProbe, Registry};
