//! Linear algebra for matrices that grow with a mesh; the only module that uses the matrix library by name.

pub mod band;
pub mod banded;
pub mod dense;
pub mod diagonals;
mod entry;
pub mod general;
pub mod lowest;
pub mod pivoted;
mod triangles;

pub use band::SymmetricBand;
pub use dense::{DenseError, EigenPairs, SquareMatrix};
