//! Writes the shapes of natural modes: grids for ParaView, and drawings with their tables.
//!
//! | file | grid | data, a vector for each mode |
//! |---|---|---|
//! | `disk_modes.vtu` | the disk's middle surface | `n2_c0_per_sqrt_kg`: 2 nodal diameters, 0 nodal circles |
//! | `ramp_modes.vtu` | the ramp's finite elements, or both arms as boxes | `mode_1_per_sqrt_kg` |
//! | `suspension_modes.vtu` | hinge, load beam and tab as a strip | `bending_free_1_per_sqrt_kg`, ..., `torsion_pinned_1_per_sqrt_kg` |
//! | `head_modes.vtu` | the slider's face, in slider coordinates | `mode_1_real_per_sqrt_kg`, `mode_1_imaginary_per_sqrt_kg` |
//!
//! Every mode has unit modal mass, so that modes of one body are orthonormal in its mass: Σ m φᵢ φⱼ = δᵢⱼ.
//! A disk's mode with nodal diameters is one of a pair; the other is the same, rotated by 90°/n. The
//! slider's modes on its film are complex: they move as Re(φ e^{st}). Frequencies, Hz, are in the grid's field
//! `frequency_hz` in the order of the modes. Coordinates are metres, as in the series of a run.

mod drawings;
mod grids;
mod shapes;

pub use shapes::{ArmShape, DiskShape, DiskShapes, HeadShape, HeadShapes, ModeShapes, RampShapes};

use super::error::ReportError;
use super::run_plots::picture;
use crate::store::aside::write_all;
use std::path::{Path, PathBuf};

/// Writes `BODY_modes.vtu`, `.svg`, `.png` and `.csv` of every body into `folder`, which is made when it is
/// missing. Returns the written files.
///
/// # Errors
///
/// [`ReportError`] at the first file that cannot be made.
pub fn write_mode_shapes(folder: &Path, shapes: &ModeShapes) -> Result<Vec<PathBuf>, ReportError> {
    let grids = grids::all(shapes).into_iter();
    let mut files: Vec<_> = grids
        .map(|(name, text)| (name.to_string(), text.into_bytes()))
        .collect();
    for drawing in drawings::all(shapes) {
        files.extend(picture(drawing.name, &drawing.figure, drawing.table)?);
    }
    Ok(write_all(folder, files)?)
}
