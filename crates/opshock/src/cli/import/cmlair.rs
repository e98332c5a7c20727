//! `opshock import cmlair`: turns files of CMLAir into a study: air-bearing surface, flying conditions, drive, shock.

use super::dynamic::{self, Beside};
use super::matrices::refuse_unaccepted;
use super::written::{refused, shown, write_new};
use crate::cli::console::Console;
use crate::cli::exit::Exit;
use crate::cli::failure::Failure;
use crate::cli::global::GlobalArgs;
use clap::Args;
use opshock_import::cml::deck::MAP;
use opshock_import::cml::dynamic::{Contents, DynamicFile};
use opshock_import::cml::study::{Asked, study, surface};
use opshock_import::cml::{drive, dynamic as dynamic_file, rail, run as run_file};
use opshock_import::text::Source;
use serde_json::json;
use std::path::PathBuf;

/// Turn a CMLAir rail.dat, a run.dat and a DynLULS.def into a study and a surface file
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
    /// Slider, pulse, disk and ramp from this DynLULS.def, and the suspension from susp_M.dat, susp_K.dat and
    /// susp_cords.dat beside it
    #[arg(long, value_name = "FILE", conflicts_with_all = ["radius", "speed"])]
    dynamic: Option<PathBuf>,
    /// Leave the matrices beside DynLULS.def where they are
    #[arg(long, requires = "dynamic")]
    without_matrices: bool,
    /// Name of the study
    #[arg(long, default_value = "imported from CMLAir")]
    name: String,
    /// Folder for study.toml and surface.toml
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Runs the command.
pub fn run(
    arguments: &CmlairArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let source = Source::read(&arguments.rail).map_err(refused)?;
    let file = rail::read(&source).map_err(refused)?;
    let flights = match &arguments.run {
        Some(path) => {
            let source = Source::read(path).map_err(refused)?;
            Some(run_file::read(&source).map_err(refused)?)
        }
        None => None,
    };
    let dynamic = dynamic_run(arguments)?;
    let beside = dynamic.as_ref().and_then(|(_, _, beside)| beside.as_ref());
    if let Some(beside) = beside {
        refuse_unaccepted(&beside.found, global)?;
    }
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
    let study = match &dynamic {
        Some((name, dynamic, _)) => {
            let imported = (
                beside.map(|beside| beside.keys.as_str()),
                beside.and_then(|beside| beside.parted.as_ref()),
            );
            let dynamic = (dynamic, name.as_str());
            drive::study(&file, flights.as_ref(), dynamic, imported, asked)
        }
        None => study(&file, flights.as_ref(), asked),
    }
    .map_err(refused)?;
    let mut files = vec![
        ("study.toml", study.text.as_str()),
        ("surface.toml", surface.text.as_str()),
    ];
    if let Some(beside) = beside {
        let texts = beside.texts.iter().map(String::as_str);
        files.extend(dynamic::FILES.into_iter().zip(texts));
    }
    let paths = write_new(&arguments.out, &files)?;
    let is_deck = |file: &DynamicFile| matches!(file.suspension, Contents::Deck(_));
    let map = match &dynamic {
        Some((_, file, _)) if is_deck(file) => &MAP[..],
        _ => &[],
    };
    for (fields, keys) in map {
        console.note(&format!("{fields} -> {keys}"));
    }
    let notes = [surface.left_out, study.left_out].concat();
    for note in &notes {
        console.note(&format!("note: {note}"));
    }
    if console.json {
        console.result_json(&json!({
            "files": shown(&paths),
            "rails": file.rails.len(),
            "map": map.iter().map(|(fields, keys)| [fields, keys]).collect::<Vec<_>>(),
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

/// The dynamic run that is asked for: its file's name, what it says, and what lies beside it.
fn dynamic_run(
    arguments: &CmlairArgs,
) -> Result<Option<(String, DynamicFile, Option<Beside>)>, Failure> {
    let Some(path) = &arguments.dynamic else {
        return Ok(None);
    };
    let source = Source::read(path).map_err(refused)?;
    let file = dynamic_file::read(&source).map_err(refused)?;
    let beside = match arguments.without_matrices {
        true => None,
        false => dynamic::beside(path, &file).map_err(refused)?,
    };
    Ok(Some((source.name, file, beside)))
}
