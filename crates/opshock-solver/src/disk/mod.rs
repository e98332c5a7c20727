//! Models the rotating flexible annular disk, clamped inside to the base or to a hub, free outside.
#![doc = include_str!("theory.md")]

pub mod basis;
mod error;
pub mod harmonic;
pub mod hub;
pub mod membrane;
mod motion;
mod parameters;
pub mod run_out;

pub use basis::{DiskBasis, DiskMode, DiskModes, Harmonics, MOST_ELEMENTS};
pub use error::DiskError;
pub use hub::HubParameters;
pub use membrane::MembraneStress;
pub use motion::{DiskMotion, DiskPose};
pub use parameters::{DiskDamping, DiskParameters, DiskResolution};
pub use run_out::{SurfaceMotion, Track, Wave};
