//! Physics against references, invariants and relations.
