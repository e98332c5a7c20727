//! Input of the disk model as plain data: geometry, material, speed, damping, numerical resolution.

use super::hub::HubParameters;

/// How the disk loses energy.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
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
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
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
    /// Damping that rotates with the disk.
    pub damping: DiskDamping,
    /// Damping fixed in space (air), force per mass and velocity w_t, 1/s; 0 = none.
    pub space_fixed_damping_per_s: f64,
    /// Hub on its bearing; `None`: the clamp is part of the base.
    pub hub: Option<HubParameters>,
}

/// Numerical resolution of the disk.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
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
