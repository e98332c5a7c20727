//! Physics against references, invariants and relations.

mod suspension;
