//! The files of a report in one folder.

use super::html::{ReportSource, html};
use super::{chart::ChartError, critical_shock::critical_shock_figure, table};
use std::path::{Path, PathBuf};

/// The operating system refused to write a file.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {path}")]
pub struct WriteError {
    /// File or folder.
    path: String,
    /// Reason.
    #[source]
    source: std::io::Error,
}

/// A file of a report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The operating system refused.
    #[error(transparent)]
    Write(#[from] WriteError),
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
    Ok(write_all(folder, files)?)
}

/// Writes files by name into `folder`, which is made when it is missing. Returns the written files.
///
/// # Errors
///
/// At the first one that cannot be written.
pub(super) fn write_all(
    folder: &Path,
    files: impl IntoIterator<Item = (impl AsRef<Path>, Vec<u8>)>,
) -> Result<Vec<PathBuf>, WriteError> {
    let refused = |path: &Path, source| WriteError {
        path: path.display().to_string(),
        source,
    };
    std::fs::create_dir_all(folder).map_err(|source| refused(folder, source))?;
    files
        .into_iter()
        .map(|(name, bytes)| {
            let path = folder.join(name);
            match std::fs::write(&path, bytes) {
                Ok(()) => Ok(path),
                Err(source) => Err(refused(&path, source)),
            }
        })
        .collect()
}

/// A value as the bytes of a JSON file that belongs into `folder`.
///
/// # Errors
///
/// When it cannot be written as JSON.
pub(super) fn json(folder: &Path, value: &impl serde::Serialize) -> Result<Vec<u8>, WriteError> {
    let text = serde_json::to_string_pretty(value).map_err(|error| WriteError {
        path: folder.display().to_string(),
        source: error.into(),
    })?;
    Ok((text + "\n").into_bytes())
}
