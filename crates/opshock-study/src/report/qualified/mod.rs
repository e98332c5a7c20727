//! Verdicts of a specification as text, CSV, JSON, JUnit XML and a page.

pub(super) mod answer;
mod boundary;
mod files;
mod junit;

pub use answer::{Qualified, Tested};
pub use boundary::Boundary;
pub use files::{csv, json, markdown, optional_file, qualified_files, text};
pub use junit::junit;
