#![doc = include_str!("../README.md")]
//!
//! # From data to an answer
//!
//! A [`scene::Scene`] (plain SI data) is built once into an immutable [`simulation::Model`];
//! [`simulation::simulate`] runs one shock of a signed amplitude through it and returns an
//! [`simulation::Outcome`]; [`simulation::critical_shock`] finds the amplitude at which the verdict changes.
//!
//! Conventions used everywhere (design reference, section 2):
//!
//! * SI units, `f64`; displacements are relative to the drive's base; z points from the disk
//!   towards the slider.
//! * Signed amplitude A: the inertia load per mass felt in the base frame is a(t) = A s(t) along
//!   +z. A > 0 moves the disk towards the slider first.
//! * Time 0 of the solver is the **onset of the pulse**; the study's axis adds `start_ms`.
//! * Slider axes: x from leading to trailing edge (the way the disk moves at zero skew), y across
//!   from the inner edge. Film height h = h_c - pitch (x - x_c) + roll (y - y_c) + recess + crown.
//! * Contact: gap g >= 0 open, multiplier lambda >= 0 pushes apart, 0 <= g complementary to lambda.
#![forbid(unsafe_code)]

pub mod air_bearing;
pub mod disk;
pub mod gas;
pub mod head;
pub mod quantity;
pub mod ramp;
pub mod rough_contact;
pub mod scene;
pub mod shock;
pub mod simulation;
pub mod slider;
pub mod structure;
pub mod suspension;

pub use scene::Scene;
pub use simulation::{Model, Outcome, Request, Verdict, Workspace, critical_shock, simulate};

mod elementary;
mod grid;

// Numerical methods. Other crates of this workspace check them; they are no part of the interface.
#[doc(hidden)]
pub mod complementarity;
#[doc(hidden)]
pub mod fixed_point;
#[doc(hidden)]
pub mod integrator;
#[doc(hidden)]
pub mod lanes;
#[doc(hidden)]
pub mod linalg;
#[doc(hidden)]
pub mod modal;
#[doc(hidden)]
pub mod mutant;
