//! Imports mass, stiffness and gyroscopic matrices of other programs.
//!
//! ```text
//! M x″ + G x′ + K x = f
//! ```
//!
//! [`market`], [`calculix`] and [`dense`] read them, [`system`] combines them in SI units, [`check`] checks that they
//! can be those of a structure. Rows and columns start at 0 here and at 1 in files and messages.

pub mod calculix;
pub mod check;
pub mod dense;
pub mod dof;
pub(crate) mod entries;
pub mod envelope;
pub mod files;
pub mod market;
pub mod modes;
pub(crate) mod sparse;
pub mod system;
pub mod units;

pub use entries::MAX_ROWS;
pub use sparse::{Entry, Matrix};

#[cfg(test)]
mod tests;
