//! Time integration of one head: film, slider, gimbal, dimple and suspension under the disk's motion.
//!
//! ```text
//! M dψ/dt + R(ψ, q_rel) = 0                     film, n cells, ψ = p h, storage M
//! M_x ẍ = f a(t) + F(ψ, q_rel) − F₀ − C ẋ − K x − B (N − N₀)    slider and suspension
//! q_rel = q₀ + (z, pitch, roll) − (w_d, pitch_d, roll_d)(t)      attitude over the disk
//! ```
//!
//! The disk's motion enters through the attitude alone, at the time of each stage. Its velocity and acceleration, which
//! jump on impact with a ramp, are not needed: the compression of the film is the conservation of ψ under a changing
//! height.
//!
//! One step is an L-stable ESDIRK step ([`crate::integrator`]). One Newton iteration solves film and structure of a
//! stage together. The film's unknowns are eliminated by a banded factorisation onto the three columns of the slider
//! (`stage`), the suspension's modes onto the few ports where forces act on them (`stage_matrix`). This leaves a dense
//! system of seven mechanical unknowns. Factorisations are kept while the iteration contracts. The alternating
//! iterations of the literature are available as well (`partitioned`).
//!
//! A touch decides a run, and ends it unless the motion after it is requested; with limits of damage, their excess does
//! instead. The slider touches when the smallest
//! height of its true surface over the disk's local plane falls below the limit. The time is found inside the step, on
//! the slider's cubic dense output and the exact motion of the disk.

mod damage;
mod energy;
mod fields;
mod film_passes;
mod first_order_cells;
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
mod slider_contact;
mod stage;
mod stage_matrix;
mod stage_scratch;
mod stops;

pub use damage::DamageLimits;
pub use model::{HeadError, HeadModel, ShockLoad};
pub use outcome::{
    Cause, ContactWork, DimpleRecord, HeadColumns, HeadCost, HeadEnergy, HeadRun, Place,
    PressureFields, SliderContact, SliderEpisode, StopRecord, Verdict,
};
pub use resolution::{Coupling, HeadResolution};
pub use run::{HeadState, HeadWorkspace, Stretch};
