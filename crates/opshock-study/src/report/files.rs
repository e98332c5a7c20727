//! Makes the files of a report.

use super::chart::ChartError;
use super::html::{ReportSource, html};
use super::table;

/// `table.md`, `table.csv`, `critical_shock.svg`, `critical_shock.png` and `report.html`: names and bytes.
///
/// # Errors
///
/// A figure that cannot be encoded.
pub fn report_files(source: &ReportSource<'_>) -> Result<Vec<(&'static str, Vec<u8>)>, ChartError> {
    let figure = source.figure(source.program);
    Ok(vec![
        (
            "table.md",
            table::markdown(source.summary, &source.answer(), &source.provenance()).into_bytes(),
        ),
        ("table.csv", table::csv(source.summary).into_bytes()),
        ("critical_shock.svg", figure.svg().into_bytes()),
        ("critical_shock.png", figure.png()?),
        ("report.html", html(source).into_bytes()),
    ])
}
