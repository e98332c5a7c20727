//! Shock excitation of the base: pulses along the axis with motions in proportion to them, and modes of the base.

mod base;
mod pulse;

pub use base::{BaseMode, BaseMotion};
pub use pulse::{ObliqueShock, Pulse, PulseError, PulseShape, Stretch};
