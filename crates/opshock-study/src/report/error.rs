//! The error of a file of a report that cannot be made; values as JSON.

use super::chart::ChartError;
use crate::store::StoreError;

/// A file of a report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The operating system refused.
    #[error(transparent)]
    Write(#[from] StoreError),
    /// A figure could not be encoded.
    #[error("cannot draw a figure")]
    Chart(#[from] ChartError),
}

/// A value as the bytes of a JSON file.
pub fn json(value: &impl serde::Serialize) -> Vec<u8> {
    let text = serde_json::to_string_pretty(value).expect("a report serialises");
    (text + "\n").into_bytes()
}
