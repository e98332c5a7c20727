#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod assembly;
pub mod element;
pub mod material;
pub mod mesh;
pub mod modes;
pub mod ramp;
pub mod reduction;
pub mod sparse;
