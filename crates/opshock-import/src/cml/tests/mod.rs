//! Round trips, and faults of damaged values; this file holds the data that the tests write and read.

mod dynamic_runs;
mod runs;
mod studies;
mod surfaces;

use super::dynamic::{Contents, Disk, DynamicFile, Gas, Matrices, Ramp, Shape, Shock};
use super::rail::{Rail, RailFile, Recess, Wall};
use super::run::{RunFile, Slip};
use crate::fault::Faults;
use crate::text::Source;

fn source(name: &str, text: &str) -> Source {
    Source::of(name, text.as_bytes().to_vec()).unwrap()
}

fn codes(faults: &Faults) -> Vec<&str> {
    faults.listed.iter().map(|fault| fault.code).collect()
}

/// Two rails and a wall profile on a pico slider.
fn surface() -> RailFile {
    let rail = |corners: [[f64; 2]; 4], recess, line| Rail {
        corners_m: corners.to_vec(),
        walls: vec![0, 1, 0, 1],
        recess,
        line,
    };
    RailFile {
        version: "8.0".to_owned(),
        length_m: 1.25e-3,
        width_m: 1.0e-3,
        thickness_m: 0.3e-3,
        rails: vec![
            rail(
                [
                    [0.0, 0.1e-3],
                    [0.3e-3, 0.1e-3],
                    [0.3e-3, 0.9e-3],
                    [0.0, 0.9e-3],
                ],
                Recess::Step(2.5e-7),
                5,
            ),
            rail(
                [
                    [0.3e-3, 0.1e-3],
                    [1.1e-3, 0.1e-3],
                    [1.1e-3, 0.3e-3],
                    [0.3e-3, 0.3e-3],
                ],
                Recess::Ramp([0.0, 1e-8, 1e-8]),
                11,
            ),
        ],
        walls: vec![Wall {
            distance_m: vec![-1e-6, 0.0, 3e-6],
            recess_m: vec![0.0, 2e-7, 1.5e-6],
        }],
        taper_length_m: 0.1e-3,
        taper_angle_rad: 0.01,
        base_recess_m: 2.5e-6,
        crown_m: 12.7e-9,
        camber_m: -3.1e-9,
        twist_m: 0.0,
        points_m: vec![[1e-4, 2e-4], [3e-4, 5e-4]],
    }
}

fn flights() -> RunFile {
    RunFile {
        version: "7.0".to_owned(),
        radii_m: vec![17.9e-3, 22.215e-3],
        skews_deg: vec![-6.2, 0.943],
        speeds_rpm: vec![5400.0],
        altitudes_m: vec![0.0],
        pressure_pa: 101_350.0,
        mean_free_path_m: 63.5e-9,
        viscosity_pa_s: 1.806e-5,
        load_kgf: 2.5e-3,
        load_point_m: [0.0; 2],
        static_angles_rad: [0.0; 2],
        slip: Slip::FukuiKaneko,
        contact_model: 0,
        hamaker_j: 1.8e-19,
        repulsion_j_m6: 1.1e-76,
        potential_v: -0.5,
    }
}

/// The sample drive of the CMLAir 8.01 manual under a shock.
fn shaken() -> DynamicFile {
    DynamicFile {
        version: "8.0".to_owned(),
        length_m: 1.25e-3,
        width_per_length: 0.8,
        centre: [0.0; 3],
        load_kgf: 2.5e-3,
        load_point_m: [0.0; 2],
        halt: 0.0,
        speed_rpm: 5400.0,
        step_s: 1e-7,
        end_s: 3e-3,
        radius_m: 22.215e-3,
        move_radii_m: [22.215e-3; 2],
        actuator: [0.0; 3],
        arm_m: 38e-3,
        skew_deg: 0.943,
        attitude: [15e-9, 150e-6, 0.0, 0.0, 0.0, 0.0],
        gas: Some(Gas {
            pressure_pa: 101_350.0,
            mean_free_path_m: 63.5e-9,
            viscosity_pa_s: 1.806e-5,
        }),
        shock: Some(Shock {
            shape: Shape::HalfSine,
            start_s: 0.5e-3,
            width_s: 1e-3,
            magnitude_g: -200.0,
            time_constant_s: 0.0,
        }),
        suspension: Contents::Suspension(Matrices {
            n_rows: 250,
            slider_row: 241,
        }),
        disk: Disk {
            radii_m: [10.01e-3, 32.5e-3],
            thickness_m: 0.635e-3,
            youngs_modulus_pa: 75e9,
            poisson: 0.3,
            density_kg_per_m3: 2710.0,
            alpha_per_s: 25.0,
            beta_s: 1e-7,
        },
        ramp: Ramp {
            distance_m: 35.6e-3,
            angle_deg: 15.91,
            clearance_m: 100e-6,
            sides: 2,
        },
    }
}
