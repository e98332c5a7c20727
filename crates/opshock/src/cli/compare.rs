//! `opshock compare`: prints what differs between two stores (folders of a sweep's results), or within one.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::report::not_of_the_table;
use super::stored;
use clap::Args;
use opshock_study::report::answer::Answer;
use opshock_study::report::comparison::{Side, compare};
use opshock_study::report::coordinates::selected;
use std::path::PathBuf;

/// Print what differs between two sweeps: critical shocks, whether that is beyond their errors,
/// settings, points. Of one sweep: the values of its axes against the best, or points against points
#[derive(Args, Debug)]
pub struct CompareArgs {
    /// Store, or study file
    #[arg(value_name = "STORE|STUDY")]
    a: PathBuf,
    /// Store, or study file; without it A is compared with itself
    #[arg(value_name = "STORE|STUDY")]
    b: Option<PathBuf>,
    /// Points of the one sweep that have these values, as ramp=rigid,sign=+
    #[arg(long, value_name = "KEY=VALUE,...", value_delimiter = ',', value_parser = pair,
          requires = "with", conflicts_with = "b")]
    points: Vec<(String, String)>,
    /// Points to compare them with: other values of the same keys
    #[arg(long, value_name = "KEY=VALUE,...", value_delimiter = ',', value_parser = pair,
          requires = "points")]
    with: Vec<(String, String)>,
}

fn pair(text: &str) -> Result<(String, String), String> {
    let pair = text.split_once('=');
    let (key, value) = pair.ok_or_else(|| "must be KEY=VALUE, as sign=+".to_owned())?;
    Ok((key.to_owned(), value.to_owned()))
}

/// Runs the command.
pub fn run(
    arguments: &CompareArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let a = &arguments.a;
    let Some(b) = &arguments.b else {
        return within(arguments, global, console);
    };
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
    print(a, b, console)
}

/// Compares points, or the values of each axis, of one store.
fn within(
    arguments: &CompareArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let stored = stored::read(&stored::source(&arguments.a, global)?, console)?;
    if arguments.points.is_empty() {
        let answer = Answer::of(&stored.summary);
        match console.json {
            true => console.result_json(&answer.json())?,
            false => console.result(&answer.text())?,
        }
        return Ok(Exit::Complete);
    }
    let sides = selected(&stored.summary, &arguments.points, &arguments.with);
    let (a, b) = sides.map_err(not_of_the_table)?;
    let words = |pairs: &[(String, String)]| {
        let words: Vec<String> = pairs.iter().map(|(k, v)| format!("{k}={v}")).collect();
        words.join(",")
    };
    let (name_a, name_b) = (words(&arguments.points), words(&arguments.with));
    let side = |source, summary| Side {
        source,
        summary,
        resolved_study: stored.resolved_study.as_deref(),
    };
    print(side(&name_a, &a), side(&name_b, &b), console)
}

fn print(a: Side<'_>, b: Side<'_>, console: &Console) -> Result<Exit, Failure> {
    let comparison = compare(a, b);
    if console.json {
        console.result_json(&comparison.json(a, b))?;
    } else {
        console.result(&comparison.text(a, b))?;
    }
    Ok(Exit::Complete)
}
