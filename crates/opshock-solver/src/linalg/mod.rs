//! linalg

pub mod banded;
