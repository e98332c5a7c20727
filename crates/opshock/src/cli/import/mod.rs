//! `opshock import`: other programs' files as files of opshock.

mod cmlair;
mod dynamic;
mod matrices;
mod ramp;

use super::GlobalArgs;
use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use clap::{Args, Subcommand};
use opshock_import::Faults;
use opshock_study::store::aside;
use opshock_study::study::{StudyError, StudyErrors};
use std::path::{Path, PathBuf};

/// Turn other programs' files into files of opshock
#[derive(Args, Debug)]
pub struct ImportArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand, Debug)]
enum What {
    Cmlair(cmlair::CmlairArgs),
    Matrices(matrices::MatricesArgs),
    Ramp(ramp::RampArgs),
}

/// Runs the command.
pub fn run(
    arguments: &ImportArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    match &arguments.what {
        What::Cmlair(arguments) => cmlair::run(arguments, global, console),
        What::Matrices(arguments) => matrices::run(arguments, global, console),
        What::Ramp(arguments) => ramp::run(arguments, global, console),
    }
}

/// Faults of files as faults of a study: one place tells them all.
fn refused(faults: Faults) -> Failure {
    let errors = faults.listed.into_iter().map(StudyError::from);
    let mut errors = StudyErrors::new(errors.collect());
    errors.unlisted += faults.unlisted;
    Failure::Study(errors)
}

/// Writes files into a folder that is made where there is none; nothing that is there is replaced.
pub(super) fn write_new(folder: &Path, files: &[(&str, &str)]) -> Result<Vec<PathBuf>, Failure> {
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.join(name)).collect();
    if let Some(there) = paths.iter().find(|path| path.exists()) {
        let fault = Fault {
            key: Some("--out".to_owned()),
            value: Some(there.display().to_string()),
            hint: Some("give another folder; nothing that is there is replaced".to_owned()),
            ..Fault::new("usage", format!("{} exists already", there.display()))
        };
        return Err(Failure::Usage(vec![fault]));
    }
    let written = aside::write_all(folder, files.iter().copied());
    if written.is_err() {
        // None was there: what got its name goes, so that the same command may be given again.
        for path in &paths {
            let _ = std::fs::remove_file(path);
        }
    }
    Ok(written?)
}

/// Paths as text.
pub(super) fn shown(paths: &[PathBuf]) -> Vec<String> {
    paths
        .iter()
        .map(|path| path.display().to_string())
        .collect()
}
