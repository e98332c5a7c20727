//! Named scenes, small enough for milliseconds, that the hard cases are run on.

pub mod bodies;
pub mod drive;
pub mod films;
pub mod heads;
pub mod noted;
pub mod structures;
pub mod suspensions;
