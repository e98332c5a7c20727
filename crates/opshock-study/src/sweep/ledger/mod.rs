//! The searches of a study with every simulation finished so far: answers what the searches ask
//! from what is known, and reads table and runs from them.

mod bars;
mod jobs;
mod results;
mod searches;
mod stage;

pub(super) use jobs::Job;
pub(super) use searches::{Ledger, Told};
