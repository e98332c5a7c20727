//! `opshock import ramp`: reduces mass and stiffness matrices to the arms of a deformable ramp.
//!
//! The solid crate reduces the matrices to the contact point: all modes below the cut with the point
//! fixed, its constraint mode, and the static response of the modes above the cut. Each mode
//! q'' + ω² q = φ λ + p a of the reduced arm is an oscillator of a study's arm in x = φ q: its mass is
//! 1/φ², its participation φ p.
//!
//! With the Gmsh mesh that the matrices were made on, both contacts are patches of one body, and its
//! modes are those of both arms: a node of the mesh is the node of the same number in the matrices.

use super::matrices::{refuse_unaccepted, units};
use super::written::{refused, shown, write_new};
use crate::cli::console::Console;
use crate::cli::exit::Exit;
use crate::cli::failure::Failure;
use crate::cli::global::GlobalArgs;
use anyhow::Context as _;
use clap::Args;
use opshock_import::gmsh;
use opshock_import::matrix::check;
use opshock_import::matrix::dof::Direction;
use opshock_import::matrix::files::{freedoms, matrix};
use opshock_import::matrix::system::System;
use opshock_import::matrix::units::Units;
use opshock_import::text::Source;
use opshock_import::{Fault, Faults};
use opshock_solid::element::Shape;
use opshock_solid::mesh::Mesh;
use opshock_solid::reduction::reduce;
use opshock_study::study::matrices::{load, solid};
use serde::Serialize;
use serde_json::json;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Shares of flexibility and of motion with the base below which a mode is left out.
const NEGLIGIBLE: f64 = 1e-9;

/// Turn mass and stiffness matrices into the arms of a deformable ramp
///
/// Writes ramp.toml, whose section goes into a study. Files are those of `import matrices`.
#[derive(Args, Debug)]
pub struct RampArgs {
    /// Mass matrix
    #[arg(long, value_name = "FILE")]
    mass: PathBuf,
    /// Stiffness matrix, bolted to the base
    #[arg(long, value_name = "FILE")]
    stiffness: PathBuf,
    /// Freedoms of the rows, a line node.direction each, as CalculiX writes them
    #[arg(long, value_name = "FILE", required_unless_present = "places")]
    dof: Option<PathBuf>,
    /// Places and kinds of the rows, a line "x y z type" each, mm
    #[arg(long, value_name = "FILE", conflicts_with = "dof")]
    places: Option<PathBuf>,
    /// Units: si (N, m, kg), mm_mn (mN, mm, kg) or mm_n (N, mm, t)
    #[arg(long, value_name = "UNITS", value_parser = units)]
    units: Units,
    /// Freedom of the top arm that meets the disk, along the shock, as 12.3
    #[arg(long, value_name = "FREEDOM", required_unless_present = "mesh")]
    contact: Option<String>,
    /// That of the bottom arm, where it differs; the arms move independently
    #[arg(long, value_name = "FREEDOM", requires = "contact")]
    bottom_contact: Option<String>,
    /// Gmsh mesh with physical surfaces top and bottom: both contacts of one body, along z
    #[arg(
        long,
        value_name = "FILE",
        requires = "dof",
        conflicts_with = "contact"
    )]
    mesh: Option<PathBuf>,
    /// Modes are kept up to this frequency
    #[arg(long, value_name = "KHZ", default_value = "60", value_parser = kilohertz)]
    cut_khz: f64,
    /// Folder for ramp.toml
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

fn kilohertz(text: &str) -> Result<f64, String> {
    let value = text.trim().parse::<f64>().ok();
    value
        .filter(|value| (0.1..=1e4).contains(value))
        .ok_or_else(|| "must be a frequency from 0.1 to 10000 kHz".to_owned())
}

/// An oscillator of an arm, as a study has it.
#[derive(Clone, Copy, Debug, Serialize)]
struct Mode {
    frequency_hz: f64,
    mass_mg: f64,
    participation: f64,
}

