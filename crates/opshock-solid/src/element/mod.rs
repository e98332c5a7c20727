//! Quadratic solid elements: 20-node hexahedra and 10-node tetrahedra.
//!
//! Both have complete quadratic displacements on straight-edged shapes and are integrated fully, so that they neither
//! lock in bending nor have spurious modes of zero energy.
//!
//! ```text
//! K(ai,bj) = ∫ λ ∂iNa ∂jNb + μ ∂jNa ∂iNb + μ δij ∇Na·∇Nb dV
//! M(ai,bj) = δij ∫ ρ Na Nb dV
//! ```
//!
//! Source: Zienkiewicz and Taylor, *The Finite Element Method* (2000), volume 1, chapters 8 and 9.

mod hexahedron;
mod integrals;
mod quadrature;
mod shape;
mod tetrahedron;

pub(crate) use hexahedron::NODES as HEXAHEDRON_NODES;
pub use integrals::{ElementMatrices, FoldedElement};
pub(crate) use integrals::{face_integrals, matrices};
pub use quadrature::{MAX_FACE_NODES, MAX_NODES};
pub use shape::Shape;

#[cfg(test)]
mod tests;
