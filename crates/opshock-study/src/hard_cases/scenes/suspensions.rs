//! The two suspensions for which results are quoted.

use opshock_solver::quantity::GRAM_FORCE_N;
use opshock_solver::scene::Scene;
use opshock_solver::suspension::{Flange, Flexure, Hinge, LoadBeam, SuspensionParameters};

/// Suspension of the 2.5-inch default drive.
pub fn default_suspension() -> SuspensionParameters {
    let mut suspension = Scene::default_drive().suspension;
    // To the bit of the committed digests.
    suspension.load_beam.end_m = 11.8e-3;
    suspension.flange.height_m = 0.14e-3;
    suspension.flexure.mass_kg = 0.9e-6;
    suspension
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
