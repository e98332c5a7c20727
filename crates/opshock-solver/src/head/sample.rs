//! A sample slider and suspension for the tests of this module.

use crate::slider::{SliderParameters, SurfaceParameters};
use crate::suspension::{
    ContactLaw, Flange, Flexure, Gimbal, Hinge, Limiter, LoadBeam, SuspensionParameters,
};

/// A slider of common size.
pub fn slider() -> SliderParameters {
    SliderParameters {
        radius_m: 21e-3,
        angle_rad: 0.0,
        skew_rad: 0.0,
        length_m: 0.85e-3,
        width_m: 0.70e-3,
        height_m: 0.23e-3,
        density_kg_per_m3: 4300.0,
        surface: SurfaceParameters::default(),
    }
}

/// Gimbals that pitch and roll freely: a straight load then moves z only.
pub fn suspension() -> SuspensionParameters {
    SuspensionParameters {
        gram_load_n: 20e-3,
        hinge: Hinge {
            length_m: 1.3e-3,
            width_m: 1.8e-3,
            thickness_m: 40e-6,
        },
        load_beam: LoadBeam {
            dimple_m: 10.5e-3,
            end_m: 11.8e-3,
            web_m: 28e-6,
            width_root_m: 3.8e-3,
            width_dimple_m: 1.2e-3,
            tab_width_m: 0.6e-3,
        },
        flange: Flange {
            height_m: 0.14e-3,
            from_m: 1.9e-3,
            to_m: 9.6e-3,
        },
        flexure: Flexure {
            mass_kg: 0.9e-6,
            from_m: 1.0e-3,
        },
        youngs_modulus_pa: 193e9,
        shear_modulus_pa: 74e9,
        density_kg_per_m3: 7900.0,
        damping_ratio: 0.02,
        rayleigh: None,
        gimbal: Gimbal {
            vertical_n_per_m: 15.0,
            pitch_n_m_per_rad: 1e-30,
            roll_n_m_per_rad: 1e-30,
            dimple_preload_n: 0.0,
        },
        dimple: law(5e5, 0.05),
        limiters: Vec::new(),
        lift_tab: None,
        modes: Vec::new(),
    }
}

/// A contact.
pub fn law(stiffness_n_per_m: f64, damping_ratio: f64) -> ContactLaw {
    ContactLaw {
        stiffness_n_per_m,
        damping_ratio,
    }
}

/// A limiter at (`along_m`, `across_m`).
pub fn limiter(gap_m: f64, along_m: f64, across_m: f64, contact: ContactLaw) -> Limiter {
    Limiter {
        gap_m,
        along_m,
        across_m,
        contact,
    }
}
