//! Simulates one shock: first disk and ramp (structure), then slider, suspension and film (head).
//!
//! ```text
//! scene, plan -> Model::assemble -> simulate(amplitude) -> structure run -> head run -> Outcome
//! ```
//!
//! The film's force on the disk is neglected compared with the disk's inertia (the paper's section 3). The structure
//! therefore runs first, by itself, over the whole window. Its history then drives the head up to the first touch or,
//! when the plan says so, to the end of the window.

mod critical;
mod kept_corrections;
mod mechanism;
mod model;
mod outcome;
mod run;

pub use crate::head::HeadState;
pub use critical::{CriticalShock, CriticalShockError, critical_shock};
pub use kept_corrections::{KeptCorrections, is_correction_kept, keep_corrections};
pub use mechanism::{FailureEvidence, Mechanism};
pub use model::{Bearing, BuildError, Model, Scope};
pub use outcome::*;
pub use run::{
    Going, Request, Workspace, run_structure, simulate, simulate_head, simulate_head_on,
};
