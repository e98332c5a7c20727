//! Reads the samples of a pulse: a column of time and one of acceleration, with the units that a header names.

use std::sync::Arc;

use super::fault::StudyError;
use super::fields;
use super::source::{Origin, Place, Source};

/// Where the columns are.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Positions of time and acceleration in a row, from 0.
    pub columns: [usize; 2],
    /// Whether a row may have more columns.
    pub may_have_more: bool,
    /// Rows at the beginning that are not read.
    pub skip_rows: usize,
}

/// A sampled pulse as read, in the file's units.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Times.
    pub time: Vec<f64>,
    /// Accelerations.
    pub acceleration: Vec<f64>,
    /// Place of each row.
    pub places: Vec<Place>,
    /// Words above the two columns, row by row of the header.
    pub header: Vec<[String; 2]>,
}

/// Reads the two columns. Columns are separated by a semicolon, a tab, a comma or blanks, whichever of these, in this
/// order, a row has; numbers have a decimal point whatever the locale; `#` begins a comment; rows without a number
/// before the first sample are the header.
///
/// # Errors
/// E153 with the row for everything that is not two finite numbers.
pub fn read(source: &Arc<Source>, layout: &Layout) -> Result<Samples, Vec<StudyError>> {
    let mut samples = Samples {
        time: Vec::new(),
        acceleration: Vec::new(),
        places: Vec::new(),
        header: Vec::new(),
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
        if content.is_empty() || row < layout.skip_rows {
            continue;
        }
        let words = words(content);
        let columns = layout
            .columns
            .map(|column| words.get(column).copied().unwrap_or(""));
        if header_allowed && words.iter().all(|word| word.parse::<f64>().is_err()) {
            samples.header.push(columns.map(str::to_owned));
            continue;
        }
        header_allowed = false;
        let is_wide = words.len() > 2 && !layout.may_have_more;
        match columns.map(str::parse::<f64>) {
            [Ok(time), Ok(value)] if !is_wide && time.is_finite() && value.is_finite() => {
                samples.time.push(time);
                samples.acceleration.push(value);
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
                .allowed("time, acceleration; others with pulse.table_columns")
                .hint("write numbers with a decimal point; # begins a comment, pulse.table_skip_rows skips"),
            ),
        }
    }
    if faults.is_empty()
        && let Some((row, message)) = disorder(&samples.time)
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
                .allowed("2 rows or more, times rising"),
        );
    }
    if faults.is_empty() {
        Ok(samples)
    } else {
        Err(faults)
    }
}

/// The words of a row.
fn words(content: &str) -> Vec<&str> {
    match [';', '\t', ',']
        .into_iter()
        .find(|mark| content.contains(*mark))
    {
        Some(mark) => {
            let content = content.trim_end_matches([mark, ' ']);
            content.split(mark).map(str::trim).collect()
        }
        None => content.split_whitespace().collect(),
    }
}

/// The unit that the heading of a column names in brackets, behind a stroke, or as its last word; empty when none.
pub fn unit_of(heading: &str) -> &str {
    let heading = heading.trim_matches(|letter: char| letter == '"' || letter.is_whitespace());
    for (open, close) in [('(', ')'), ('[', ']')] {
        if let Some((_, rest)) = heading.rsplit_once(open)
            && let Some((unit, _)) = rest.split_once(close)
        {
            return unit.trim();
        }
    }
    for suffix in ["m/s2", "m/s^2", "m/s²", "m_per_s2"] {
        if heading.to_lowercase().ends_with(suffix) {
            return &heading[heading.len() - suffix.len()..];
        }
    }
    let is_mark = |letter: char| matches!(letter, '/' | '_' | ' ' | ',' | ':');
    heading.rsplit(is_mark).next().unwrap_or("").trim()
}

/// The first sample that is out of order, from 0, and what is wrong with it.
fn disorder(time: &[f64]) -> Option<(usize, String)> {
    if time.len() < 2 {
        return Some((
            0,
            format!("{} samples; a pulse needs at least 2", time.len()),
        ));
    }
    let row = (1..time.len()).find(|&row| time[row] <= time[row - 1])?;
    let message = format!(
        "times must rise: sample {} at {} after sample {row} at {}",
        row + 1,
        time[row],
        time[row - 1]
    );
    Some((row, message))
}

/// What is wrong with samples as a pulse: row (from 0) and message.
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
    if let Some(disorder) = disorder(time_ms) {
        return Some(disorder);
    }
    if time_ms[0] != 0.0 {
        return Some((
            0,
            format!("sample 1 is at {} ms; the first must be at 0", time_ms[0]),
        ));
    }
    if relative.iter().all(|value| *value == 0.0) {
        return Some((0, "every acceleration is zero".to_string()));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str, layout: Layout) -> Result<Samples, Vec<StudyError>> {
        read(&Source::new("pulse.csv", text), &layout)
    }

    const TWO: Layout = Layout {
        columns: [0, 1],
        may_have_more: false,
        skip_rows: 0,
    };

    #[test]
    fn columns_are_found_in_what_recorders_write() {
        let two = read_text("time,shock\n[s],[g]\n0,1\n1e-5,2 # noise\n", TWO).unwrap();
        assert_eq!(two.time, [0.0, 1e-5]);
        assert_eq!(two.acceleration, [1.0, 2.0]);
        assert_eq!(two.header[1], ["[s]", "[g]"]);
        let wide = Layout {
            columns: [1, 3],
            may_have_more: true,
            skip_rows: 2,
        };
        let text = "Rate;100000\nChannels;3\nNo;Time (ms);X;Z (m/s2)\n1;0.0;;5.5;\n2;0.01;7;6.5;\n";
        let wide = read_text(text, wide).unwrap();
        assert_eq!(wide.time, [0.0, 0.01]);
        assert_eq!(wide.acceleration, [5.5, 6.5]);
        assert_eq!(wide.header, [["Time (ms)", "Z (m/s2)"]]);
    }

    /// A decimal comma makes columns of its own, or no number; either is refused.
    #[test]
    fn decimal_commas_are_no_columns() {
        let more = Layout {
            may_have_more: true,
            ..TWO
        };
        assert!(read_text("0,0;0,5\n0,1;0,6\n", more).is_err());
        assert!(read_text("0,0 0,5\n0,1 0,6\n", TWO).is_err());
    }

    #[test]
    fn units_are_found_in_headings() {
        for (heading, unit) in [
            ("Time (s)", "s"),
            ("\"t [ms]\"", "ms"),
            ("t/us", "us"),
            ("time_ms", "ms"),
            ("a_m_per_s2", "m_per_s2"),
            ("Acceleration m/s^2", "m/s^2"),
            ("relative", "relative"),
            ("", ""),
        ] {
            assert_eq!(unit_of(heading), unit, "{heading}");
        }
    }
}
