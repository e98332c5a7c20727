//! Disk, places of ramp and slider on it, and the shock's direction, for one part of the rotor.

use crate::disk::DiskParameters;
use crate::shock::ObliqueShock;
use crate::structure::parameters::SliderPlace;

/// What a part of the rotor needs of the disk and the places on it.
pub(super) struct Places<'a> {
    pub disk: &'a DiskParameters,
    pub slider: SliderPlace,
    pub ramp_radius_m: f64,
    /// Angle of the slider from the ramp.
    pub angle_rad: f64,
    pub ramp_angle_rad: f64,
    pub oblique: Option<&'a ObliqueShock>,
}
