//! Film, slider, gimbal, dimple and suspension integrated together under the disk's motion.
//!
//! ```text
//! 12 μ A dψ/dt + R(ψ, q_rel) = 0                    film, n cells, ψ = p h
//! M ẍ = f a(t) + F(ψ, q_rel) − F₀ − C ẋ − K x − B (N − N₀)      slider and suspension
//! q_rel = q₀ + (z, pitch, roll) − (w_d, pitch_d, roll_d)(t)      attitude over the disk
//! ```
//!
//! The disk's motion enters through the attitude alone, at the time of each stage. Its velocity
//! and acceleration, which jump when it meets a ramp, are nowhere needed: squeeze is the
//! conservation of ψ under a changing height.
//!
//! One step is an L-stable ESDIRK step ([`crate::integrator`]). Its stages are solved together by
//! one Newton iteration: the film's unknowns are eliminated by a banded factorisation onto the
//! three columns of the slider (`stage`), the suspension's modes onto the few places where they are acted
//! on (`stage_matrix`), which leaves a dense system of seven mechanical unknowns. Factorisations are kept while the iteration contracts. The iterations between film
//! and structure that the literature uses are there too (`partitioned`).
//!
//! Touching decides a run, and ends it unless the motion behind it is wanted: the smallest height of the slider's true surface over the disk's local
//! plane falls below the limit, found inside the step on the cubic dense output of the slider and
//! the exact motion of the disk.

mod fields;
mod film_passes;
mod following;
mod mechanics;
mod model;
mod oscillators;
mod outcome;
mod partitioned;
mod ports;
mod resolution;
pub mod response;
mod run;
#[cfg(test)]
mod sample;
mod stage;
mod stage_matrix;
mod stage_scratch;
mod stops;

pub use model::{HeadError, HeadModel, ShockLoad};
pub use outcome::{
    Cause, DimpleRecord, HeadColumns, HeadCost, HeadRun, Place, PressureFields, StopRecord, Verdict,
};
pub use resolution::{Coupling, HeadResolution};
pub use run::{HeadState, HeadWorkspace, Stretch};
