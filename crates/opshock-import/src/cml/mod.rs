//! Text files of the CMLAir family: air-bearing surfaces ([`rail`]), static runs ([`run`]) and dynamic
//! ones ([`dynamic`]).
//!
//! All values are SI. Versions other than 7.0 and 8.0 are refused by name: their layouts differ.
//! [`study`] writes what they say as a study file and a surface file; [`drive`] adds what a dynamic run says
//! of pulse, disk and ramp.

pub mod drive;
pub mod dynamic;
pub mod rail;
mod reader;
pub mod run;
pub mod study;

pub use reader::VERSIONS;

#[cfg(test)]
mod tests;
