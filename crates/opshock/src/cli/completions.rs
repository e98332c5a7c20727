//! `opshock completions`: prints the completion script of a shell.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use clap::{Args, Command};

/// Print the completion script of a shell
#[derive(Args, Debug)]
pub struct CompletionsArgs {
    /// Shell
    shell: clap_complete::Shell,
}

/// Runs the command for the arguments of `program`.
pub fn run(
    arguments: &CompletionsArgs,
    mut program: Command,
    console: &Console,
) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "opshock", &mut script);
    console.result(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Complete)
}
