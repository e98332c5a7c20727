//! Error and cost of every discretisation parameter: refinement studies against a finer reference.
//!
//! At each point one *probing shock*, a tenth below the critical one, gives flying height, smallest clearance, contact
//! impulse, displacements and first touch; the critical shock itself is bracketed to 0.2 %. Errors are relative to the
//! reference of the same refinement study, ten times finer in that discretisation parameter alone; that of the
//! clearance is relative to the reference's flying height. Cost is wall time of the probing shock (median and
//! quartiles, the settings in turn, so that drift of the machine affects all alike) and a number without noise: film
//! solves times film unknowns.

mod measure;
mod outcome;
mod refinement;

pub use measure::{Bench, Measured};
pub use outcome::{Accuracy, ObservedOrder, PointStudies, QUANTITIES, SettingRow};
pub use refinement::{BRACKET, Setting, formal_order, order_quantity, refinement_settings};
