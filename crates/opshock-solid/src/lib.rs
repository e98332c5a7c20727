//! Solid finite elements of a load/unload ramp, reduced to its contact points.
//!
//! Geometry and material give a mesh of quadratic elements ([`element`], [`mesh`]), the mesh its
//! equations of motion ([`assembly`]), these their natural modes ([`modes`]) and a small model of the
//! points that are touched ([`reduction`]). [`ramp`] goes the whole way for a ramp.
//!
//! Like the solver, this crate opens no file, reads no clock or environment, prints nothing and
//! starts no thread; the same input gives the same bits.

#![forbid(unsafe_code)]

pub mod assembly;
pub mod element;
pub mod material;
pub mod mesh;
pub mod modes;
pub mod ramp;
pub mod reduction;
pub mod sparse;