/// Runs the command.
pub fn run(arguments: &RampArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let (system, found) = read(arguments).map_err(refused)?;
    refuse_unaccepted(&found, global)?;
    let Some(contact) = &arguments.contact else {
        return one_body(arguments, &system, console);
    };
    let top = arm(&system, contact, "--contact", arguments.cut_khz)?;
    let bottom = match &arguments.bottom_contact {
        Some(name) => Some(arm(&system, name, "--bottom-contact", arguments.cut_khz)?),
        None => None,
    };
    let mut text = String::from("[ramp.deformable]\n");
    let _ = writeln!(text, "modes = {}", list(&top));
    if let Some(bottom) = &bottom {
        let _ = writeln!(text, "bottom_modes = {}", list(bottom));
    }
    let paths = write_new(&arguments.out, &[("ramp.toml", &text)])?;
    if console.json {
        console
            .result_json(&json!({"modes": top, "bottom_modes": bottom, "files": shown(&paths)}))?;
    } else {
        console.result(&format!(
            "{} modes: {}\n",
            top.len(),
            shown(&paths).join(", ")
        ))?;
    }
    Ok(Exit::Complete)
}

/// Both arms as one body, by the contacts of the mesh.
fn one_body(arguments: &RampArgs, system: &System, console: &Console) -> Result<Exit, Failure> {
    let path = arguments.mesh.as_deref().unwrap_or(Path::new(""));
    let points = contact_columns(system, path).map_err(refused)?;
    let modes = reduce(
        &solid(system, Z, &load(system, Z)),
        points,
        1e3 * arguments.cut_khz,
    )
    .and_then(|reduced| reduced.point_modes())
    .context("the ramp cannot be reduced to its contacts")?;
    let mut text = String::new();
    for mode in &modes {
        let _ = writeln!(
            text,
            "[[ramp.deformable.coupled_modes]]\nfrequency_hz = {:?}\ntop_per_sqrt_kg = {:?}\n\
             bottom_per_sqrt_kg = {:?}\nparticipation_sqrt_kg = {:?}\n",
            mode.frequency_hz, mode.shape[0], mode.shape[1], mode.participation
        );
    }
    let paths = write_new(&arguments.out, &[("ramp.toml", &text)])?;
    if console.json {
        let modes = modes.iter().map(|mode| {
            json!({
                "frequency_hz": mode.frequency_hz,
                "top_per_sqrt_kg": mode.shape[0],
                "bottom_per_sqrt_kg": mode.shape[1],
                "participation_sqrt_kg": mode.participation,
            })
        });
        let modes: Vec<_> = modes.collect();
        console.result_json(&json!({"coupled_modes": modes, "files": shown(&paths)}))?;
    } else {
        let reported = format!("{} modes: {}\n", modes.len(), shown(&paths).join(", "));
        console.result(&reported)?;
    }
    Ok(Exit::Complete)
}

/// Direction of the disk's axis.
const Z: u8 = 2;

/// Columns that read the mean displacement along z of the surfaces top and bottom.
fn contact_columns(system: &System, path: &Path) -> Result<Vec<Vec<f64>>, Faults> {
    let file = gmsh::read(&Source::read(path)?)?;
    let mesh = Mesh {
        shape: match file.solid {
            gmsh::Solid::Tetrahedron => Shape::Tetrahedron10,
            gmsh::Solid::Hexahedron => Shape::Hexahedron20,
        },
        nodes_m: file.nodes.clone(),
        connectivity: file.connectivity.clone(),
    };
    let mut rows = HashMap::new();
    for row in 0..system.n() {
        let freedom = system.freedoms.get(row);
        if let Some(freedom) = freedom.filter(|f| f.direction == Direction::Along(Z)) {
            rows.insert(freedom.node, row);
        }
    }
    let column = |name: &str| -> Result<Vec<f64>, Faults> {
        let patch = mesh.face_weights(&file.surface(name)?);
        let mut column = vec![0.0; system.n()];
        for (node, weight) in patch.nodes {
            let number = file.node_tags[node];
            let Some(&row) = rows.get(&(number as u64)) else {
                let message = "the node of a contact is none of the matrices";
                let fault = Fault::of("E169", &system.freedoms.file, message).what(name);
                return Err(fault
                    .value(format!("{number}.3"))
                    .allowed("nodes that move, of the same numbers as in the mesh")
                    .into());
            };
            column[row] += weight / patch.area_m2;
        }
        Ok(column)
    };
    Ok(vec![column("top")?, column("bottom")?])
}

