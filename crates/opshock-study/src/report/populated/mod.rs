//! What a population of drives answers, as text, CSV, JSON, figures, studies and a page.

pub(super) mod figure;
mod files;
pub(super) mod words;

pub use files::{file_of_a_population, json, markdown, populated_files, text};
pub use words::Populated;
