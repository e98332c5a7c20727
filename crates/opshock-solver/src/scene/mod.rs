//! A scene: everything one simulation needs, in SI, as plain data.

mod default_drive;
mod description;
pub mod discretisation;
mod mirror;
mod output;
pub mod plan;
pub mod preset;
mod refine;

pub use crate::head::{Coupling, HeadResolution};
pub use crate::structure::{ContactMethod, Window};
pub use description::Scene;
