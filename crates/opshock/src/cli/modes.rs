//! `opshock modes`: prints natural frequencies of disk, ramp, suspension and the slider on its film, and responses.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use super::mode_shapes;
use super::responses::responses;
use super::selection::{PointArgs, unshaken_point};
use super::steady::air_bearing_modes;
use super::steady_state::ModeJson;
use super::study_file;
use anyhow::Context as _;
use clap::Args;
use opshock_solver::scene::Scene;
use opshock_solver::structure::{StructureModes, modes};
use opshock_solver::suspension::ReducedSuspension;
use opshock_study::study::Study;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Print natural frequencies of disk, ramp, suspension and slider
#[derive(Args, Debug)]
pub struct ModesArgs {
    /// Study file
    study: PathBuf,
    #[command(flatten)]
    point: PointArgs,
    /// Also print what every point answers to the shock, or to a force at disk.ramp, disk.slider, ramp.top,
    /// ramp.bottom, slider or dimple
    #[arg(long, value_name = "SOURCE", requires = "hz")]
    response: Option<String>,
    /// Frequencies of the responses, Hz
    #[arg(
        long,
        value_name = "HZ,...",
        value_delimiter = ',',
        requires = "response"
    )]
    hz: Vec<f64>,
    /// Write the shapes of the modes into a folder: vtu grids for ParaView, plots as SVG, PNG and CSV
    #[arg(long, value_name = "DIR")]
    shapes: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &ModesArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    // What cannot be written is said before anything is computed.
    let folder = arguments.shapes.as_deref();
    folder.map_or(Ok(()), |folder| {
        mode_shapes::check_folder("--shapes", folder)
    })?;
    let study = study_file::read(&arguments.study, global, console)?;
    let scene = unshaken_point(&study, &arguments.point)?.scene;
    let structure = modes(&scene.disk, &scene.disk_resolution, &scene.ramp)
        .context("no modes of disk and ramp")?;
    let kept = scene.head_resolution.suspension_modes;
    let suspension =
        ReducedSuspension::build(&scene.suspension, kept).context("no modes of the suspension")?;
    let head = air_bearing_modes(&study, &scene)?;
    let asked = arguments.response.as_deref();
    let responses = asked
        .map(|source| responses(&study, &scene, source, &arguments.hz))
        .transpose()?;
    if let Some(folder) = folder {
        let written = mode_shapes::write(folder, &study, &scene, &head)?;
        console.note(&format!(
            "wrote {} files into {}",
            written.len(),
            folder.display()
        ));
        if !scene.suspension.modes.is_empty() {
            console.note("no shapes of the suspension: its modes describe its dimple alone");
        }
    }
    if console.json {
        let mut all = as_json(&structure, &suspension, &head);
        if let Some(responses) = responses {
            all["response"] = responses.as_json();
        }
        console.result_json(&all)?;
    } else {
        let mut all = as_text(&structure, &suspension, &head);
        all.extend(responses.map(|responses| responses.as_text()));
        console.result(&all)?;
    }
    Ok(Exit::Complete)
}

/// What `--json` prints of a scene.
///
/// # Errors
///
/// No modes, or no steady flight.
pub(super) fn json_of(study: &Study, scene: &Scene) -> Result<Value, Failure> {
    let structure = modes(&scene.disk, &scene.disk_resolution, &scene.ramp)
        .context("no modes of disk and ramp")?;
    let kept = scene.head_resolution.suspension_modes;
    let suspension =
        ReducedSuspension::build(&scene.suspension, kept).context("no modes of the suspension")?;
    let head = air_bearing_modes(study, scene)?;
    Ok(as_json(&structure, &suspension, &head))
}

