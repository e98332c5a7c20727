//! `opshock completions`: prints the completion script of a shell, or writes manual pages.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use anyhow::Context as _;
use clap::{Args, Command};
use opshock_study::store::aside;
use std::path::PathBuf;

/// Print the completion script of a shell, or write manual pages
#[derive(Args, Debug)]
pub struct CompletionsArgs {
    /// Shell
    #[arg(required_unless_present = "man")]
    shell: Option<clap_complete::Shell>,
    /// Write a manual page of the program and of each command into a folder instead
    #[arg(long, value_name = "DIR", conflicts_with = "shell")]
    man: Option<PathBuf>,
}

/// Runs the command for the arguments of `program`.
pub fn run(
    arguments: &CompletionsArgs,
    mut program: Command,
    console: &Console,
) -> Result<Exit, Failure> {
    if let Some(folder) = &arguments.man {
        program.build();
        let mut pages = Vec::new();
        manual(&program, "opshock", &mut pages)?;
        let written = aside::write_all(folder, pages)?;
        console.note(&format!(
            "wrote {} files into {}",
            written.len(),
            folder.display()
        ));
    }
    if let Some(shell) = arguments.shell {
        let mut script = Vec::new();
        clap_complete::generate(shell, &mut program, "opshock", &mut script);
        console.result(&String::from_utf8_lossy(&script))?;
    }
    Ok(Exit::Complete)
}

/// Adds the page of a command and those of the commands below it.
fn manual(
    command: &Command,
    name: &str,
    pages: &mut Vec<(String, Vec<u8>)>,
) -> Result<(), Failure> {
    let mut page = Vec::new();
    let titled = clap_mangen::Man::new(command.clone());
    titled
        .render(&mut page)
        .context("cannot make a manual page")?;
    pages.push((format!("{name}.1"), page));
    for below in command.get_subcommands() {
        manual(below, &format!("{name}-{}", below.get_name()), pages)?;
    }
    Ok(())
}
