//! `opshock sweep`: the critical shock of every point; run again, it resumes. A study that asks for
//! touch thresholds alone gets those, without a search.

use super::GlobalArgs;
use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::report::{Told, exit_of};
use super::{stored, study_file, thresholds};
use crate::report::table;
use crate::store::{Audit, Summary};
use crate::sweep::{
    Ending, Physics, ProgressKind, StopFlag, SweepInput, SweepOptions, audit, sweep,
};
use anyhow::Context as _;
use clap::{Args, ValueEnum};
use opshock_solver::scene::plan::Output;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Find the critical shock of every point of a study; run again, it resumes
#[derive(Args, Debug)]
pub struct SweepArgs {
    /// Study file
    study: PathBuf,
    /// Simulate again what had no verdict
    #[arg(long, value_name = "WHAT")]
    only: Option<Only>,
    /// Save and end after this time, s
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    budget_s: Option<Duration>,
    /// Run this share of the finished simulations again with all effects, as 2%; any difference is
    /// exit code 7
    #[arg(long, value_name = "SHARE", value_parser = share)]
    audit: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Only {
    Undecided,
}

/// Runs the command.
pub fn run(arguments: &SweepArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let study = study_file::read(&arguments.study, global, console)?;
    study_file::refuse_unaccepted(&study, global)?;
    if !study.asks_for(Output::CriticalShock) {
        return thresholds::run(&study, console);
    }
    let folder = stored::folder_of_study(&arguments.study, global);
    let stop = StopFlag::default();
    stop.listen().context("cannot listen to signals")?;
    let options = SweepOptions {
        stop,
        budget: arguments.budget_s,
        retry_undecided: arguments.only == Some(Only::Undecided),
        ..SweepOptions::with_threads(global.threads())
    };
    let kind = if console.quiet {
        ProgressKind::None
    } else {
        global.progress.into()
    };
    let progress = kind.start(&study.name);
    let input = SweepInput::of(&study).context("the study has no amplitudes to search")?;
    let physics = Physics::of(&study);
    let end = sweep(&input, &physics, &folder, &options, progress.as_ref())?;
    drop(progress);

    let summary = end.summary;
    let audited = match arguments.audit.filter(|_| end.ending == Ending::Complete) {
        Some(share) => {
            let full = Physics::in_full(&study);
            let results = stored::results(&folder, console)?;
            let audit = audit(&input, &results, &full, share, global.threads());
            audit.keep(&folder)?;
            Some(audit)
        }
        None => None,
    };
    if console.json {
        console.result_json(&Told::of(&stored::read(&folder, console)?))?;
    } else {
        console.result(&table::terminal(&summary))?;
    }
    match end.ending {
        Ending::Complete => Ok(audited.map_or_else(
            || exit_of(&summary),
            |audit| tell_audit(&audit, &summary, console),
        )),
        Ending::Stopped { signal } => {
            console.tell(&resume(&arguments.study, &folder, global));
            let number = signal.and_then(|signal| u8::try_from(signal).ok());
            Ok(number.map_or(Exit::Budget, Exit::Signal))
        }
        Ending::Budget => {
            console.tell(&resume(&arguments.study, &folder, global));
            Ok(Exit::Budget)
        }
    }
}

/// Tells what an audit showed.
fn tell_audit(audit: &Audit, summary: &Summary, console: &Console) -> Exit {
    console.tell(&audit.sentence());
    for difference in &audit.differences {
        console.tell(&difference.to_string());
    }
    if audit.differences.is_empty() {
        exit_of(summary)
    } else {
        Exit::Difference
    }
}

/// What to type to go on.
fn resume(study: &Path, folder: &Path, global: &GlobalArgs) -> String {
    let mut line = format!(
        "saved; resume with: opshock sweep {}",
        quoted(&study.display().to_string())
    );
    line.push_str(&format!(
        " --store {}",
        quoted(&folder.display().to_string())
    ));
    for set in &global.set {
        line.push_str(&format!(" --set {}", quoted(set)));
    }
    if !global.accept.is_empty() {
        line.push_str(&format!(" --accept {}", global.accept.join(",")));
    }
    line
}

/// As a POSIX shell takes it back.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// A share as `2%` or `0.02`.
fn share(text: &str) -> Result<f64, String> {
    let (digits, unit) = match text.strip_suffix('%') {
        Some(digits) => (digits, 0.01),
        None => (text, 1.0),
    };
    let value = digits.trim().parse::<f64>().ok().map(|value| value * unit);
    let allowed = "must be a share above 0 %, at most 100 %, as 2%";
    value
        .filter(|value| *value > 0.0 && *value <= 1.0)
        .ok_or_else(|| allowed.to_owned())
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    Duration::try_from_secs_f64(seconds).map_err(|_| "must be a time >= 0".to_owned())
}
