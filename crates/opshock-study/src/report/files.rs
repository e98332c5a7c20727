//! The files of a report in one folder.

use super::html::{ReportSource, html};
use super::{chart::ChartError, critical_shock::critical_shock_figure, table};
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

/// `table.md`, `table.csv`, `fig13.svg`, `fig13.png` and `report.html`: names and bytes.
///
/// # Errors
///
/// A figure that cannot be encoded.
pub fn report_files(source: &ReportSource<'_>) -> Result<Vec<(&'static str, Vec<u8>)>, ChartError> {
    let figure = critical_shock_figure(source.summary, source.program);
    Ok(vec![
        (
            "table.md",
            table::markdown(source.summary, &source.provenance()).into_bytes(),
        ),
        ("table.csv", table::csv(source.summary).into_bytes()),
        ("fig13.svg", figure.svg().into_bytes()),
        ("fig13.png", figure.png()?),
        ("report.html", html(source).into_bytes()),
    ])
}

/// A value as the bytes of a JSON file.
pub fn json(value: &impl serde::Serialize) -> Vec<u8> {
    let text = serde_json::to_string_pretty(value).expect("a report serialises");
    (text + "\n").into_bytes()
}
