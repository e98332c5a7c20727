//! Chooses the reader of a matrix or a map of freedoms by the extension of its file.

use super::dof::{self, Freedoms};
use super::sparse::Matrix;
use super::{calculix, dense, market};
use crate::fault::{Fault, Faults};
use crate::text::Source;
use std::path::Path;

/// The map of freedoms, from the given file: a `.dof` file or a list of places.
///
/// # Errors
/// Those of the reader.
pub fn freedoms(dof: Option<&Path>, places: Option<&Path>) -> Result<Option<Freedoms>, Faults> {
    Ok(match (dof, places) {
        (Some(path), _) => Some(dof::read(&Source::read(path)?)?),
        (_, Some(path)) => Some(dense::read_places(&Source::read(path)?)?.0),
        _ => None,
    })
}

/// A matrix: Matrix Market (`.mtx`), CalculiX (`.sti`, `.mas`), or rows of numbers, `square` or not.
///
/// # Errors
/// Those of the reader; E169 for CalculiX without a map.
pub fn matrix(path: &Path, freedoms: Option<&Freedoms>, square: bool) -> Result<Matrix, Faults> {
    let source = Source::read(path)?;
    let ending = path.extension().and_then(|ending| ending.to_str());
    match (ending, freedoms) {
        (Some("mtx" | "mm"), _) => market::read(&source),
        (Some("sti" | "mas"), Some(freedoms)) => calculix::read(&source, freedoms),
        (Some("sti" | "mas"), None) => {
            let fault = Fault::of("E169", &source.name, "no map of freedoms");
            Err(fault
                .hint("give the .dof file of the same run with --dof")
                .into())
        }
        _ => dense::read(&source, square),
    }
}
