//! Named scenes of the hard cases, each simulated within milliseconds.

pub mod bodies;
pub mod drive;
pub mod films;
pub mod heads;
pub mod noted;
pub mod rough;
pub mod structures;
pub mod suspensions;
