//! Rotating flexible annular disk, clamped inside to the base or to a hub, free outside.
#![doc = include_str!("theory.md")]

pub mod basis;
pub mod harmonic;
pub mod hub;
pub mod membrane;
pub mod run_out;

pub use basis::{DiskBasis, DiskError, DiskMode, DiskModes, Harmonics, MOST_ELEMENTS};
pub use hub::HubParameters;
pub use membrane::MembraneStress;
pub use run_out::{SurfaceMotion, Track, Wave};

/// How the disk loses energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DiskDamping {
    /// Rayleigh damping of the material, in the rotating frame: c = alpha m + beta k.
    Rayleigh {
        /// Mass share, 1/s.
        alpha_per_s: f64,
        /// Stiffness share, s.
        beta_s: f64,
    },
    /// The same damping ratio for every mode, in the rotating frame.
    ModalRatio(f64),
}

/// Geometry, material and speed of the disk.
#[derive(Clone, Debug, PartialEq)]
pub struct DiskParameters {
    /// Clamp radius, m.
    pub inner_radius_m: f64,
    /// Outer radius, m.
    pub outer_radius_m: f64,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density, kg/m3.
    pub density_kg_per_m3: f64,
    /// Spin, rad/s, positive in the sense of growing theta.
    pub spin_rad_per_s: f64,
    /// Damping that turns with the disk.
    pub damping: DiskDamping,
    /// Damping fixed in space (air), force per mass and velocity w_t, 1/s; 0 = none.
    pub space_fixed_damping_per_s: f64,
    /// Hub on its bearing; `None`: the clamp is part of the base.
    pub hub: Option<HubParameters>,
}

/// Numerical resolution of the disk.
#[derive(Clone, Debug, PartialEq)]
pub struct DiskResolution {
    /// Largest nodal-diameter number N.
    pub n_harmonics: usize,
    /// Modes above this frequency (rotating frame) are left out for n >= 1, Hz.
    pub cut_hz: f64,
    /// Radial finite elements.
    pub n_elements: usize,
    /// Adds, per harmonic, the residual flexibility of the ramp point as one more Ritz vector.
    pub static_correction: bool,
}

/// Pose of the disk's surface under the slider's centre, in the slider's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DiskPose {
    /// Displacement along z, m.
    pub displacement_m: f64,
    /// Slope in the sense of positive slider pitch (-dw/dx), rad.
    pub pitch_rad: f64,
    /// Slope in the sense of positive slider roll (dw/dy), rad.
    pub roll_rad: f64,
}

impl DiskPose {
    /// Sum of two small poses.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            displacement_m: self.displacement_m + other.displacement_m,
            pitch_rad: self.pitch_rad + other.pitch_rad,
            roll_rad: self.roll_rad + other.roll_rad,
        }
    }

    /// The pose times a number.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        Self {
            displacement_m: factor * self.displacement_m,
            pitch_rad: factor * self.pitch_rad,
            roll_rad: factor * self.roll_rad,
        }
    }
}

/// The disk's motion under the slider as the head sees it. Time 0 is the onset of the pulse.
pub trait DiskMotion: Sync {
    /// Pose at `time_s`.
    fn pose(&self, time_s: f64) -> DiskPose;
    /// Time derivative of the pose at `time_s` (from the right at a jump).
    fn pose_rate(&self, time_s: f64) -> DiskPose;
    /// Sorted instants at which a step must end (jumps and kinks of the motion), s.
    fn events_s(&self) -> &[f64];
    /// Motion of the suspension's pivot that its load does not tell, and its rate (from the right at a jump):
    /// the head's masses are told by a load per mass what shakes them, but a jump of the pivot's velocity is
    /// none. Poses are not over this motion.
    fn pivot(&self, _time_s: f64) -> [f64; 2] {
        [0.0; 2]
    }
}
