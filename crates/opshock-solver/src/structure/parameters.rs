//! Input of a structural model as plain data: places, times, contact method.

use crate::disk::{DiskParameters, DiskResolution};
use crate::ramp::RampParameters;
use crate::shock::{BaseMode, ObliqueShock, Pulse};

/// Contact method of disk and ramp.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub enum ContactMethod {
    /// Exact flow between impacts, impacts located in time, aimed impulses in lasting contact.
    #[default]
    ExactFlow,
    /// Implicit midpoint steps with the constraint on velocities ([`crate::complementarity::moreau_jean`]): shares only
    /// the modes with the other method. An impact takes a whole step, so it is less accurate at equal steps.
    MoreauJean,
}

/// Numerical resolution of the structure.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct StructureResolution {
    /// Step of the grid on which motion is stored and contact is resolved, s. Divided into equal
    /// parts when the fastest mode of the disk needs it.
    pub step_s: f64,
    /// Contact method.
    pub contact: ContactMethod,
}

/// How long a simulation lasts after the onset.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub enum Window {
    /// Fixed length, s.
    Fixed {
        /// Length after the onset, s.
        length_s: f64,
    },
    /// Until disk and ramp energy fall below a share of their peak.
    UntilDecayed {
        /// Share of the peak energy.
        share: f64,
        /// Longest window, s.
        max_s: f64,
    },
}

/// Where the slider stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderPlace {
    /// Radius of its centre, m.
    pub radius_m: f64,
    /// Angle of its centre in the disk's sense of rotation, same origin as the ramp, rad.
    pub angle_rad: f64,
    /// Angle from the slider's x axis to the disk's velocity, positive towards +y, rad.
    pub skew_rad: f64,
}

impl SliderPlace {
    /// Weights of (slope outwards, slope along the disk's velocity) in pitch and in roll:
    /// w_x = w_t cos − w_r sin, w_y = w_t sin + w_r cos; pitch = −w_x, roll = w_y.
    pub(super) fn slopes_to_pose(&self) -> [[f64; 2]; 2] {
        let (sine, cosine) = self.skew_rad.sin_cos();
        [[sine, -cosine], [cosine, sine]]
    }
}

/// Everything a structural model is built from.
#[derive(Clone, Copy, Debug)]
pub struct StructureParameters<'a> {
    /// Disk.
    pub disk: &'a DiskParameters,
    /// Numerical resolution of the disk.
    pub disk_resolution: &'a DiskResolution,
    /// Ramp.
    pub ramp: &'a RampParameters,
    /// Slider.
    pub slider: SliderPlace,
    /// Unit pulse.
    pub pulse: &'a Pulse,
    /// Further loads of an oblique shock, in proportion to the pulse.
    pub oblique: Option<&'a ObliqueShock>,
    /// Modes of the base that everything stands on; empty: a rigid base.
    pub base: &'a [BaseMode],
    /// Simulated time.
    pub window: Window,
    /// Numerical resolution in time.
    pub resolution: &'a StructureResolution,
}
