//! Reads matrices written as rows of numbers, such as `susp_M.dat` and `susp_K.dat` of the CML family, and the freedoms
//! of their rows, `susp_cords.dat`: a line "x y z type" for each row, type 1 to 6 for displacements along and rotations
//! about x, y, z.

use super::dof::{Direction, Freedom, Freedoms};
use super::entries::{place, real, refuse_large};
use super::sparse::{Entry, Matrix};
use crate::fault::{Fault, Faults};
use crate::text::{NotANumber, Source, Word};

/// Reads a matrix, of as many rows as columns where it is to be `square`. Lines that start with `#`
/// or `%` are comments.
///
/// # Errors
/// E160 for a row of another length than the first; E161 for more or fewer rows than columns;
/// E166 for values that are not finite; E171 for words that are no numbers.
pub fn read(source: &Source, square: bool) -> Result<Matrix, Faults> {
    let (mut entries, mut faults) = (Vec::new(), Faults::default());
    let (mut n_rows, mut n_columns) = (0, 0);
    for line in source.lines() {
        if line.text.trim_start().starts_with(['#', '%']) || line.text.trim().is_empty() {
            continue;
        }
        let mut found = 0;
        for word in line.words() {
            let what = place(n_rows, found);
            let value = real(&source.name, &word, &what, &mut faults);
            if let Some(value) = value.filter(|value| *value != 0.0) {
                entries.push(Entry {
                    row: n_rows,
                    column: found,
                    value,
                });
            }
            found += 1;
        }
        if n_rows == 0 {
            n_columns = found;
        } else if found != n_columns {
            faults.push(
                Fault::of(
                    "E160",
                    &source.name,
                    "the row has another length than the first",
                )
                .line(line.number)
                .what(format!("row {}", n_rows + 1))
                .value(format!("{found} values"))
                .allowed(format!("{n_columns} values")),
            );
        }
        n_rows += 1;
    }
    if square && n_rows != n_columns && faults.is_empty() {
        faults.push(
            Fault::of("E161", &source.name, "the matrix is not square")
                .value(format!("{n_rows} x {n_columns}"))
                .allowed("as many rows as columns")
                .hint("is the file cut short?"),
        );
    }
    refuse_large(&source.name, n_rows, n_columns)?;
    faults.or(())?;
    Ok(Matrix::of(&source.name, n_rows, n_columns, entries))
}

/// Reads the places, in mm, and kinds of the freedoms. Rows of one place are one node; nodes are numbered from 1 in
/// order of appearance.
///
/// # Errors
/// E160 for a line of another length, E166 and E171 as [`read`], E171 for another type and for a
/// freedom given twice.
pub fn read_places(source: &Source) -> Result<(Freedoms, Vec<[f64; 3]>), Faults> {
    let (mut list, mut faults) = (Vec::new(), Faults::default());
    let (mut nodes, mut places): (Vec<[f64; 3]>, Vec<[f64; 3]>) = (Vec::new(), Vec::new());
    let mut index = std::collections::HashMap::new();
    let mut seen = std::collections::HashMap::new();
    for line in source.lines() {
        if line.text.trim_start().starts_with(['#', '%']) || line.text.trim().is_empty() {
            continue;
        }
        let words: Vec<Word<'_>> = line.words().collect();
        let [x, y, z, kind] = &words[..] else {
            faults.push(
                Fault::of("E160", &source.name, "the line has another number of words")
                    .line(line.number)
                    .value(format!("{} words", words.len()))
                    .allowed("x, y, z, type"),
            );
            continue;
        };
        let names = ["x", "y", "z"];
        let mut place = [0.0; 3];
        for ((word, name), value) in [x, y, z].into_iter().zip(names).zip(&mut place) {
            *value = 1e-3 * real(&source.name, word, name, &mut faults).unwrap_or_default();
        }
        // Types are whole numbers; some programs write them with a point.
        let number = match kind.real() {
            Ok(value) if value.fract() == 0.0 && (1.0..=6.0).contains(&value) => Ok(value as u64),
            Ok(_) | Err(NotANumber::NotFinite | NotANumber::Word | NotANumber::Comma) => Err(()),
        };
        let Some(direction) = number.ok().and_then(Direction::of) else {
            faults.push(
                Fault::of("E171", &source.name, "not a kind of freedom")
                    .at(kind.place())
                    .what("type")
                    .value(kind.text)
                    .allowed("1, 2, 3 along and 4, 5, 6 about x, y, z"),
            );
            continue;
        };
        let node = *index.entry(place.map(f64::to_bits)).or_insert_with(|| {
            nodes.push(place);
            nodes.len() as u64
        });
        let freedom = Freedom { node, direction };
        if let Some(before) = seen.insert(freedom, line.number) {
            let message = format!("the freedom stands on line {before} already");
            let fault = Fault::of("E171", &source.name, message);
            faults.push(fault.line(line.number).value(line.text.trim()));
        }
        list.push(freedom);
        places.push(place);
    }
    faults.or((Freedoms::of(&source.name, list), places))
}
