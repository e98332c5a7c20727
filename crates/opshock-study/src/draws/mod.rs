//! Distributions of a study's keys: their files, independent draws of them, and shares of these draws.

mod parameter;
mod reading;
mod share;

pub use parameter::{Distribution, Parameter, ParameterValue, draw, filling, numbers};
pub(crate) use reading::read;
pub use share::Share;
