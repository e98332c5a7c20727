//! Natural modes as shapes: grids for ParaView, and drawings with their tables.
//!
//! | file | grid | data, a vector for each mode |
//! |---|---|---|
//! | `disk_modes.vtu` | the disk's middle surface | `n2_c0_per_sqrt_kg`: 2 nodal diameters, 0 nodal circles |
//! | `ramp_modes.vtu` | the ramp's finite elements, or both arms as boxes | `mode_1_per_sqrt_kg` |
//! | `suspension_modes.vtu` | hinge, load beam and tab as a strip | `bending_free_1_per_sqrt_kg`, ..., `torsion_pinned_1_per_sqrt_kg` |
//! | `head_modes.vtu` | the slider's face, in slider coordinates | `mode_1_real_per_sqrt_kg`, `mode_1_imaginary_per_sqrt_kg` |
//!
//! Every mode has unit modal mass, so that modes of one body are orthonormal in its mass: Σ m φᵢ φⱼ = δᵢⱼ.
//! A disk's mode with nodal diameters is one of a pair; the other is the same, turned by 90°/n. The
//! slider's modes on its film are complex: they move as Re(φ e^{st}). Frequencies, Hz, are in the grid's field
//! `frequency_hz` in the order of the modes. Coordinates are metres, as in the series of a run.

mod drawings;
mod grids;

use super::files::ReportError;
use super::run_plots::picture;
use crate::store::aside::write_all;
use nalgebra::Complex;
use opshock_solid::ramp::{RampMesh, RampShape};
use opshock_solver::suspension::SuspensionShapes;
use std::path::{Path, PathBuf};

/// Modes of the disk on a polar grid.
#[derive(Clone, Debug)]
pub struct DiskShapes {
    /// Radii, clamp to rim, m.
    pub radii_m: Vec<f64>,
    /// Angles, rad, around the whole disk, the first not repeated.
    pub angles_rad: Vec<f64>,
    /// Modes, by rising frequency.
    pub modes: Vec<DiskShape>,
}

/// A mode of the disk: φ(r) cos nθ.
#[derive(Clone, Debug)]
pub struct DiskShape {
    /// Nodal diameters n.
    pub nodal_diameters: usize,
    /// Nodal circles.
    pub nodal_circles: usize,
    /// Frequency in the rotating frame, Hz.
    pub frequency_hz: f64,
    /// φ at the radii, 1/√kg.
    pub radial_per_sqrt_kg: Vec<f64>,
}

/// A mode of a ramp that is known at its contact points only.
#[derive(Clone, Copy, Debug)]
pub struct ArmShape {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Motion of the top and the bottom contact along the axis, 1/√kg.
    pub contact_per_sqrt_kg: [f64; 2],
}

/// What of the ramp is known to move.
#[derive(Clone, Debug)]
pub enum RampShapes {
    /// The contact points.
    Contacts {
        /// Radius of the contact points, m.
        radius_m: f64,
        /// Angle, rad.
        angle_rad: f64,
        /// Contact surfaces at rest over the disk's middle surface: top, bottom, m.
        rest_m: [f64; 2],
        /// Modes.
        modes: Vec<ArmShape>,
    },
    /// All of it.
    Solid {
        /// Finite elements, in their own coordinates.
        mesh: Box<RampMesh>,
        /// Modes.
        modes: Vec<RampShape>,
    },
}

/// Modes of the slider on its film.
#[derive(Clone, Debug)]
pub struct HeadShapes {
    /// Length along x, m.
    pub length_m: f64,
    /// Width along y, m.
    pub width_m: f64,
    /// Modes, by rising frequency.
    pub modes: Vec<HeadShape>,
}

/// A mode of the slider on its film.
#[derive(Clone, Copy, Debug)]
pub struct HeadShape {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Centre height (1/√kg), pitch and roll (1/(m √kg)).
    pub shape: [Complex<f64>; 3],
}

impl HeadShape {
    /// Rise of a point of the slider from its centre, 1/√kg.
    fn rise(&self, x_m: f64, y_m: f64) -> Complex<f64> {
        let [height, pitch, roll] = self.shape;
        height - pitch * x_m + roll * y_m
    }
}

/// Everything that is drawn.
#[derive(Clone, Debug)]
pub struct ModeShapes {
    /// Name of the study.
    pub study: String,
    /// Disk.
    pub disk: DiskShapes,
    /// Ramp, when it moves.
    pub ramp: Option<RampShapes>,
    /// Suspension, when its shape is known.
    pub suspension: Option<SuspensionShapes>,
    /// Slider.
    pub head: HeadShapes,
}

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
