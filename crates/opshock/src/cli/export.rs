//! `opshock export`: prints every simulation of a store as CSV or JSON; writes one shock for ParaView.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::selection::ShockArgs;
use super::{export_suspension, export_vtu, stored};
use clap::{Args, ValueEnum};
use opshock_study::report::runs_table::{csv, json};
use std::path::PathBuf;

/// Print every simulation of a store as CSV or JSON; write one shock of a study for ParaView, or its
/// suspension as matrices
#[derive(Args, Debug)]
pub struct ExportArgs {
    /// Store, or study file
    #[arg(value_name = "STORE|STUDY")]
    source: PathBuf,
    /// Format
    #[arg(long, value_name = "FORMAT")]
    format: Option<ExportFormat>,
    #[command(flatten)]
    shock: ShockArgs,
    /// Folder of the files; vtu and suspension only
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Times of the series; vtu only
    #[arg(long, value_name = "N", default_value_t = 111, value_parser = clap::value_parser!(u16).range(2..))]
    frames: u16,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ExportFormat {
    Csv,
    Json,
    /// One shock of a study for ParaView: disk, ramp and film over time, into --out
    Vtu,
    /// A study's suspension as matrices of its finite elements, into --out
    Suspension,
}

/// Runs the command.
pub fn run(
    arguments: &ExportArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let format = arguments.format;
    if matches!(format, Some(ExportFormat::Vtu | ExportFormat::Suspension)) {
        let Some(out) = &arguments.out else {
            return Err(Failure::Usage(vec![Fault {
                key: Some("--out".into()),
                allowed: Some("a folder".into()),
                ..Fault::new(
                    "usage",
                    "--format vtu and suspension write many files: --out names their folder",
                )
            }]));
        };
        let (source, shock) = (&arguments.source, &arguments.shock);
        if format == Some(ExportFormat::Suspension) {
            return export_suspension::run(source, out, global, console);
        }
        let frames = usize::from(arguments.frames);
        return export_vtu::run(source, shock, out, frames, global, console);
    }
    let is_for_series = arguments.out.is_some() || arguments.shock.is_given();
    if is_for_series {
        return Err(Failure::Usage(vec![Fault {
            key: Some("--format".into()),
            allowed: Some("vtu".into()),
            ..Fault::new(
                "usage",
                "--out and the options of a shock go with --format vtu; a store prints all its simulations",
            )
        }]));
    }
    let source = stored::source(&arguments.source, global)?;
    let results = stored::results(&source, console)?;
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
