//! Contact of rough surfaces: one asperity, and a Gaussian distribution of them.

pub mod asperity;
mod loading_table;
pub mod nominal;
pub mod roughness;
