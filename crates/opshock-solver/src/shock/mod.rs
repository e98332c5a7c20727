//! How the base is shaken: pulses along the axis and what goes in step with them, modes of the base.

mod base;
mod pulse;

pub use base::{BaseMode, BaseMotion};
pub use pulse::{ObliqueShock, Pulse, PulseError, PulseShape, Stretch};
