//! `opshock import`: turns other programs' files into files of opshock.

mod cmlair;
mod dynamic;
mod matrices;
mod ramp;
pub(super) mod written;

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use clap::{Args, Subcommand};

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
