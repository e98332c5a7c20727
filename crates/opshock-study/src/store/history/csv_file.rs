//! History as one CSV table.

use super::{HistoryFileError, root_columns};
use opshock_solver::simulation::History;
use std::io::Write;
use std::path::Path;

/// Writes the root columns (see the [module](super)) as CSV: a header line with the names, then one
/// line per time of the structure. Numbers carry enough digits to read back the same bits; a value
/// that does not exist, such as the slider's after touch, is empty.
///
/// # Errors
///
/// [`HistoryFileError::Io`]; an existing file is then left as it was.
pub fn write_csv(path: &Path, history: &History, start_s: f64) -> Result<(), HistoryFileError> {
    let columns = root_columns(history, start_s);
    let rows = columns[0].values.len();
    let mut text = String::with_capacity(rows * columns.len() * 20);
    let names: Vec<_> = columns.iter().map(|column| column.name).collect();
    text.push_str(&names.join(","));
    text.push('\n');
    for row in 0..rows {
        for (index, column) in columns.iter().enumerate() {
            if index > 0 {
                text.push(',');
            }
            let value = column.values[row];
            if value.is_finite() {
                text.push_str(&format!("{value:e}"));
            }
        }
        text.push('\n');
    }
    replace(path, text.as_bytes()).map_err(|source| HistoryFileError::Io {
        path: path.display().to_string(),
        source,
    })
}

/// Writes aside in the same folder, then renames: a reader never sees half a file.
fn replace(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut aside = super::aside(path)?;
    aside.write_all(bytes)?;
    aside.persist(path).map_err(|error| error.error)?;
    Ok(())
}
