//! Populations of drives: virtual drives with values drawn from tolerances, each against every requirement of a
//! specification, and the share that survives.
//!
//! The number of drives is fixed before any is simulated, and every drive is an independent draw, so that exact binomial
//! intervals hold. A drive whose verdict hangs on the numerical uncertainty counts both ways.

mod answer;
mod correlation;
mod fragility;
mod level;
mod nominal;
mod parts;
mod sensitivity;
mod simulated;
mod tolerances;

pub use answer::{Counts, DriveAnswer, PopulationAnswer, RequirementAnswer, WorstDrive};
pub use fragility::{Fragility, LogNormal, Step};
pub use level::{CONFIRMED, DecidedBy, FARTHEST, Level, LevelAnswer, Levels, amplitude_g, judge};
pub use nominal::Nominal;
pub use sensitivity::{Bins, Sensitivity};
pub use simulated::{Interrupted, Part, Population, STORE};
pub use tolerances::Tolerances;
