//! Reads matrices of CalculiX, as written by `*FREQUENCY, SOLVER=MATRIXSTORAGE`.
//!
//! `name.sti` and `name.mas` hold a line "row column value" for each entry of the upper triangle, with indices from 1.
//! `name.dof` holds a line "node.direction" for each row. The units are those of the model, most often N, mm, s, t.

use super::dof::Freedoms;
use super::entries::{Listed, Stored, refuse_large};
use super::sparse::Matrix;
use crate::fault::{Fault, Faults};
use crate::text::{Source, Word};

/// Reads a `.sti` or `.mas` file for the freedoms of its `.dof` file.
///
/// # Errors
/// E161 when an index is larger than the freedoms; E166 for values that are not finite; E171 for
/// entries given twice and words that are no numbers; E160 when a row has no entry at all: the file
/// is cut short.
pub fn read(source: &Source, freedoms: &Freedoms) -> Result<Matrix, Faults> {
    let n = freedoms.len();
    refuse_large(&source.name, n, n)?;
    let (mut listed, mut faults) = (Listed::default(), Faults::default());
    let mut rows = vec![false; n];
    for line in source.lines().filter(|line| !line.text.trim().is_empty()) {
        let words: Vec<Word<'_>> = line.words().collect();
        if let Some(beyond) = words
            .iter()
            .take(2)
            .find(|word| word.count().is_some_and(|index| index > n))
        {
            faults.push(
                Fault::of("E161", &source.name, format!("the map of freedoms has {n}"))
                    .at(beyond.place())
                    .value(beyond.text)
                    .allowed(format!("1 to {n}"))
                    .hint(format!("is {} of the same run?", freedoms.file)),
            );
            continue;
        }
        listed.push(&source.name, &words, (n, n), &mut faults);
        if let Some((entry, _)) = listed.entries.last() {
            rows[entry.row] = true;
            rows[entry.column] = true;
        }
    }
    if let Some(missing) = rows.iter().position(|row| !row)
        && faults.is_empty()
    {
        let message = format!("no entry of freedom {}: cut short?", freedoms.name(missing));
        faults.push(
            Fault::of("E160", &source.name, message)
                .what(format!("row {}", missing + 1))
                .value(format!("{} bytes", source.n_bytes()))
                .allowed(format!("entries in each of {n} rows")),
        );
    }
    // Entries of both triangles are accepted: some programs write them.
    let both = listed.entries.iter().any(|(e, _)| e.row < e.column)
        && listed.entries.iter().any(|(e, _)| e.row > e.column);
    let stored = if both {
        Stored::All
    } else {
        Stored::OneTriangle
    };
    let matrix = listed.finish(&source.name, (n, n), stored, &mut faults);
    faults.or(matrix)
}
