//! Where on the disk ramp and slider are, and what shakes it.

use crate::disk::DiskParameters;
use crate::shock::ObliqueShock;
use crate::structure::parameters::SliderPlace;

/// What a part needs to know of the disk and the places on it.
pub(super) struct Places<'a> {
    pub disk: &'a DiskParameters,
    pub slider: SliderPlace,
    pub ramp_radius_m: f64,
    /// Of the slider from the ramp.
    pub angle_rad: f64,
    pub ramp_angle_rad: f64,
    pub oblique: Option<&'a ObliqueShock>,
}
