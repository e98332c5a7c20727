//! Mass, stiffness and gyroscopic matrices of other programs.
//!
//! ```text
//! M x″ + G x′ + K x = f
//! ```
//!
//! [`market`], [`calculix`] and [`dense`] read them, [`system`] puts them together in SI units,
//! [`check`] says whether they can be a structure's. Rows and columns count from 0 here and from 1
//! in files and messages.

pub mod calculix;
pub mod check;
pub mod dense;
pub mod dof;
mod entries;
pub mod envelope;
pub mod files;
pub mod market;
pub mod modes;
mod sparse;
pub mod system;
pub mod units;

pub use entries::MAX_ROWS;
pub use sparse::{Entry, Matrix};

#[cfg(test)]
mod tests;
