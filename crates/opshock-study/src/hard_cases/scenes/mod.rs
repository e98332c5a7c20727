//! Named scenes, small enough for milliseconds, that the hard cases are run on.

pub mod bodies;
pub mod films;
pub mod heads;
pub mod structures;
pub mod suspensions;
