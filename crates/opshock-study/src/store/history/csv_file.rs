//! Writes a history as one CSV table.

use super::columns::root_columns;
use crate::store::aside;
use crate::store::error::StoreError;
use opshock_solver::simulation::{History, PressureFields};
use std::path::{Path, PathBuf};

/// Table of pressure fields beside a CSV history: `run.csv` has `run-fields.csv`.
pub fn fields_path(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-fields.csv"))
}

/// Writes the root columns (see the [module](super)) as CSV: a header line with the names, then one
/// line per time of the structure. Numbers carry enough digits to read back the same bits; a value
/// that does not exist, such as the slider's after touch, is empty. Pressure fields, when there are
/// some, go into a second table ([`fields_path`]), a line per time and cell.
///
/// # Errors
///
/// E183; an existing file is then left as it was.
pub fn write_csv(path: &Path, history: &History, start_s: f64) -> Result<(), StoreError> {
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
    aside::write(path, text.as_bytes())?;
    match &history.fields {
        Some(fields) => {
            let table = fields_table(fields, start_s);
            aside::write(&fields_path(path), table.as_bytes())
        }
        None => Ok(()),
    }
}

/// A line per time and cell, x running fastest.
fn fields_table(fields: &PressureFields, start_s: f64) -> String {
    let middles =
        |lines: &[f64]| -> Vec<f64> { lines.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect() };
    let (x, y) = (middles(&fields.x_lines_m), middles(&fields.y_lines_m));
    let mut text = String::from("time_s,x_m,y_m,pressure_pa,gap_m\n");
    let mut cell = 0;
    for time_s in &fields.time_s {
        for y_m in &y {
            for x_m in &x {
                let (p, h) = (fields.pressure_pa[cell], fields.gap_m[cell]);
                text += &format!("{:e},{x_m:e},{y_m:e},{p:e},{h:e}\n", time_s + start_s);
                cell += 1;
            }
        }
    }
    text
}
