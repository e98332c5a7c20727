//! Contact of rough surfaces: one asperity, and a Gaussian distribution of them.

pub mod asperity;
pub mod nominal;
pub mod roughness;
