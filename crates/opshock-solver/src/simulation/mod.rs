//! One simulation: structure, then head; criterion, outcome, histories, energy book.
//!
//! ```text
//! scene, plan -> Model::assemble -> simulate(amplitude) -> structure run -> head run -> Outcome
//! ```
//!
//! The film's force on the disk is neglected beside the disk's inertia (the paper's section 3), so
//! the structure runs first, by itself, over the whole window; its history then drives the head, up to
//! its first touch or, when the plan says so, to the end of the window too.

mod critical;
pub mod held;
mod model;
mod outcome;
mod run;

pub use crate::head::HeadState;
pub use critical::{CriticalShock, CriticalShockError, critical_shock};
pub use model::{Bearing, BuildError, Model, Scope};
pub use outcome::*;
pub use run::{
    Going, Request, Workspace, run_structure, simulate, simulate_head, simulate_head_on,
};
