//! Reads measured histories from CSV files.

use std::path::Path;

use crate::study::{StudyError, text_file};

/// Times and values of a CSV file, a pair per line; lines that begin with `#` and one line of names are skipped.
pub(super) fn measured(path: &Path) -> Result<Vec<(f64, f64)>, Box<StudyError>> {
    let text = text_file::read_text(path)?;
    let file = path.display().to_string();
    let mut rows: Vec<(f64, f64)> = Vec::new();
    let mut is_first = true;
    for (place, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let cells: Vec<Option<f64>> = line
            .split(',')
            .map(|cell| cell.trim().parse().ok())
            .collect();
        let row = match cells[..] {
            [Some(time), Some(value)] if f64::is_finite(time) && f64::is_finite(value) => {
                Some((time, value))
            }
            _ => None,
        };
        let ascends = |row: &(f64, f64)| rows.last().is_none_or(|last| row.0 > last.0);
        match row.filter(ascends) {
            Some(row) => rows.push(row),
            None if is_first && cells.iter().all(Option::is_none) => {}
            None => {
                let mut fault = StudyError::in_file("E193", &file, "is no row of a history")
                    .value(line)
                    .allowed("time_s,value: two finite numbers, times ascending");
                fault.line = place + 1;
                return Err(Box::new(fault));
            }
        }
        is_first = false;
    }
    if rows.len() < 2 {
        let fault = StudyError::in_file(
            "E193",
            &file,
            format!("holds {} rows of a history", rows.len()),
        );
        return Err(Box::new(fault.allowed("two or more")));
    }
    Ok(rows)
}
