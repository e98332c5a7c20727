//! Physics against references, invariants and relations.

mod bodies;
mod contact;
mod free_motion;
mod plate;
mod spinning;
mod suspension;
