//! Entries of a matrix as files list them: places, values, and which triangle is stored.

use super::sparse::{Entry, Matrix};
use crate::fault::{Fault, Faults};
use crate::text::{NotANumber, Word};

/// Rows of the largest matrix read; its factors would not fit into a workstation's memory.
pub const MAX_ROWS: usize = 400_000;

/// Entries as they are read, with the lines they stand on.
#[derive(Debug, Default)]
pub(super) struct Listed {
    pub(super) entries: Vec<(Entry, usize)>,
}

/// Part of a matrix that a file stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stored {
    All,
    OneTriangle,
    OneTriangleSkew,
}

impl Listed {
    /// Adds "row column value", with indices from 1 to at most `n_rows` and `n_columns`.
    pub(super) fn push(
        &mut self,
        file: &str,
        words: &[Word<'_>],
        (n_rows, n_columns): (usize, usize),
        faults: &mut Faults,
    ) {
        let [row, column, value] = words else {
            let line = words.first().map_or(0, |word| word.line);
            let said = words
                .iter()
                .map(|word| word.text)
                .collect::<Vec<_>>()
                .join(" ");
            faults.push(
                Fault::of("E171", file, "an entry has another number of words")
                    .line(line)
                    .value(said)
                    .allowed("row, column, value"),
            );
            return;
        };
        let sound = faults.listed.len() + faults.unlisted;
        let row = index(file, row, "row", n_rows, faults);
        let column = index(file, column, "column", n_columns, faults);
        let what = row
            .zip(column)
            .map(|(i, j)| place(i, j))
            .unwrap_or_default();
        let number = real(file, value, &what, faults);
        if let (Some(row), Some(column), Some(value_read)) = (row, column, number)
            && sound == faults.listed.len() + faults.unlisted
        {
            let entry = Entry {
                row,
                column,
                value: value_read,
            };
            self.entries.push((entry, value.line));
        }
    }

    /// The matrix; entries given twice are faults.
    pub(super) fn finish(
        mut self,
        file: &str,
        (n_rows, n_columns): (usize, usize),
        stored: Stored,
        faults: &mut Faults,
    ) -> Matrix {
        let key = |entry: &Entry| match stored {
            Stored::All => (entry.row, entry.column),
            _ => (entry.row.max(entry.column), entry.row.min(entry.column)),
        };
        self.entries
            .sort_by_key(|(entry, line)| (key(entry), *line));
        for pair in self.entries.windows(2) {
            let ((first, before), (second, line)) = (pair[0], pair[1]);
            if key(&first) == key(&second) {
                let at = place(second.row, second.column);
                let message = format!("the entry stands on line {before} already");
                let mut fault = Fault::of("E171", file, message)
                    .line(line)
                    .what(at)
                    .value(second.value.to_string())
                    .allowed("every entry once");
                if stored != Stored::All && first.row != second.row {
                    fault = fault.hint("of a symmetric matrix one triangle is stored");
                }
                faults.push(fault);
            }
        }
        let mut entries = Vec::with_capacity(self.entries.len());
        for (entry, line) in self.entries {
            let mirrored = Entry {
                row: entry.column,
                column: entry.row,
                value: match stored {
                    Stored::OneTriangleSkew => -entry.value,
                    _ => entry.value,
                },
            };
            if stored == Stored::OneTriangleSkew && entry.row == entry.column && entry.value != 0.0
            {
                faults.push(
                    Fault::of("E172", file, "the diagonal of a skew matrix is not zero")
                        .line(line)
                        .what(place(entry.row, entry.column))
                        .value(entry.value.to_string())
                        .allowed("0"),
                );
            }
            entries.push(entry);
            if stored != Stored::All && entry.row != entry.column {
                entries.push(mirrored);
            }
        }
        Matrix::of(file, n_rows, n_columns, entries)
    }
}

/// "(row, column)", numbered from 1.
pub(crate) fn place(row: usize, column: usize) -> String {
    format!("({}, {})", row + 1, column + 1)
}

/// Converts an index that starts at 1 to one that starts at 0.
fn index(file: &str, word: &Word<'_>, what: &str, n: usize, faults: &mut Faults) -> Option<usize> {
    let fault = |message: &str| {
        Fault::of("E171", file, message)
            .at(word.place())
            .what(what)
            .value(word.text)
            .allowed(format!("1 to {n}"))
    };
    match word.count() {
        Some(0) => faults.push(
            fault("indices count from 1").hint("add 1 to every index of a file that counts from 0"),
        ),
        Some(found) if found > n => {
            faults.push(fault("the index is larger than the matrix"));
        }
        Some(found) => return Some(found - 1),
        None => faults.push(fault("the index is no whole number")),
    }
    None
}

/// A value of a matrix.
pub(super) fn real(file: &str, word: &Word<'_>, what: &str, faults: &mut Faults) -> Option<f64> {
    let fault = |code, message: &str| {
        Fault::of(code, file, message)
            .at(word.place())
            .what(what)
            .value(word.text)
    };
    match word.real() {
        Ok(value) => return Some(value),
        Err(NotANumber::Comma) => faults.push(
            fault("E171", "a comma in a number")
                .allowed("a decimal point")
                .hint("write decimals with a point and separate values by blanks"),
        ),
        Err(NotANumber::NotFinite) => faults.push(
            fault("E166", "the value is not finite, or 1e300 and more")
                .allowed("a number below 1e300"),
        ),
        Err(NotANumber::Word) => {
            faults.push(fault("E171", "the value is no number").allowed("a number"));
        }
    }
    None
}

/// Rejects more rows than are read.
pub(super) fn refuse_large(file: &str, n_rows: usize, n_columns: usize) -> Result<(), Faults> {
    if n_rows.max(n_columns) <= MAX_ROWS {
        return Ok(());
    }
    Err(Fault::of("E161", file, "the matrix is too large")
        .value(format!("{n_rows} x {n_columns}"))
        .allowed(format!("at most {MAX_ROWS} rows"))
        .hint("reduce the model first")
        .into())
}
