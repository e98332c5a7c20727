//! `opshock status`: shows how far a sweep has come.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use super::report::exit_of;
use super::stored;
use clap::Args;
use opshock_study::report::table;
use opshock_study::store::summary::{Status, Summary};
use std::io::IsTerminal as _;
use std::path::PathBuf;
use std::time::Duration;

/// Show how far a sweep has come, from its store
#[derive(Args, Debug)]
pub struct StatusArgs {
    /// Store, or study file
    #[arg(value_name = "STORE|STUDY")]
    source: PathBuf,
    /// Show it again every few seconds until no point is open; with --json a line each
    #[arg(long, value_name = "SECONDS", num_args = 0..=1, default_missing_value = "2",
          value_parser = clap::value_parser!(u16).range(1..))]
    watch: Option<u16>,
}

/// Home, and nothing below.
const CLEAR: &str = "\u{1b}[H\u{1b}[J";

/// Runs the command.
pub fn run(
    arguments: &StatusArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let source = stored::source(&arguments.source, global)?;
    loop {
        let summary = stored::read(&source, console)?.summary;
        match arguments.watch {
            None if console.json => console.result_json(&summary)?,
            None => console.result(&table::terminal(&summary))?,
            Some(_) => show(&summary, console)?,
        }
        let is_open = summary.points.iter().any(|row| row.status == Status::Open);
        match arguments.watch.filter(|_| is_open) {
            Some(seconds) => std::thread::sleep(Duration::from_secs(seconds.into())),
            None => return Ok(exit_of(&summary)),
        }
    }
}

fn show(summary: &Summary, console: &Console) -> Result<(), Failure> {
    if console.json {
        return console.result_json_line(summary);
    }
    let clear = if std::io::stdout().is_terminal() {
        CLEAR
    } else {
        ""
    };
    console.result(&format!("{clear}{}", table::terminal(summary)))
}
