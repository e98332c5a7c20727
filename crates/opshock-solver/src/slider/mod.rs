//! Slider: rigid body and air-bearing surface (rails, recess, crown, camber, twist).

pub mod body;
pub mod clearance;
pub mod surface;

mod parameters;
mod pieces;

pub use parameters::{Rail, RailOutline, SliderParameters, SurfaceParameters};
