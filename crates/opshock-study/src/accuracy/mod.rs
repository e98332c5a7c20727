//! What accuracy costs: ladders on every knob, errors against a finer reference, and their price.
//!
//! At each point one *probing shock*, a tenth below the critical one, gives flying height, smallest
//! clearance, contact impulse, displacements and first touch; the critical shock itself is bracketed
//! to 0.2 %. Errors are relative to the reference of the same ladder, ten times finer on that knob
//! alone; that of the clearance is relative to the reference's flying height. Cost is wall time of the probing shock
//! (median and quartiles, the settings in turn, so that a drifting machine meets all alike) and a
//! count free of noise: film solves times film unknowns.

mod ladder;
mod measure;
mod outcome;

pub use ladder::{BRACKET, Setting, formal_order, ladders, order_quantity};
pub use measure::{Bench, Measured};
pub use outcome::{Accuracy, LadderOrder, PointLadders, QUANTITIES, RungRow};
