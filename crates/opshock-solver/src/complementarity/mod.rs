//! Advances linear systems with unilateral contact, 0 ≤ λ ⟂ g ≥ 0, by impulses at velocity level.
//!
//! A unilateral contact has a signed gap g (g > 0 open) and a multiplier λ ≥ 0 that pushes the
//! bodies apart; 0 ≤ g complementary to λ ≥ 0. It never pulls.
#![doc = include_str!("theory.md")]

pub mod advance;
pub mod lcp;
pub mod moreau_jean;

pub use advance::{
    ContactMemory, Gap, ImpactLaw, ImpulseKind, Refund, StepReport, UnilateralSystem, advance,
};
