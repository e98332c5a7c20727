//! One simulation: structure, then head; criterion, outcome, histories, energy book.

pub mod outcome;

pub use outcome::*;