fn as_json(structure: &StructureModes, suspension: &ReducedSuspension, head: &[ModeJson]) -> Value {
    let disk: Vec<Value> = structure
        .disk
        .iter()
        .map(|mode| {
            json!({
                "nodal_diameters": mode.nodal_diameters,
                "nodal_circles": mode.nodal_circles,
                "rotating_frame_hz": mode.rotating_frame_hz,
                "forward_hz": mode.forward_hz,
                "backward_hz": mode.backward_hz,
                "damping_ratio": mode.damping_ratio,
            })
        })
        .collect();
    let ramp: Vec<Value> = structure
        .ramp
        .iter()
        .map(|mode| {
            json!({
                "arm": mode.arm,
                "frequency_hz": mode.frequency_hz,
                "mass_kg": mode.mass_kg,
                "participation": mode.participation,
                "damping_ratio": mode.damping_ratio,
            })
        })
        .collect();
    let coupled = structure.coupled_ramp.iter().map(|mode| {
        json!({
            "arm": "both",
            "frequency_hz": mode.frequency_hz,
            "top_shape_per_sqrt_kg": mode.shape_per_sqrt_kg[0],
            "bottom_shape_per_sqrt_kg": mode.shape_per_sqrt_kg[1],
            "participation_sqrt_kg": mode.participation_sqrt_kg,
            "damping_ratio": mode.damping_ratio,
        })
    });
    let ramp: Vec<Value> = ramp.into_iter().chain(coupled).collect();
    let hub: Vec<Value> = structure
        .hub
        .iter()
        .map(|mode| {
            json!({
                "motion": mode.motion,
                "frequency_hz": mode.frequency_hz,
                "damping_ratio": mode.damping_ratio,
            })
        })
        .collect();
    json!({
        "disk": disk,
        "hub": hub,
        "ramp": ramp,
        "suspension": {
            "mass_kg": suspension.mass_kg,
            "dimple_stiffness_n_per_m": suspension.dimple_stiffness_n_per_m(),
            "roll_stiffness_n_m_per_rad": suspension.roll_stiffness_n_m_per_rad(),
            "effective_shock_mass_kg": suspension.effective_shock_mass_kg(),
            "bending_free_hz": suspension.bending.free_hz,
            "bending_pinned_hz": suspension.bending.pinned_hz,
            "torsion_free_hz": suspension.torsion.free_hz,
            "torsion_pinned_hz": suspension.torsion.pinned_hz,
        },
        "head": head,
    })
}

fn as_text(
    structure: &StructureModes,
    suspension: &ReducedSuspension,
    head: &[ModeJson],
) -> String {
    let mut text = String::from(
        "disk\n  circles  diameters  rotating (Hz)  forward (Hz)  backward (Hz)  damping ratio\n",
    );
    for mode in &structure.disk {
        let _ = writeln!(
            text,
            "  {:>7}  {:>9}  {:>13.2}  {:>12.2}  {:>13.2}  {:>13.5}",
            mode.nodal_circles,
            mode.nodal_diameters,
            mode.rotating_frame_hz,
            mode.forward_hz,
            mode.backward_hz,
            mode.damping_ratio
        );
    }
    if !structure.hub.is_empty() {
        text.push_str(
            "disk with hub, 0 and 1 nodal diameters\n  motion    fixed frame (Hz)  damping ratio\n",
        );
    }
    for mode in &structure.hub {
        let _ = writeln!(
            text,
            "  {:<8}  {:>16.2}  {:>13.5}",
            mode.motion, mode.frequency_hz, mode.damping_ratio
        );
    }
    if !structure.ramp.is_empty() {
        text.push_str("ramp\n  arm     frequency (Hz)  mass (mg)  participation  damping ratio\n");
    }
    for mode in &structure.ramp {
        let _ = writeln!(
            text,
            "  {:<6}  {:>14.2}  {:>9.3}  {:>13.3}  {:>13.5}",
            mode.arm,
            mode.frequency_hz,
            1e6 * mode.mass_kg,
            mode.participation,
            mode.damping_ratio
        );
    }
    if !structure.coupled_ramp.is_empty() {
        text.push_str(
            "ramp, both arms one body (modes of unit mass)\n  frequency (Hz)  top (1/sqrt kg)  bottom (1/sqrt kg)  participation (sqrt mg)  damping ratio\n",
        );
    }
    for mode in &structure.coupled_ramp {
        let [top, bottom] = mode.shape_per_sqrt_kg;
        let _ = writeln!(
            text,
            "  {:>14.2}  {top:>15.2}  {bottom:>18.2}  {:>23.4}  {:>13.5}",
            mode.frequency_hz,
            1e3 * mode.participation_sqrt_kg,
            mode.damping_ratio
        );
    }
    let list = |frequencies: &[f64]| {
        let words: Vec<String> = frequencies.iter().map(|hz| format!("{hz:.1}")).collect();
        words.join(", ")
    };
    let _ = write!(
        text,
        "suspension\n  mass {:.3} mg, at the dimple: stiffness {:.3} N/m, roll {:.4e} N m/rad, effective shock mass {:.3} mg\n\
         \x20 bending, dimple free    {} Hz\n\
         \x20 bending, dimple pinned  {} Hz\n\
         \x20 torsion, dimple free    {} Hz\n\
         \x20 torsion, dimple pinned  {} Hz\n",
        1e6 * suspension.mass_kg,
        suspension.dimple_stiffness_n_per_m(),
        suspension.roll_stiffness_n_m_per_rad(),
        1e6 * suspension.effective_shock_mass_kg(),
        list(&suspension.bending.free_hz),
        list(&suspension.bending.pinned_hz),
        list(&suspension.torsion.free_hz),
        list(&suspension.torsion.pinned_hz),
    );
    text.push_str("head: slider free on its film\n  frequency (kHz)  damping ratio\n");
    for mode in head {
        let _ = writeln!(
            text,
            "  {:>15.2}  {:>13.4}",
            1e-3 * mode.frequency_hz,
            mode.damping_ratio
        );
    }
    text
}
