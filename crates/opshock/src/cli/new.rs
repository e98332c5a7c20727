//! `opshock new`: prints a study to start from.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use clap::Args;
use opshock_study::study::Study;

/// Print a study to start from: opshock new > my-drive.toml
#[derive(Args, Debug)]
pub struct NewArgs {
    /// Name of the study
    #[arg(default_value = "my drive")]
    name: String,
}

/// Runs the command.
pub fn run(arguments: &NewArgs, console: &Console) -> Result<Exit, Failure> {
    console.result(&Study::example(&arguments.name))?;
    Ok(Exit::Complete)
}
