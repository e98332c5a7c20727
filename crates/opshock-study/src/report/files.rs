//! Makes the files of a report.

use super::html::{ReportSource, html};
use super::{chart::ChartError, critical_shock::critical_shock_figure, table};

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
