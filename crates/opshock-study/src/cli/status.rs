//! `opshock status`: how far a sweep has come.

use super::GlobalArgs;
use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::report::exit_of;
use super::stored;
use crate::report::table;
use clap::Args;
use std::path::PathBuf;

/// Show how far a sweep has come, from its store
#[derive(Args, Debug)]
pub struct StatusArgs {
    /// Store, or study file
    #[arg(value_name = "STORE|STUDY")]
    source: PathBuf,
}

/// Runs the command.
pub fn run(
    arguments: &StatusArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let folder = stored::folder(&arguments.source, global)?;
    let stored = stored::read(&folder, console)?;
    if console.json {
        console.result_json(&stored.summary)?;
    } else {
        console.result(&table::terminal(&stored.summary))?;
    }
    Ok(exit_of(&stored.summary))
}
