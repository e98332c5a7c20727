//! Measured parts: a CSV file whose columns are keys of the study and whose rows are parts. A drive takes one row whole,
//! so that what is measured together stays together.

use std::path::Path;

use crate::study::{SetArg, StudyError, text_file};

/// Rows of measured values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parts {
    /// Keys of the study, a column each.
    pub(super) keys: Vec<String>,
    /// Values, a row for each part.
    pub(super) rows: Vec<Vec<f64>>,
}

impl Parts {
    /// Reads a file: a line of keys, then a line of numbers for each part; lines that begin with `#` are skipped.
    pub(super) fn read(path: &Path) -> Result<Parts, Box<StudyError>> {
        let text = text_file::read_text(path)?;
        let file = path.display().to_string();
        let fault = |line: usize, message: String, value: &str| {
            let mut fault = StudyError::in_file("E195", &file, message).value(value);
            fault.line = line;
            fault
        };
        let lines = text.lines().enumerate();
        let mut lines = lines
            .map(|(place, line)| (place + 1, line.trim()))
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let (place, header) = lines.next().unwrap_or((1, ""));
        let keys: Vec<String> = header.split(',').map(|key| key.trim().to_owned()).collect();
        for (column, key) in keys.iter().enumerate() {
            let is_key =
                SetArg::unset(key).is_ok() && key.contains('.') && key.parse::<f64>().is_err();
            if !is_key || keys[..column].contains(key) {
                let fault = fault(place, "is no column of its own".to_owned(), key);
                return Err(Box::new(fault.allowed(
                    "a first line of keys of the study, each once, as ramp.clearance_um,suspension.gram_load_gf",
                )));
            }
        }
        let mut rows = Vec::new();
        for (place, line) in lines {
            let cells = line.split(',').map(|cell| cell.trim().parse().ok());
            let row: Option<Vec<f64>> = cells
                .map(|cell| cell.filter(|x: &f64| x.is_finite()))
                .collect();
            match row.filter(|row| row.len() == keys.len()) {
                Some(row) => rows.push(row),
                None => {
                    let fault = fault(place, "is no row of parts".to_owned(), line);
                    return Err(Box::new(fault.allowed(format!(
                        "{} finite numbers, separated by commas",
                        keys.len()
                    ))));
                }
            }
        }
        if rows.len() < 2 {
            let fault = fault(0, format!("holds {} measured parts", rows.len()), "");
            return Err(Box::new(fault.allowed("two or more")));
        }
        Ok(Parts { keys, rows })
    }

    /// Settings of the part at a cumulative probability.
    pub(super) fn settings(&self, probability: f64) -> impl Iterator<Item = (&str, f64)> {
        let place = (probability * self.rows.len() as f64) as usize;
        let row = &self.rows[place.min(self.rows.len() - 1)];
        self.keys
            .iter()
            .map(String::as_str)
            .zip(row.iter().copied())
    }
}
