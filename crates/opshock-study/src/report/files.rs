//! The files of a report in one folder.

use super::html::{ReportSource, html};
use super::{chart::ChartError, critical_shock::critical_shock_figure, table};
use std::path::{Path, PathBuf};

/// A file of a report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The operating system refused.
    #[error("cannot write {path}")]
    Io {
        /// File or folder.
        path: String,
        /// Reason.
        #[source]
        source: std::io::Error,
    },
    /// The figure could not be encoded.
    #[error("cannot draw the critical-shock figure")]
    Chart(#[from] ChartError),
}

/// Writes `table.md`, `table.csv`, `fig13.svg`, `fig13.png` and `report.html` into `folder`, which
/// is made when it is missing; existing ones are overwritten. Returns the written files.
///
/// # Errors
///
/// [`ReportError`] at the first file that cannot be made.
pub fn write_report(folder: &Path, source: &ReportSource<'_>) -> Result<Vec<PathBuf>, ReportError> {
    let io = |path: &Path, source| ReportError::Io {
        path: path.display().to_string(),
        source,
    };
    std::fs::create_dir_all(folder).map_err(|source| io(folder, source))?;
    let figure = critical_shock_figure(source.summary, source.program);
    let files = [
        (
            "table.md",
            table::markdown(source.summary, &source.provenance()).into_bytes(),
        ),
        ("table.csv", table::csv(source.summary).into_bytes()),
        ("fig13.svg", figure.svg().into_bytes()),
        ("fig13.png", figure.png()?),
        ("report.html", html(source).into_bytes()),
    ];
    let mut written = Vec::new();
    for (name, bytes) in files {
        let path = folder.join(name);
        std::fs::write(&path, bytes).map_err(|source| io(&path, source))?;
        written.push(path);
    }
    Ok(written)
}
