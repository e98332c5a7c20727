//! Default scene: one plausible 2.5-inch drive.
//!
//! Disk, place and clearance of the ramp are sample data of the CMLAir 8.01 user manual (Mardan and Bogy, 2011). Ramp
//! arms, suspension and air-bearing surface are opshock's own designs. Studies have the same values as defaults.

use super::description::Scene;
use super::preset::{Preset, resolutions};
use crate::air_bearing::{FlowModel, GapForces};
use crate::disk::{DiskDamping, DiskParameters};
use crate::gas::{self, GasParameters};
use crate::quantity::{kg_from_mg, m_from_mm, n_from_gf, rad_from_deg, rad_per_s_from_rpm};
use crate::ramp::{ArmMode, Arms, CONTACT_DAMPING_RATIO, CONTACT_FREQUENCY_HZ, RampParameters};
use crate::shock::{Pulse, PulseShape};
use crate::slider::{Rail, RailOutline, SliderParameters, SurfaceParameters};
use crate::structure::Window;
use crate::suspension::{
    ContactLaw, Flange, Flexure, Gimbal, Hinge, LoadBeam, SuspensionParameters,
};

impl Scene {
    /// A 2.5-inch drive at 5400 rpm with deformable ramp arms 100 um above and below the disk, under a half-sine of 1
    /// ms, at the resolution for a critical shock with an uncertainty of 1 %.
    ///
    /// ```
    /// use opshock_solver::scene::Scene;
    ///
    /// let mut scene = Scene::default_drive();
    /// scene.pulse.width_s = 2e-3;
    /// scene.ramp.clearance_top_m = 120e-6;
    /// assert_eq!(scene.ramp.clearance_bottom_m, 100e-6);
    /// ```
    pub fn default_drive() -> Self {
        let resolutions = resolutions(Preset::Standard);
        Self {
            pulse: Pulse {
                shape: PulseShape::HalfSine,
                width_s: 1e-3,
            },
            oblique: None,
            base: Vec::new(),
            window: Window::Fixed { length_s: 5e-3 },
            disk: disk(),
            run_out: Vec::new(),
            ramp: ramp(),
            slider: slider(),
            suspension: suspension(),
            gas: GasParameters {
                pressure_pa: gas::SEA_LEVEL_PRESSURE_PA,
                viscosity_pa_s: gas::REFERENCE_VISCOSITY_PA_S,
                mean_free_path_m: gas::REFERENCE_MEAN_FREE_PATH_M,
            },
            flow: FlowModel::FukuiKaneko,
            gap_forces: GapForces::default(),
            fail_below_m: 0.0,
            damage: None,
            disk_resolution: resolutions.disk,
            structure_resolution: resolutions.structure,
            film_resolution: resolutions.film,
            head_resolution: resolutions.head,
            not_refined: Vec::new(),
        }
    }
}

fn disk() -> DiskParameters {
    DiskParameters {
        inner_radius_m: 10.01e-3,
        outer_radius_m: 32.5e-3,
        thickness_m: 0.635e-3,
        youngs_modulus_pa: 75e9,
        poisson: 0.3,
        density_kg_per_m3: 2710.0,
        spin_rad_per_s: rad_per_s_from_rpm(5400.0),
        damping: DiskDamping::Rayleigh {
            alpha_per_s: 25.0,
            beta_s: 1e-7,
        },
        space_fixed_damping_per_s: 0.0,
        hub: None,
    }
}

fn ramp() -> RampParameters {
    let arm: Vec<ArmMode> = [(888.0, 57.9e-6, 0.199), (17_500.0, 35.1e-6, 0.789)]
        .map(|(frequency_hz, mass_kg, participation)| ArmMode {
            frequency_hz,
            mass_kg,
            participation,
            damping_ratio: 0.02,
        })
        .to_vec();
    RampParameters {
        model: Arms {
            top: arm.clone(),
            bottom: arm,
        }
        .into(),
        clearance_top_m: 100e-6,
        clearance_bottom_m: 100e-6,
        radius_m: 32.15e-3,
        angle_rad: 0.0,
        restitution: 0.0,
        contact_stiffness_n_per_m: None,
        contact_frequency_hz: CONTACT_FREQUENCY_HZ,
        contact_damping_ratio: CONTACT_DAMPING_RATIO,
    }
}

fn slider() -> SliderParameters {
    SliderParameters {
        radius_m: 21e-3,
        angle_rad: rad_from_deg(7.0),
        skew_rad: 0.0,
        length_m: 0.85e-3,
        width_m: 0.7e-3,
        height_m: 0.23e-3,
        density_kg_per_m3: 4300.0,
        surface: surface(),
    }
}

/// A shallow step and a pad in front, a strip with a pad on both sides, a step and a pad behind.
fn surface() -> SurfaceParameters {
    const STEP_M: f64 = 0.25e-6;
    let rail = |x_m, y_m, recess_m| Rail {
        outline: RailOutline::Rectangle { x_m, y_m },
        recess_m,
    };
    SurfaceParameters {
        base_recess_m: 1.5e-6,
        crown_m: 15e-9,
        camber_m: 2e-9,
        rails: vec![
            rail([20e-6, 170e-6], [30e-6, 670e-6], STEP_M),
            rail([170e-6, 240e-6], [50e-6, 650e-6], 0.0),
            rail([240e-6, 720e-6], [30e-6, 100e-6], STEP_M),
            rail([640e-6, 720e-6], [30e-6, 100e-6], 0.0),
            rail([240e-6, 720e-6], [600e-6, 670e-6], STEP_M),
            rail([640e-6, 720e-6], [600e-6, 670e-6], 0.0),
            rail([600e-6, 710e-6], [210e-6, 490e-6], STEP_M),
            rail([710e-6, 840e-6], [250e-6, 450e-6], 0.0),
        ],
        ..SurfaceParameters::default()
    }
}

fn suspension() -> SuspensionParameters {
    SuspensionParameters {
        gram_load_n: n_from_gf(2.2),
        hinge: Hinge {
            length_m: 1.3e-3,
            width_m: 1.8e-3,
            thickness_m: 40e-6,
        },
        load_beam: LoadBeam {
            dimple_m: 10.5e-3,
            end_m: m_from_mm(11.8),
            web_m: 28e-6,
            width_root_m: 3.8e-3,
            width_dimple_m: 1.2e-3,
            tab_width_m: 0.6e-3,
        },
        flange: Flange {
            height_m: 140e-6,
            from_m: 1.9e-3,
            to_m: 9.6e-3,
        },
        flexure: Flexure {
            mass_kg: kg_from_mg(0.9),
            from_m: 1e-3,
        },
        youngs_modulus_pa: 193e9,
        shear_modulus_pa: 74e9,
        density_kg_per_m3: 7900.0,
        damping_ratio: 0.02,
        rayleigh: None,
        gimbal: Gimbal {
            vertical_n_per_m: 15.0,
            pitch_n_m_per_rad: 6e-5,
            roll_n_m_per_rad: 2.5e-5,
            dimple_preload_n: 0.0,
        },
        dimple: ContactLaw {
            stiffness_n_per_m: 5e5,
            damping_ratio: 0.05,
        },
        limiters: Vec::new(),
        lift_tab: None,
        modes: Vec::new(),
    }
}
