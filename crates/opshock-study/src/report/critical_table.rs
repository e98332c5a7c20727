//! Reads a `table.csv` of critical shocks back, for a figure without its store.

use super::table::{AFTER_AXES, BEFORE_AXES};
use crate::search::Sign;
use crate::store::summary::{AxisValue, Flag, PointSummary, Status, Summary, Totals};
use std::path::Path;

/// A table of critical shocks cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The operating system refused.
    #[error("cannot read {path}")]
    Io {
        /// File.
        path: String,
        /// Reason.
        #[source]
        source: std::io::Error,
    },
    /// The text is no such table.
    #[error("{path}, line {line}: {key} = {value:?} must be {allowed}")]
    Cell {
        /// File.
        path: String,
        /// Line from 1.
        line: usize,
        /// Column.
        key: String,
        /// Value found.
        value: String,
        /// What would be valid.
        allowed: &'static str,
    },
}

/// Reads the `table.csv` of a report; returns it with the BLAKE3 digest of the file. What the table does not
/// hold (contributions to the intervals, brackets, totals) is empty.
///
/// # Errors
///
/// [`TableError`] with file, line and column.
pub fn read_table(path: &Path) -> Result<(Summary, String), TableError> {
    let text = std::fs::read_to_string(path).map_err(|source| TableError::Io {
        path: path.display().to_string(),
        source,
    })?;
    let digest = blake3::hash(text.as_bytes()).to_hex().to_string();
    Ok((parse(&text, &path.display().to_string())?, digest))
}

fn parse(text: &str, path: &str) -> Result<Summary, TableError> {
    let mut lines = text
        .lines()
        .zip(1..)
        .map(|(line, number)| (cells(line), number));
    let (header, _) = lines.next().unwrap_or_default();
    let axes = header
        .len()
        .checked_sub(BEFORE_AXES.len() + AFTER_AXES.len());
    let known = axes.is_some_and(|axes| {
        header[..BEFORE_AXES.len()] == BEFORE_AXES
            && header[BEFORE_AXES.len() + axes..] == AFTER_AXES
    });
    let (Some(axes), true) = (axes, known) else {
        return Err(TableError::Cell {
            path: path.into(),
            line: 1,
            key: "header".into(),
            value: header.join(","),
            allowed: "ramp,pulse_ms,sign, further axes, a_crit_g,uncertainty_g,half_min_height_g,\
                      survived_g,failed_g,onset_g,runs,status,flags",
        });
    };
    let points = lines
        .map(|(cells, line)| point(&header, axes, cells, line, path))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(Summary {
        study: "Critical shocks".into(),
        digest: String::new(),
        axes: header[BEFORE_AXES.len()..BEFORE_AXES.len() + axes].to_vec(),
        points,
        totals: Totals::default(),
    })
}

fn point(
    header: &[String],
    axes: usize,
    mut cells: Vec<String>,
    line: usize,
    path: &str,
) -> Result<PointSummary, TableError> {
    let fault = |key: &str, value: &str, allowed| TableError::Cell {
        path: path.into(),
        line,
        key: key.into(),
        value: value.into(),
        allowed,
    };
    if cells.len() != header.len() {
        let found = cells.len().to_string();
        return Err(fault("cells", &found, "as many as the header has"));
    }
    let after = cells.split_off(BEFORE_AXES.len() + axes);
    let number = |key: &str, text: &str| {
        let value = text.parse::<f64>().ok().filter(|v| v.is_finite());
        value.ok_or_else(|| fault(key, text, "a number"))
    };
    let maybe = |column: usize| match after[column].as_str() {
        "" => Ok(None),
        text => number(AFTER_AXES[column], text).map(Some),
    };
    let flags = after[8].split(';').filter(|word| !word.is_empty());
    Ok(PointSummary {
        ramp: cells[0].clone(),
        pulse_ms: number("pulse_ms", &cells[1])?,
        sign: Sign::from_word(&cells[2]).ok_or_else(|| fault("sign", &cells[2], "+ or -"))?,
        axes: cells[BEFORE_AXES.len()..]
            .iter()
            .map(|text| match text.parse() {
                Ok(number) => AxisValue::Number(number),
                Err(_) => AxisValue::Text(text.clone()),
            })
            .collect(),
        a_crit_g: maybe(0)?,
        uncertainty_g: maybe(1)?,
        half_min_height_g: maybe(2)?,
        survived_g: maybe(3)?,
        failed_g: maybe(4)?,
        contributions: Vec::new(),
        levels: String::new(),
        onset_g: maybe(5)?,
        runs: after[6]
            .parse()
            .map_err(|_| fault("runs", &after[6], "a whole number"))?,
        status: Status::parse(&after[7])
            .ok_or_else(|| fault("status", &after[7], "a status of the report"))?,
        flags: flags
            .map(|word| {
                Flag::parse(word).ok_or_else(|| fault("flags", word, "flags of the report"))
            })
            .collect::<Result<_, _>>()?,
        brackets_g: Vec::new(),
        scanned_from_g: None,
        largest_gap_pct: None,
    })
}

/// Cells of a line of CSV (RFC 4180, without line breaks inside cells).
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        let last = cells.len() - 1;
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                cells[last].push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            other => cells[last].push(other),
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::table;

    const TABLE: &str = "ramp,pulse_ms,sign,\"a, b\",a_crit_g,uncertainty_g,half_min_height_g,\
                         survived_g,failed_g,onset_g,runs,status,flags\n\
                         rigid,0.5,+,60,202.9,1,-0.5,201.9,203.9,195.3,4,ok,retry;window\n\
                         none,3,-,\"say \"\"x\"\"\",,,,2000,,,7,above_range,\n";

    #[test]
    fn a_table_read_back_is_written_the_same() {
        let summary = parse(TABLE, "table.csv").expect("a table");
        assert_eq!(summary.axes, ["a, b"]);
        assert_eq!(summary.points[0].failed_g, Some(203.9));
        assert_eq!(summary.points[1].status, Status::AboveRange);
        assert_eq!(table::csv(&summary), TABLE);
    }

    #[test]
    fn a_fault_names_file_line_and_column() {
        for (from, to, reported) in [
            (
                "203.9",
                "high",
                "t.csv, line 2: failed_g = \"high\" must be a number",
            ),
            (
                "above_range",
                "good",
                "t.csv, line 3: status = \"good\" must be a status of the report",
            ),
            (",+,", ",up,", "t.csv, line 2: sign = \"up\" must be + or -"),
            (
                ",ok,",
                ",",
                "t.csv, line 2: cells = \"12\" must be as many as the header has",
            ),
        ] {
            let error = parse(&TABLE.replace(from, to), "t.csv").expect_err("a fault");
            assert_eq!(error.to_string(), reported);
        }
        assert!(parse("", "t.csv").is_err());
    }
}
