//! Errors of building a disk model.

use crate::linalg::DenseError;

/// Fault of a disk, its resolution or a place on it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DiskError {
    /// A parameter is outside its range.
    #[error("disk parameter {name} = {value:e} is outside its range ({allowed})")]
    Parameter {
        /// Name of the field.
        name: &'static str,
        /// Value found.
        value: f64,
        /// Allowed range in words.
        allowed: &'static str,
    },
    /// A place lies off the free annulus.
    #[error(
        "{place} at radius {radius_m} m is not between the clamp at {inner_m} m and the rim at {outer_m} m"
    )]
    OffTheDisk {
        /// What stands there.
        place: &'static str,
        /// Its radius, m.
        radius_m: f64,
        /// Clamp radius, m.
        inner_m: f64,
        /// Outer radius, m.
        outer_m: f64,
    },
    /// The coupled modes of a harmonic and its hub cannot be separated.
    #[error(
        "modes of nodal-diameter number {nodal_diameters} on the hub: two of them coincide; change \
         the bearing's stiffness or damping a little"
    )]
    Hub {
        /// Harmonic.
        nodal_diameters: usize,
        /// Cause.
        #[source]
        source: DenseError,
    },
    /// The eigenvalue problem of a harmonic failed.
    #[error("modes of nodal-diameter number {nodal_diameters}")]
    Modes {
        /// Harmonic.
        nodal_diameters: usize,
        /// Cause.
        #[source]
        source: DenseError,
    },
}
