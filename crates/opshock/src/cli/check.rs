//! `opshock check`: checks a study without simulating anything, and prints what it asks for.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use super::study_file;
use clap::Args;
use opshock_study::study::{Study, StudyError};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Check a study without simulating anything
#[derive(Args, Debug)]
pub struct CheckArgs {
    /// Study file
    study: PathBuf,
    /// Print the study with every default written out
    #[arg(long)]
    resolved: bool,
}

/// Runs the command.
pub fn run(arguments: &CheckArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let study = study_file::read(&arguments.study, global, console)?;
    if console.json {
        console.result_json(&as_json(&study))?;
    } else if arguments.resolved {
        console.result(&study.resolved_toml())?;
    } else {
        let doubts = study.unaccepted(&global.accept).len();
        console.result(&as_text(&study, doubts))?;
    }
    Ok(Exit::Complete)
}

fn as_json(study: &Study) -> Value {
    let axes: serde_json::Map<String, Value> = study
        .axes
        .iter()
        .map(|axis| {
            let values = axis.values.iter().map(|value| value.to_json()).collect();
            (axis.path.clone(), Value::Array(values))
        })
        .collect();
    json!({
        "study": study.name,
        "digest": study.digest_hex(),
        "points": study.points.len(),
        "ramps": study.ramps.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "widths_ms": study.widths_ms,
        "signs": study.signs.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "axes": axes,
        "remarks": study.remarks.iter().map(StudyError::to_json).collect::<Vec<_>>(),
        "overrides": study.overrides.iter().map(|over| json!({
            "key": over.key, "file_value": over.file_value, "set_value": over.set_value,
        })).collect::<Vec<_>>(),
        "resolved": study.resolved_toml(),
    })
}

/// The study; of its `doubts`, warnings that are not accepted, it says that a sweep stops at them.
fn as_text(study: &Study, doubts: usize) -> String {
    let list = |values: Vec<String>| values.join(", ");
    let mut text = match doubts {
        0 => format!("{}: valid\n", study.name),
        1 => format!("{}: valid, with a warning that stops a sweep\n", study.name),
        _ => format!(
            "{}: valid, with {doubts} warnings that stop a sweep\n",
            study.name
        ),
    };
    let mut line = |name: &str, value: String| text.push_str(&format!("  {name:<10}{value}\n"));
    line("digest", study.digest_hex());
    line("points", study.points.len().to_string());
    line(
        "ramps",
        list(study.ramps.iter().map(ToString::to_string).collect()),
    );
    line(
        "widths",
        format!(
            "{} ms",
            list(study.widths_ms.iter().map(ToString::to_string).collect())
        ),
    );
    line(
        "signs",
        list(study.signs.iter().map(ToString::to_string).collect()),
    );
    for axis in &study.axes {
        let values = list(axis.values.iter().map(ToString::to_string).collect());
        line("axis", format!("{} = {values}", axis.path));
    }
    for over in &study.overrides {
        let before = match over.file_value.as_str() {
            "" => "not in the file".to_owned(),
            value => format!("file: {value}"),
        };
        match over.set_value.as_str() {
            "" => line("unset", format!("{} ({before})", over.key)),
            value => line("set", format!("{} = {value} ({before})", over.key)),
        }
    }
    text
}
