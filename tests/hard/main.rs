//! Hard cases and random scenes: what must hold of any scene, and of the ones that break solvers.

mod cases;
mod flights;
mod random_contacts;
mod random_heads;
mod random_structures;
