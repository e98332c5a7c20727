//! Air bearing: compressible Reynolds equation with rarefaction under one slider.

mod attitude;
mod balance;
mod build;
mod carrying;
mod corner;
mod correction_forces;
mod defect;
mod derivatives;
mod exponential;
mod faces;
mod film;
mod first_order;
mod flow_factor;
mod flux;
mod gap_force;
pub mod gap_forces;
mod gap_load;
mod heights;
pub mod impedance;
mod layout;
mod linearise;
mod mesh;
mod newton;
mod sampled_range;
mod search;
mod state;
pub mod steady;
mod steady_error;
mod storage;
mod thickness;

#[cfg(test)]
mod tests;

pub use attitude::Attitude;
pub use build::{FilmError, FilmResolution};
pub use correction_forces::CorrectionForces;
pub use film::{CellStates, Element, Film};
pub use flow_factor::{FlowFactor, FlowModel};
pub use gap_force::GapForce;
pub use gap_forces::{GapForces, SurfaceForces};
pub use gap_load::GapLoad;
pub use linearise::FilmLinearisation;
pub use state::FilmScratch;
pub use thickness::is_limited;
