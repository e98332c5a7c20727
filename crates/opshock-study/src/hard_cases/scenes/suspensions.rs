//! The two suspensions that results are quoted for.

use opshock_solver::quantity::GRAM_FORCE_N;
use opshock_solver::suspension::{
    ContactLaw, Flange, Flexure, Gimbal, Hinge, LoadBeam, SuspensionParameters,
};

/// Suspension of the 2.5-inch default drive.
pub fn default_suspension() -> SuspensionParameters {
    SuspensionParameters {
        gram_load_n: 2.2 * GRAM_FORCE_N,
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
        gimbal: Gimbal {
            vertical_n_per_m: 15.0,
            pitch_n_m_per_rad: 6e-5,
            roll_n_m_per_rad: 2.5e-5,
        },
        limiters: Vec::new(),
        lift_tab: None,
        dimple: ContactLaw {
            stiffness_n_per_m: 5e5,
            damping_ratio: 0.05,
        },
        modes: Vec::new(),
    }
}

/// Suspension of the set retuned until the source paper's statements hold together.
pub fn paper_suspension() -> SuspensionParameters {
    SuspensionParameters {
        gram_load_n: 0.948 * GRAM_FORCE_N,
        hinge: Hinge {
            thickness_m: 47.2e-6,
            ..default_suspension().hinge
        },
        load_beam: LoadBeam {
            dimple_m: 8.13e-3,
            end_m: 9.71e-3,
            web_m: 26.9e-6,
            width_root_m: 3.36e-3,
            width_dimple_m: 1.14e-3,
            tab_width_m: 0.744e-3,
        },
        flange: Flange {
            height_m: 73.3e-6,
            from_m: 1.9e-3,
            to_m: 6.92e-3,
        },
        flexure: Flexure {
            mass_kg: 1.03e-6,
            from_m: 1.0e-3,
        },
        ..default_suspension()
    }
}
