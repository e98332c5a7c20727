//! `opshock compare`: prints what differs between two stores (folders of a sweep's results).

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::stored;
use clap::Args;
use opshock_study::report::comparison::{Side, compare};
use std::path::PathBuf;

/// Print what differs between two sweeps: critical shocks, whether that is beyond their errors,
/// settings, points
#[derive(Args, Debug)]
pub struct CompareArgs {
    /// Store, or study file
    #[arg(value_name = "STORE|STUDY")]
    a: PathBuf,
    /// Store, or study file
    #[arg(value_name = "STORE|STUDY")]
    b: PathBuf,
}

/// Runs the command.
pub fn run(
    arguments: &CompareArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let (a, b) = (&arguments.a, &arguments.b);
    if global.store.is_some() && a.is_file() && b.is_file() {
        return Err(Failure::Usage(vec![Fault {
            key: Some("--store".into()),
            allowed: Some("--store beside one study file and one store".into()),
            ..Fault::new("usage", "--store cannot be the store of both study files")
        }]));
    }
    let stored_a = stored::read(&stored::source(a, global)?, console)?;
    let stored_b = stored::read(&stored::source(b, global)?, console)?;
    let (name_a, name_b) = (a.display().to_string(), b.display().to_string());
    let a = Side {
        source: &name_a,
        summary: &stored_a.summary,
        resolved_study: stored_a.resolved_study.as_deref(),
    };
    let b = Side {
        source: &name_b,
        summary: &stored_b.summary,
        resolved_study: stored_b.resolved_study.as_deref(),
    };
    let comparison = compare(a, b);
    if console.json {
        console.result_json(&comparison.json(a, b))?;
    } else {
        console.result(&comparison.text(a, b))?;
    }
    Ok(Exit::Complete)
}
