//! The modes of disk, ramp, suspension and slider as they are drawn.

use nalgebra::Complex;
use opshock_solid::ramp::{RampMesh, RampShape};
use opshock_solver::suspension::SuspensionShapes;

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

/// The part of the ramp whose motion is known.
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
    pub(super) fn rise(&self, x_m: f64, y_m: f64) -> Complex<f64> {
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
