//! `opshock modes --shapes DIR`: writes the modes of every body as grids and drawings.

use super::failure::{Failure, Fault};
use super::steady_state::ModeJson;
use anyhow::Context as _;
use opshock_solver::disk::{DiskBasis, Harmonics};
use opshock_solver::ramp::ContactMode;
use opshock_solver::scene::Scene;
use opshock_solver::suspension::SuspensionShapes;
use opshock_study::report::mode_shapes::{
    ArmShape, DiskShape, DiskShapes, HeadShape, HeadShapes, ModeShapes, RampShapes,
    write_mode_shapes,
};
use opshock_study::study::Study;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// Circles of the drawn disk, clamp and rim included.
const CIRCLES: usize = 61;
/// Angles of the drawn disk, at least, and per nodal diameter.
const ANGLES: usize = 96;
const ANGLES_PER_DIAMETER: usize = 8;

/// Refuses a folder that cannot be one, before anything is computed.
///
/// # Errors
///
/// Something else has that name.
pub(super) fn check_folder(option: &str, folder: &Path) -> Result<(), Failure> {
    if folder.exists() && !folder.is_dir() {
        return Err(Failure::Usage(vec![Fault {
            key: Some(option.into()),
            value: Some(folder.display().to_string()),
            allowed: Some("a folder, or a name that nothing has".into()),
            ..Fault::new("usage", format!("{option}: there is a file of this name"))
        }]));
    }
    Ok(())
}

/// Computes and writes the shapes. Returns the files.
///
/// # Errors
///
/// A body without modes, a file that cannot be written.
pub(super) fn write(
    folder: &Path,
    study: &Study,
    scene: &Scene,
    head: &[ModeJson],
) -> Result<Vec<PathBuf>, Failure> {
    let shapes = ModeShapes {
        study: study.name.clone(),
        disk: disk(scene)?,
        ramp: ramp(study, scene)?,
        suspension: suspension(scene)?,
        head: HeadShapes {
            length_m: scene.slider.length_m,
            width_m: scene.slider.width_m,
            modes: head
                .iter()
                .map(|mode| HeadShape {
                    frequency_hz: mode.frequency_hz,
                    shape: mode.shape,
                })
                .collect(),
        },
    };
    Ok(write_mode_shapes(folder, &shapes)?)
}

fn disk(scene: &Scene) -> Result<DiskShapes, Failure> {
    let (disk, resolution) = (&scene.disk, &scene.disk_resolution);
    let (inner, outer) = (disk.inner_radius_m, disk.outer_radius_m);
    let share = |k: usize| k as f64 / (CIRCLES - 1) as f64;
    let radii_m: Vec<f64> = (0..CIRCLES)
        .map(|k| inner + (outer - inner) * share(k))
        .collect();
    let basis = DiskBasis::build(disk, resolution, &radii_m, None, Harmonics::All);
    let modes = basis.context("no modes of the disk")?.modes.into_iter();
    let mut modes: Vec<DiskShape> = modes
        .filter_map(|mode| {
            Some(DiskShape {
                nodal_diameters: mode.nodal_diameters,
                nodal_circles: mode.nodal_circles?,
                frequency_hz: mode.omega_rad_per_s / TAU,
                radial_per_sqrt_kg: upright(mode.shape.iter().map(|(value, _)| *value).collect()),
            })
        })
        .filter(|mode| mode.frequency_hz < resolution.cut_hz)
        .collect();
    modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let most = modes.iter().map(|mode| mode.nodal_diameters).max();
    let n_angles = ANGLES.max(ANGLES_PER_DIAMETER * most.unwrap_or(0));
    let angle = |k: usize| TAU * k as f64 / n_angles as f64;
    Ok(DiskShapes {
        radii_m,
        angles_rad: (0..n_angles).map(angle).collect(),
        modes,
    })
}

/// The shape with its sign, which is free, such that the rim rises.
fn upright(mut shape: Vec<f64>) -> Vec<f64> {
    if shape.last().is_some_and(|rim| *rim < 0.0) {
        shape.iter_mut().for_each(|value| *value = -*value);
    }
    shape
}

fn ramp(study: &Study, scene: &Scene) -> Result<Option<RampShapes>, Failure> {
    let contact_modes = scene.ramp.model.modes();
    if contact_modes.is_empty() {
        return Ok(None);
    }
    if let Some(solid) = study.ramp_solid()? {
        let modes = solid
            .mesh
            .shapes(&solid.material, solid.mount, solid.cut_hz)
            .context("no shapes of the ramp")?;
        return Ok(Some(RampShapes::Solid {
            mesh: Box::new(solid.mesh),
            modes,
        }));
    }
    let shape = |mode: &ContactMode| ArmShape {
        frequency_hz: mode.frequency_hz,
        contact_per_sqrt_kg: mode.shape_per_sqrt_kg(),
    };
    let mut modes: Vec<ArmShape> = contact_modes.iter().map(shape).collect();
    modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let half = 0.5 * scene.disk.thickness_m;
    Ok(Some(RampShapes::Contacts {
        radius_m: scene.ramp.radius_m,
        angle_rad: scene.ramp.angle_rad,
        rest_m: [
            half + scene.ramp.clearance_top_m,
            -half - scene.ramp.clearance_bottom_m,
        ],
        modes,
    }))
}

/// None for a suspension given by another program's modes: they give the motion of its dimple alone.
fn suspension(scene: &Scene) -> Result<Option<SuspensionShapes>, Failure> {
    if !scene.suspension.modes.is_empty() {
        return Ok(None);
    }
    let kept = scene.head_resolution.suspension_modes;
    let shapes = SuspensionShapes::build(&scene.suspension, kept);
    Ok(Some(shapes.context("no shapes of the suspension")?))
}
