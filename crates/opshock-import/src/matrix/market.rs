//! Reads Matrix Market files: coordinate and array, real or integer, general, symmetric or skew-symmetric.
//!
//! ```text
//! %%MatrixMarket matrix coordinate real symmetric
//! % comment
//! 3 3 4
//! 1 1 2.0
//! …
//! ```
//!
//! # Source
//! R. F. Boisvert, R. Pozo, K. Remington: The Matrix Market Exchange Formats, NISTIR 5935 (1996).

use super::entries::{Listed, Stored, place, real, refuse_large};
use super::sparse::{Entry, Matrix};
use crate::fault::{Fault, Faults};
use crate::text::{Line, Source, Word};

const HEADER: &str =
    "%%MatrixMarket matrix coordinate|array real|integer general|symmetric|skew-symmetric";

/// Reads a matrix.
///
/// # Errors
/// E160 for another header, or fewer or more entries than declared; E161 for sizes; E166 for values that are not
/// finite; E171 for indices outside, entries given twice, words that are no numbers; E172 for a diagonal of a skew
/// matrix.
pub fn read(source: &Source) -> Result<Matrix, Faults> {
    let (coordinate, stored) = header(source)?;
    let mut lines = source
        .lines()
        .skip(1)
        .filter(|line| !line.text.starts_with('%') && !line.text.trim().is_empty());
    let Some(line) = lines.next() else {
        return Err(Fault::of("E160", &source.name, "the file ends before its sizes").into());
    };
    let sizes = sizes(source, line, if coordinate { 3 } else { 2 })?;
    let (n_rows, n_columns) = (sizes[0], sizes[1]);
    refuse_large(&source.name, n_rows, n_columns)?;
    if stored != Stored::All && n_rows != n_columns {
        return Err(
            Fault::of("E161", &source.name, "a symmetric matrix is square")
                .line(line.number)
                .value(format!("{n_rows} x {n_columns}"))
                .allowed("as many columns as rows")
                .into(),
        );
    }
    if coordinate {
        read_coordinates(source, lines, (n_rows, n_columns), sizes[2], stored)
    } else {
        read_array(source, lines, (n_rows, n_columns), stored)
    }
}

/// Whether entries have coordinates, and what is stored.
fn header(source: &Source) -> Result<(bool, Stored), Faults> {
    let first = source.lines().next().map_or("", |line| line.text);
    let words: Vec<String> = first.split_whitespace().map(str::to_lowercase).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let wrong = |message: &str| {
        Err(Fault::of("E160", &source.name, message)
            .line(1)
            .value(first)
            .allowed(HEADER)
            .into())
    };
    let ["%%matrixmarket", "matrix", format, field, symmetry] = words[..] else {
        return wrong("not the header of a Matrix Market file");
    };
    if !["real", "integer", "double"].contains(&field) {
        return wrong("the field is not read");
    }
    let stored = match symmetry {
        "general" => Stored::All,
        "symmetric" => Stored::OneTriangle,
        "skew-symmetric" => Stored::OneTriangleSkew,
        _ => return wrong("the symmetry is not read"),
    };
    match format {
        "coordinate" => Ok((true, stored)),
        "array" => Ok((false, stored)),
        _ => wrong("the format is not read"),
    }
}

fn sizes(source: &Source, line: Line<'_>, n: usize) -> Result<Vec<usize>, Faults> {
    let counts: Option<Vec<usize>> = line.words().map(|word| word.count()).collect();
    match counts {
        Some(counts) if counts.len() == n && counts[0] > 0 && counts[1] > 0 => Ok(counts),
        _ => Err(Fault::of("E160", &source.name, "not the line of sizes")
            .line(line.number)
            .value(line.text.trim())
            .allowed(if n == 3 {
                "rows, columns, entries: whole numbers above 0"
            } else {
                "rows, columns: whole numbers above 0"
            })
            .into()),
    }
}

fn read_coordinates<'a>(
    source: &Source,
    lines: impl Iterator<Item = Line<'a>>,
    shape: (usize, usize),
    declared: usize,
    stored: Stored,
) -> Result<Matrix, Faults> {
    let (mut listed, mut faults, mut found) = (Listed::default(), Faults::default(), 0);
    for line in lines {
        let words: Vec<Word<'_>> = line.words().collect();
        listed.push(&source.name, &words, shape, &mut faults);
        found += 1;
    }
    faults.append(counted(source, "entries", declared, found));
    let matrix = listed.finish(&source.name, shape, stored, &mut faults);
    faults.or(matrix)
}

/// E160 when a file holds another number of items than it declares.
fn counted(source: &Source, of: &str, declared: usize, found: usize) -> Faults {
    if declared == found {
        return Faults::default();
    }
    let message = if found < declared {
        format!("the file is cut short: {declared} {of} declared")
    } else {
        format!("the file has more than the {declared} {of} it declares")
    };
    Fault::of("E160", &source.name, message)
        .value(format!("{found} {of} in {} bytes", source.n_bytes()))
        .allowed(declared.to_string())
        .into()
}

/// Values by columns; of a symmetric matrix from the diagonal down, of a skew one from below it.
fn read_array<'a>(
    source: &Source,
    lines: impl Iterator<Item = Line<'a>>,
    (n_rows, n_columns): (usize, usize),
    stored: Stored,
) -> Result<Matrix, Faults> {
    let first = |column: usize| match stored {
        Stored::All => 0,
        Stored::OneTriangle => column,
        Stored::OneTriangleSkew => column + 1,
    };
    let declared = (0..n_columns).fold(0_usize, |sum, column| {
        sum.saturating_add(n_rows.saturating_sub(first(column)))
    });
    let (mut row, mut column) = (first(0), 0);
    let (mut entries, mut faults, mut found) = (Vec::new(), Faults::default(), 0_usize);
    for word in lines.flat_map(Line::words) {
        found += 1;
        // A skew matrix's last column is empty.
        while column < n_columns && row >= n_rows {
            column += 1;
            row = first(column);
        }
        if column >= n_columns {
            continue;
        }
        let value = real(&source.name, &word, &place(row, column), &mut faults);
        if let Some(value) = value.filter(|value| *value != 0.0) {
            entries.push(Entry { row, column, value });
            if stored != Stored::All && row != column {
                let value = if stored == Stored::OneTriangleSkew {
                    -value
                } else {
                    value
                };
                entries.push(Entry {
                    row: column,
                    column: row,
                    value,
                });
            }
        }
        row += 1;
    }
    faults.append(counted(source, "values", declared, found));
    faults.or(())?;
    Ok(Matrix::of(&source.name, n_rows, n_columns, entries))
}

/// A symmetric matrix as text: its lower triangle, every digit.
pub fn write_symmetric(matrix: &Matrix) -> String {
    use std::fmt::Write as _;
    let lower: Vec<Entry> = matrix.entries().filter(|e| e.row >= e.column).collect();
    let mut text = String::from("%%MatrixMarket matrix coordinate real symmetric\n");
    let _ = writeln!(
        text,
        "{} {} {}",
        matrix.n_rows,
        matrix.n_columns,
        lower.len()
    );
    for Entry { row, column, value } in lower {
        let _ = writeln!(text, "{} {} {value:e}", row + 1, column + 1);
    }
    text
}
