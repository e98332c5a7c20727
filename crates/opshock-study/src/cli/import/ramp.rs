//! `opshock import ramp`: arms of a ramp from mass and stiffness matrices.
//!
//! The solid crate reduces the matrices to the contact point: all modes below the cut with the point
//! held still, its constraint mode, and what the modes above the cut answer statically. Each mode
//! q'' + ω² q = φ λ + p a of the reduced arm is an oscillator of a study's arm in x = φ q: its mass is
//! 1/φ², its participation φ p.

use super::matrices::{freedoms, matrix, refuse_unaccepted, units};
use super::{refused, shown, write_new};
use crate::cli::GlobalArgs;
use crate::cli::console::Console;
use crate::cli::exit::Exit;
use crate::cli::failure::Failure;
use anyhow::Context as _;
use clap::Args;
use opshock_import::matrix::check;
use opshock_import::matrix::dof::Direction;
use opshock_import::matrix::system::System;
use opshock_import::matrix::units::Units;
use opshock_import::{Fault, Faults};
use opshock_solid::assembly::SolidSystem;
use opshock_solid::reduction::reduce;
use opshock_solid::sparse::{SymmetricMatrix, SymmetricPattern};
use serde::Serialize;
use serde_json::json;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

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
    #[arg(long, value_name = "FREEDOM")]
    contact: String,
    /// That of the bottom arm, where it differs; the arms move independently
    #[arg(long, value_name = "FREEDOM")]
    bottom_contact: Option<String>,
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
    let top = arm(&system, &arguments.contact, "--contact", arguments.cut_khz)?;
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
    let freedoms = freedoms(arguments.dof.as_ref(), arguments.places.as_ref())?;
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
    let solid = solid(system, along);
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

/// The matrices as the solid crate has them; its z is the direction of the contact.
fn solid(system: &System, along: u8) -> SolidSystem {
    let n = system.n();
    let mut columns: Vec<Vec<usize>> = (0..n).map(|column| vec![column]).collect();
    for matrix in [&system.stiffness, &system.mass] {
        for entry in matrix.entries().filter(|entry| entry.row > entry.column) {
            columns[entry.column].push(entry.row);
        }
    }
    let mut starts = vec![0];
    for column in &mut columns {
        column.sort_unstable();
        column.dedup();
        starts.push(starts.last().copied().unwrap_or(0) + column.len());
    }
    let pattern = Arc::new(SymmetricPattern::new(starts, columns.concat()));
    let lower = |matrix: &opshock_import::matrix::Matrix| {
        let mut lower = SymmetricMatrix::zeros(Arc::clone(&pattern));
        for entry in matrix.entries().filter(|entry| entry.row >= entry.column) {
            lower.add(entry.row, entry.column, entry.value);
        }
        lower
    };
    // Of a unit motion of the base: M times 1 in every displacement of one direction.
    let load = |direction: u8| {
        let moves: Vec<f64> = (0..n)
            .map(|row| {
                let freedom = system.freedoms.get(row);
                let is = freedom.is_some_and(|f| f.direction == Direction::Along(direction));
                f64::from(u8::from(is))
            })
            .collect();
        let mut load = vec![0.0; n];
        system.mass.apply(&moves, &mut load);
        (
            load.iter().zip(&moves).map(|(l, m)| l * m).sum::<f64>(),
            load,
        )
    };
    let (total, along_z) = load(along);
    let others = [(along + 1) % 3, (along + 2) % 3].map(|direction| load(direction).1);
    let [x, y] = others;
    SolidSystem::of_matrices(
        lower(&system.stiffness),
        lower(&system.mass),
        [x, y, along_z],
        total,
    )
}
