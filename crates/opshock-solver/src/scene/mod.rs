//! A scene: everything one simulation needs, in SI, as plain data.

pub mod accuracy;
mod default_drive;
mod description;
pub mod knob;
mod mirror;
mod output;
pub mod plan;
mod refine;

pub use crate::head::{Coupling, HeadResolution};
pub use crate::structure::{ContactMethod, Window};
pub use description::Scene;
