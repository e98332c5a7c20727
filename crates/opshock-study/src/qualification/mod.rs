//! Does a drive meet a specification? Requirements of a specification file become studies that are swept as any other, and
//! their critical shocks with uncertainty intervals become verdicts.
//!
//! A requirement names an amplitude A and a margin m: every point of the study with the requirement's pulses must survive
//! (1 + m) A. The search ends at four times that amplitude. Every point with a bracket above a quarter of it gets its uncertainty
//! interval, and those whose interval holds the amplitude are refined (`search::decisive`).

mod damage_boundary;
mod spec;
mod verdict;

pub use damage_boundary::{BoundaryPoint, Critical, DamageBoundary};
pub use spec::{Requirement, Spec, pulse_shape};
pub use verdict::{Open, PointVerdict, RequirementVerdict, Verdict};
