//! What tolerances are worth, as text, CSV, JSON and a page.

mod files;
pub(super) mod words;

pub use files::{json, text, valued_files};
pub use words::Valued;
