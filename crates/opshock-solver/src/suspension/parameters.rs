//! The suspension as plain data: geometry, material, gimbal, contacts.

use super::modes::SuspensionMode;

/// Geometry and material of the suspension; x is measured from the root of the hinge.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SuspensionParameters {
    /// Gram load at the slider's centre, N.
    pub gram_load_n: f64,
    /// Hinge length, width, thickness, m.
    pub hinge: Hinge,
    /// Load beam.
    pub load_beam: LoadBeam,
    /// Flanges along both sides of the load beam.
    pub flange: Flange,
    /// Flexure, as mass smeared evenly from `from_m` to the dimple.
    pub flexure: Flexure,
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Shear modulus, Pa.
    pub shear_modulus_pa: f64,
    /// Density, kg/m3.
    pub density_kg_per_m3: f64,
    /// Damping ratio of every mode.
    pub damping_ratio: f64,
    /// Damping in place of that ratio.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rayleigh: Option<RayleighDamping>,
    /// Gimbal between the dimple point and the slider.
    pub gimbal: Gimbal,
    /// Unilateral dimple contact.
    pub dimple: ContactLaw,
    /// Limiters between flexure and load beam; none: only the gimbal resists an open dimple.
    pub limiters: Vec<Limiter>,
    /// Lift tab under a stop; `None`: it moves freely.
    pub lift_tab: Option<LiftTab>,
    /// Modes that replace geometry and material; none: the geometry is used.
    pub modes: Vec<SuspensionMode>,
}

/// Rayleigh damping, C = α M + β K.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct RayleighDamping {
    /// α, 1/s.
    pub alpha_per_s: f64,
    /// β, s.
    pub beta_s: f64,
}

/// Hinge strip.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Hinge {
    /// Length, m.
    pub length_m: f64,
    /// Width, m.
    pub width_m: f64,
    /// Thickness, m.
    pub thickness_m: f64,
}

/// Load beam: tapers linearly from root to dimple, then a tab of constant width.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LoadBeam {
    /// Dimple, from the root of the hinge, m.
    pub dimple_m: f64,
    /// End of the tab, m.
    pub end_m: f64,
    /// Web thickness, m.
    pub web_m: f64,
    /// Width where the load beam meets the hinge, m.
    pub width_root_m: f64,
    /// Width at the dimple, m.
    pub width_dimple_m: f64,
    /// Width of the tab, m.
    pub tab_width_m: f64,
}

/// Side flanges.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Flange {
    /// Height, m.
    pub height_m: f64,
    /// Start, m.
    pub from_m: f64,
    /// End, m.
    pub to_m: f64,
}

/// Flexure mass.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Flexure {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Start of the smeared mass, m.
    pub from_m: f64,
}

impl SuspensionParameters {
    /// 2 ζ ω of a natural mode, 1/s, with its circular frequency ω, rad/s: α + β ω² of Rayleigh damping.
    pub fn decay_per_s(&self, omega: f64) -> f64 {
        match self.rayleigh {
            Some(rayleigh) => rayleigh.alpha_per_s + rayleigh.beta_s * omega * omega,
            None => 2.0 * self.damping_ratio * omega,
        }
    }

    /// Contact force of the dimple in steady flight, N.
    pub fn steady_dimple_force_n(&self) -> f64 {
        self.gram_load_n + self.gimbal.dimple_preload_n
    }
}

/// Gimbal stiffnesses and preload.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Gimbal {
    /// Vertical, N/m.
    pub vertical_n_per_m: f64,
    /// Pitch, N m/rad.
    pub pitch_n_m_per_rad: f64,
    /// Roll, N m/rad.
    pub roll_n_m_per_rad: f64,
    /// Force by which the bent gimbal presses slider and dimple together, N; nothing of it reaches the film.
    pub dimple_preload_n: f64,
}

/// Dimple, limiter or lift tab in contact: a spring that only pushes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct ContactLaw {
    /// Contact stiffness, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping ratio of the closed contact, on the slider's mass.
    pub damping_ratio: f64,
}

/// Hook of the flexure behind the load beam, which limits the opening of the dimple.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Limiter {
    /// Opening at which it closes, from the steady state, m.
    pub gap_m: f64,
    /// From the dimple towards the tip, m.
    pub along_m: f64,
    /// From the dimple outwards, as the slider's y, m.
    pub across_m: f64,
    /// Contact.
    pub contact: ContactLaw,
}

/// Tab at the end of the load beam under a stop that is fixed to the base, a ramp's or a limiter's.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LiftTab {
    /// Rise of the tab's end at which it closes, from the steady state, m.
    pub gap_m: f64,
    /// Contact.
    pub contact: ContactLaw,
}
