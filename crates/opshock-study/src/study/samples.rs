//! Reads a sampled pulse: two columns, time in ms and relative acceleration.

use std::sync::Arc;

use super::fault::StudyError;
use super::fields;
use super::source::{Origin, Place, Source};

/// A sampled pulse as read.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Times, ms.
    pub time_ms: Vec<f64>,
    /// Relative acceleration.
    pub relative: Vec<f64>,
    /// Place of each row.
    pub places: Vec<Place>,
}

/// Reads the two columns. Columns are separated by a comma, a semicolon, a tab or blanks; numbers
/// have a decimal point whatever the locale; `#` begins a comment; one header row is skipped.
///
/// # Errors
/// E153 with the row for everything that is not two finite numbers.
pub fn read(source: &Arc<Source>) -> Result<Samples, Vec<StudyError>> {
    let mut samples = Samples {
        time_ms: Vec::new(),
        relative: Vec::new(),
        places: Vec::new(),
    };
    let mut faults = Vec::new();
    let mut at = 0;
    let mut header_allowed = true;
    for (row, line) in source.text.split('\n').enumerate() {
        let place = Place {
            source: source.clone(),
            span: at..at + line.len(),
            origin: Origin::Included,
        };
        at += line.len() + 1;
        let content = line.split('#').next().unwrap_or("").trim();
        if content.is_empty() {
            continue;
        }
        let fields: Vec<&str> = content
            .split(|letter: char| letter == ',' || letter == ';' || letter.is_whitespace())
            .filter(|field| !field.is_empty())
            .collect();
        let numbers: Vec<f64> = fields
            .iter()
            .filter_map(|field| field.parse().ok())
            .collect();
        let is_header = header_allowed && numbers.is_empty();
        header_allowed = false;
        if is_header {
            continue;
        }
        match numbers.as_slice() {
            [time, relative] if fields.len() == 2 && time.is_finite() && relative.is_finite() => {
                samples.time_ms.push(*time);
                samples.relative.push(*relative);
                samples.places.push(place);
            }
            _ => faults.push(
                StudyError::at(
                    "E153",
                    &place,
                    fields::PULSE_TABLE.path(),
                    format!("row {} is not two finite numbers", row + 1),
                )
                .value(content)
                .allowed("time in ms, relative acceleration")
                .hint("write numbers with a decimal point and two columns"),
            ),
        }
    }
    if faults.is_empty()
        && let Some((row, message)) = self::faults(&samples.time_ms, &samples.relative)
    {
        let whole = Place {
            span: 0..0,
            source: source.clone(),
            origin: Origin::Included,
        };
        let place = samples.places.get(row).unwrap_or(&whole);
        faults.push(
            StudyError::at("E153", place, fields::PULSE_TABLE.path(), message)
                .value(place.text().trim())
                .allowed("2 rows or more, times rising from 0"),
        );
    }
    if faults.is_empty() {
        Ok(samples)
    } else {
        Err(faults)
    }
}

/// What is wrong with the samples as a pulse: row (from 0) and message.
pub fn faults(time_ms: &[f64], relative: &[f64]) -> Option<(usize, String)> {
    if time_ms.len() != relative.len() {
        return Some((
            0,
            format!(
                "{} times but {} accelerations",
                time_ms.len(),
                relative.len()
            ),
        ));
    }
    if time_ms.len() < 2 {
        return Some((
            0,
            format!("{} samples; a pulse needs at least 2", time_ms.len()),
        ));
    }
    if time_ms[0] != 0.0 {
        return Some((
            0,
            format!("sample 1 is at {} ms; the first must be at 0", time_ms[0]),
        ));
    }
    if let Some(row) = (1..time_ms.len()).find(|&row| time_ms[row] <= time_ms[row - 1]) {
        return Some((
            row,
            format!(
                "times must rise: sample {} at {} ms after sample {row} at {} ms",
                row + 1,
                time_ms[row],
                time_ms[row - 1]
            ),
        ));
    }
    if relative.iter().all(|value| *value == 0.0) {
        return Some((0, "every acceleration is zero".to_string()));
    }
    None
}
