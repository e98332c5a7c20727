//! Reads and writes text files of the CMLAir family: air-bearing surfaces ([`rail`]), static runs ([`run`]) and dynamic
//! ones ([`dynamic`]).
//!
//! All values are SI. Versions other than 7.0 and 8.0 are rejected by name, because their layouts differ. [`study`]
//! converts the files into a study file and a surface file; [`drive`] adds pulse, disk and ramp of a dynamic run.

pub mod deck;
pub mod drive;
pub mod dynamic;
pub mod rail;
mod reader;
pub mod run;
pub mod study;

pub use reader::VERSIONS;

#[cfg(test)]
mod tests;