/// Modes as TOML.
fn list(modes: &[Mode]) -> String {
    let tables = modes.iter().map(|mode| {
        format!(
            "{{ frequency_hz = {}, mass_mg = {}, participation = {} }}",
            mode.frequency_hz, mode.mass_mg, mode.participation
        )
    });
    format!("[\n  {},\n]", tables.collect::<Vec<_>>().join(",\n  "))
}

fn read(arguments: &RampArgs) -> Result<(System, check::Found), Faults> {
    let freedoms = freedoms(arguments.dof.as_deref(), arguments.places.as_deref())?;
    let stiffness = matrix(&arguments.stiffness, freedoms.as_ref(), true)?;
    let mass = matrix(&arguments.mass, freedoms.as_ref(), true)?;
    let system = System::of(mass, stiffness, None, freedoms, arguments.units)?;
    check::check(system, false)
}

/// Oscillators of the arm whose contact point is a freedom.
fn arm(system: &System, name: &str, option: &str, cut_khz: f64) -> Result<Vec<Mode>, Failure> {
    let row = system.freedoms.find(name, option).map_err(refused)?;
    let along = match system.freedoms.get(row).map(|freedom| freedom.direction) {
        Some(Direction::Along(k)) => k,
        _ => {
            let message = "the contact turns and does not move along a direction";
            let fault = Fault::of("E169", &system.freedoms.file, message).what(option);
            return Err(refused(
                fault.value(name).allowed("node.1, node.2 or node.3").into(),
            ));
        }
    };
    let solid = solid(system, along, &load(system, along));
    let mut point = vec![0.0; system.n()];
    point[row] = 1.0;
    let reduced = reduce(&solid, vec![point], 1e3 * cut_khz)
        .and_then(|reduced| reduced.point_modes())
        .with_context(|| format!("the ramp cannot be reduced to {name}"))?;
    let omega_squared = |hertz: f64| (std::f64::consts::TAU * hertz).powi(2);
    // Static flexibility and static motion with the base that a mode has.
    let shares: Vec<[f64; 2]> = reduced
        .iter()
        .map(|mode| {
            let flexibility = mode.shape[0] / omega_squared(mode.frequency_hz);
            [
                mode.shape[0] * flexibility,
                (mode.participation * flexibility).abs(),
            ]
        })
        .collect();
    let whole = [0, 1].map(|k| shares.iter().map(|share| share[k]).sum::<f64>());
    if whole[0].is_nan() || whole[0] <= 0.0 {
        let fault = Fault::of(
            "E170",
            &system.stiffness.file,
            "no mode moves at the contact point",
        );
        let fault = fault
            .what(name)
            .hint("a ramp that cannot move there is a rigid one");
        return Err(refused(fault.into()));
    }
    let kept = reduced
        .iter()
        .zip(&shares)
        .filter(|(_, share)| (0..2).any(|k| share[k] > NEGLIGIBLE * whole[k]));
    Ok(kept
        .map(|(mode, _)| Mode {
            frequency_hz: mode.frequency_hz,
            mass_mg: 1e6 / mode.shape[0].powi(2),
            participation: mode.participation * mode.shape[0],
        })
        .collect())
}
