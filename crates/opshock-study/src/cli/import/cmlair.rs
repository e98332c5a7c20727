//! `opshock import cmlair`: an air-bearing surface, and how it is flown.

use super::{refused, shown, write_new};
use crate::cli::console::Console;
use crate::cli::exit::Exit;
use crate::cli::failure::Failure;
use clap::Args;
use opshock_import::cml::study::{Asked, study, surface};
use opshock_import::cml::{rail, run as run_file};
use opshock_import::text::Source;
use serde_json::json;
use std::path::PathBuf;

/// Turn a CMLAir rail.dat, and a run.dat, into a study and a surface file
#[derive(Args, Debug)]
pub struct CmlairArgs {
    /// The surface, rail.dat of version 7.0 or 8.0
    rail: PathBuf,
    /// Radius, skew, speed, gas and load from this run.dat; without it, those of the default drive
    #[arg(long, value_name = "FILE")]
    run: Option<PathBuf>,
    /// Which of the radii of run.dat
    #[arg(long, value_name = "K", default_value_t = 1, requires = "run")]
    radius: usize,
    /// Which of the speeds of run.dat
    #[arg(long, value_name = "K", default_value_t = 1, requires = "run")]
    speed: usize,
    /// Name of the study
    #[arg(long, default_value = "imported from CMLAir")]
    name: String,
    /// Folder for study.toml and surface.toml
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Runs the command.
pub fn run(arguments: &CmlairArgs, console: &Console) -> Result<Exit, Failure> {
    let source = Source::read(&arguments.rail).map_err(refused)?;
    let file = rail::read(&source).map_err(refused)?;
    let flights = match &arguments.run {
        Some(path) => {
            let source = Source::read(path).map_err(refused)?;
            Some(run_file::read(&source).map_err(refused)?)
        }
        None => None,
    };
    let named = arguments
        .run
        .as_ref()
        .map(|path| path.display().to_string());
    let asked = Asked {
        name: &arguments.name,
        surface_file: "surface.toml",
        run_file: named.as_deref().unwrap_or_default(),
        radius: arguments.radius,
        speed: arguments.speed,
    };
    let surface = surface(&file, &source.name).map_err(refused)?;
    let study = study(&file, flights.as_ref(), asked).map_err(refused)?;
    let files = [
        ("study.toml", study.text.as_str()),
        ("surface.toml", surface.text.as_str()),
    ];
    let paths = write_new(&arguments.out, &files)?;
    let notes = [surface.left_out, study.left_out].concat();
    for note in &notes {
        console.tell(&format!("note: {note}"));
    }
    if console.json {
        console.result_json(&json!({
            "files": shown(&paths),
            "rails": file.rails.len(),
            "notes": notes.iter().map(ToString::to_string).collect::<Vec<_>>(),
        }))?;
    } else {
        console.result(&format!(
            "{} rails: {}\n",
            file.rails.len(),
            shown(&paths).join(", ")
        ))?;
    }
    Ok(Exit::Complete)
}
