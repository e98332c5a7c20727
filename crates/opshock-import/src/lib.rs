#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod cml;
pub mod fault;
pub mod gmsh;
pub mod matrix;
pub mod text;

pub use fault::{Fault, Faults};
