//! `opshock export`: every simulation of a store as CSV or JSON.

use super::GlobalArgs;
use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::stored;
use crate::report::runs_table::{csv, json};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Print every simulation of a store as CSV or JSON
#[derive(Args, Debug)]
pub struct ExportArgs {
    /// Store, or study file
    #[arg(value_name = "STORE|STUDY")]
    source: PathBuf,
    /// Format
    #[arg(long, value_name = "FORMAT")]
    format: Option<ExportFormat>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ExportFormat {
    Csv,
    Json,
}

/// Runs the command.
pub fn run(
    arguments: &ExportArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let folder = stored::folder(&arguments.source, global)?;
    let results = stored::results(&folder, console)?;
    let as_json = match arguments.format {
        Some(format) => format == ExportFormat::Json,
        None => console.json,
    };
    if as_json {
        console.result_json(&json(&results))?;
    } else {
        console.result(&csv(&results))?;
    }
    Ok(Exit::Complete)
}
