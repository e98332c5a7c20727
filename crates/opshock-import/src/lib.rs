//! Readers of other programs' files: mass and stiffness matrices (Matrix Market, CalculiX, dense
//! text), the text files of the CMLAir family, Gmsh meshes of solids.
//!
//! Readers take text and give plain numbers in SI units, or every fault they found with its place.
//! They know no study and no solver. What a file can declare never decides how much memory is
//! taken: only what it holds does.

#![forbid(unsafe_code)]

pub mod cml;
pub mod fault;
pub mod gmsh;
pub mod matrix;
pub mod text;

pub use fault::{Fault, Faults};
