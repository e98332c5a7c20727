//! `opshock import matrices`: checks mass and stiffness matrices and writes them in SI units.

use super::written::{refused, shown, write_new};
use crate::cli::console::Console;
use crate::cli::exit::Exit;
use crate::cli::failure::Failure;
use crate::cli::global::GlobalArgs;
use clap::Args;
use opshock_import::Faults;
use opshock_import::matrix::dof;
use opshock_import::matrix::files::{freedoms, matrix};
use opshock_import::matrix::system::System;
use opshock_import::matrix::units::Units;
use opshock_import::matrix::{check, market, modes};
use opshock_import::text::Source;
use opshock_study::study::{StudyError, StudyErrors};
use serde_json::json;
use std::path::PathBuf;

/// Check mass and stiffness matrices and write them in SI units
///
/// Files are Matrix Market (.mtx), CalculiX (.sti and .mas, with --dof), or rows of numbers.
#[derive(Args, Debug)]
pub struct MatricesArgs {
    /// Mass matrix
    #[arg(long, value_name = "FILE")]
    mass: PathBuf,
    /// Stiffness matrix
    #[arg(long, value_name = "FILE")]
    stiffness: PathBuf,
    /// Gyroscopic matrix
    #[arg(long, value_name = "FILE")]
    gyroscopic: Option<PathBuf>,
    /// Freedoms of the rows, a line node.direction each, as CalculiX writes them
    #[arg(long, value_name = "FILE")]
    dof: Option<PathBuf>,
    /// Places and kinds of the rows, a line "x y z type" each, mm
    #[arg(long, value_name = "FILE", conflicts_with = "dof")]
    places: Option<PathBuf>,
    /// Units: si (N, m, kg), mm_mn (mN, mm, kg) or mm_n (N, mm, t)
    #[arg(long, value_name = "UNITS", value_parser = units)]
    units: Units,
    /// The body is free: up to six motions without stiffness are right
    #[arg(long)]
    free: bool,
    /// A freedom that must exist and move, as 12.3, or a row where freedoms are not named
    #[arg(long, value_name = "FREEDOM")]
    contact: Vec<String>,
    /// Shapes of modes, a column each (.mtx or rows of numbers)
    #[arg(long, value_name = "FILE", requires = "frequencies")]
    modes: Option<PathBuf>,
    /// Frequencies of the modes, Hz
    #[arg(long, value_name = "FILE", requires = "modes")]
    frequencies: Option<PathBuf>,
    /// Give the modes unit mass
    #[arg(long, requires = "modes")]
    renormalise: bool,
    /// Folder for mass.mtx, stiffness.mtx and freedoms.dof in SI units; without it only checked
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn units(word: &str) -> Result<Units, String> {
    let found = Units::WORDS.iter().find(|(name, _)| *name == word);
    let words = Units::WORDS.map(|(name, _)| name).join(", ");
    found
        .map(|(_, units)| *units)
        .ok_or_else(|| format!("must be one of {words}"))
}

/// Runs the command.
pub fn run(
    arguments: &MatricesArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let (system, found) = read(arguments).map_err(refused)?;
    refuse_unaccepted(&found, global)?;
    let mut paths = Vec::new();
    if let Some(folder) = &arguments.out {
        let (mass, stiffness) = (
            market::write_symmetric(&system.mass),
            market::write_symmetric(&system.stiffness),
        );
        let names = dof::write(&system.freedoms);
        let mut files = vec![
            ("mass.mtx", mass.as_str()),
            ("stiffness.mtx", stiffness.as_str()),
        ];
        if system.freedoms.are_named() {
            files.push(("freedoms.dof", &names));
        }
        paths = write_new(folder, &files)?;
    }
    if console.json {
        console.result_json(&json!({
            "freedoms": system.n(),
            "entries": {"mass": system.mass.n_entries(), "stiffness": system.stiffness.n_entries()},
            "units": arguments.units.word(),
            "asymmetry": found.asymmetry,
            "total_mass_kg": found.total_mass_kg,
            "rigid_motions": found.n_rigid,
            "lowest_hz": found.lowest_hz,
            "highest_hz": found.highest_hz,
            "files": shown(&paths),
        }))?;
    } else {
        console.result(&text(&system, &found, &paths))?;
    }
    Ok(Exit::Complete)
}

/// Refuses warnings whose codes were not accepted.
pub(super) fn refuse_unaccepted(found: &check::Found, global: &GlobalArgs) -> Result<(), Failure> {
    let accepted = |code: &str| global.accept.iter().any(|other| other.trim() == code);
    let warnings = found
        .warnings
        .iter()
        .filter(|warning| !accepted(warning.code));
    let errors: Vec<_> = warnings.cloned().map(StudyError::from).collect();
    if errors.is_empty() {
        Ok(())
    } else {
        Err(Failure::Study(StudyErrors::new(errors)))
    }
}

fn text(system: &System, found: &check::Found, paths: &[PathBuf]) -> String {
    let mut lines = vec![format!(
        "{} freedoms, {} entries of stiffness, {} of mass",
        system.n(),
        system.stiffness.n_entries(),
        system.mass.n_entries()
    )];
    if let Some([x, y, z]) = found.total_mass_kg {
        lines.push(format!("mass along x, y, z: {x:.4e}, {y:.4e}, {z:.4e} kg"));
    }
    if let Some(lowest) = found.lowest_hz {
        let highest = found.highest_hz;
        lines.push(format!(
            "frequencies from {lowest:.6} Hz to about {highest:.3e} Hz"
        ));
    }
    if found.n_rigid > 0 {
        lines.push(format!("{} motions without stiffness", found.n_rigid));
    }
    if found.asymmetry > 0.0 {
        lines.push(format!("asymmetry up to {:.1e} averaged", found.asymmetry));
    }
    lines.extend(shown(paths));
    lines.join("\n") + "\n"
}

/// Reads and checks everything that is named.
fn read(arguments: &MatricesArgs) -> Result<(System, check::Found), Faults> {
    let freedoms = freedoms(arguments.dof.as_deref(), arguments.places.as_deref())?;
    // Faults of both matrices are reported at once.
    let mut faults = Faults::default();
    let mut one = |path: &PathBuf| match matrix(path, freedoms.as_ref(), true) {
        Ok(matrix) => Some(matrix),
        Err(wrong) => {
            faults.append(wrong);
            None
        }
    };
    let (stiffness, mass) = (one(&arguments.stiffness), one(&arguments.mass));
    let gyroscopic = arguments.gyroscopic.as_ref().and_then(&mut one);
    let (Some(stiffness), Some(mass)) = (stiffness, mass) else {
        return Err(faults);
    };
    faults.or(())?;
    let system = System::of(mass, stiffness, gyroscopic, freedoms, arguments.units)?;
    let (system, found) = check::check(system, arguments.free)?;
    let contacts = arguments.contact.iter();
    let contacts: Vec<(usize, &String)> = contacts
        .map(|name| Ok((system.freedoms.find(name, "--contact")?, name)))
        .collect::<Result<_, Faults>>()?;
    if let (Some(shapes), Some(frequencies)) = (&arguments.modes, &arguments.frequencies) {
        let hertz = modes::read_frequencies(&Source::read(frequencies)?)?;
        let shapes = matrix(shapes, None, false)?;
        let file = frequencies.display().to_string();
        let modes = modes::of(&system, &shapes, hertz, &file, arguments.renormalise)?;
        for (row, name) in contacts {
            modes::moves(&modes, &shapes.file, row, name)?;
        }
    }
    Ok((system, found))
}
