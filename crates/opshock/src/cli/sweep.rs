//! `opshock sweep`: finds the critical shock of every point; run again, it resumes. A study that asks for
//! touch thresholds alone gets those, without a search.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use super::report::{Reported, exit_of};
use super::stored::{self, Source};
use super::{memory, study_file, thresholds};
use anyhow::Context as _;
use clap::{Args, ValueEnum};
use opshock_solver::scene::plan::Output;
use opshock_study::report::table;
use opshock_study::search::Order;
use opshock_study::store::{Audit, Summary};
use opshock_study::study::{Point, Study};
use opshock_study::sweep::rounds::{self, Next, RoundError};
use opshock_study::sweep::{
    Ending, Physics, Progress, ProgressKind, Shard, StopFlag, SweepEnd, SweepInput, SweepOptions,
    audit, sweep,
};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Find the critical shock of every point of a study; run again, it resumes
#[derive(Args, Debug)]
pub struct SweepArgs {
    /// Study file
    study: PathBuf,
    /// Simulate again what had no verdict
    #[arg(long, value_name = "WHAT")]
    only: Option<Only>,
    /// Start nothing that would end after this time, save and end with exit code 5, as 7h30m
    #[arg(long, value_name = "TIME", value_parser = duration)]
    budget: Option<Duration>,
    /// Take finished simulations of equal content from this store, of any study; may be repeated
    #[arg(long, value_name = "STORE")]
    reuse: Vec<PathBuf>,
    /// Complete one part of the points, as 2/4, into a store of its own within the store; parts
    /// may run at the same time, on any machines that share the folder (see `merge`)
    #[arg(long, value_name = "K/N", conflicts_with = "audit")]
    shard: Option<Shard>,
    /// Run this share of the finished simulations again with all effects, as 2%; any difference is
    /// exit code 7
    #[arg(long, value_name = "SHARE", value_parser = share)]
    audit: Option<f64>,
    /// Memory that all workers together may take; without it, what the machine has available
    #[arg(long, value_name = "GB", value_parser = gigabytes)]
    memory_gb: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Only {
    Undecided,
}

/// Runs the command.
pub fn run(arguments: &SweepArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let study = study_file::read(&arguments.study, global, console)?;
    study_file::refuse_unaccepted(&study, &global.accept)?;
    if !study.asks_for(Output::CriticalShock) {
        return thresholds::run(&study, console);
    }
    let gigabytes = arguments.memory_gb.map(|gb| 1e9 * gb);
    let available = gigabytes.unwrap_or_else(memory::available_bytes);
    let folder = stored::folder_of_study(&arguments.study, global);
    let stop = StopFlag::default();
    stop.listen().context("cannot listen to signals")?;
    let options = SweepOptions {
        stop,
        budget: arguments.budget,
        retry_undecided: arguments.only == Some(Only::Undecided),
        reuse: arguments.reuse.clone(),
        shard: arguments.shard,
        ..SweepOptions::with_threads(global.threads())
    };
    let kind = if console.quiet {
        ProgressKind::Warnings
    } else {
        global.progress.into()
    };
    let observer = Observer {
        progress: &|study| kind.start(study),
        message: &|message| console.note(message),
    };
    let Swept { study, input, end } = in_rounds(study, &folder, options, available, &observer)?;

    if !arguments.reuse.is_empty() {
        console.note(&format!(
            "{} simulations taken from other stores, {} made",
            end.reused_runs, end.computed_runs
        ));
    }
    let mut summary = end.summary;
    let own = arguments.shard.map(|shard| shard.folder(&folder));
    if let Some(shard) = &arguments.shard {
        // The other rows are for their own shards to complete.
        let coordinates: Vec<_> = input.points.iter().map(|p| p.coordinates.clone()).collect();
        let mut owned = shard.owned(&Order::of(&coordinates)).into_iter();
        summary.points.retain(|_| owned.next() == Some(true));
    }
    let audited = match arguments.audit.filter(|_| end.ending == Ending::Complete) {
        Some(share) => {
            let full = Physics::in_full(&study);
            let results = stored::results(&Source::of_folder(&folder), console)?;
            let audit = audit(&input, &results, &full, share, global.threads());
            audit.keep(&folder)?;
            Some(audit)
        }
        None => None,
    };
    if console.json {
        let folder = own.as_ref().unwrap_or(&folder);
        let source = Source::of_folder(folder);
        console.result_json(&Reported::of(&stored::read(&source, console)?))?;
    } else {
        console.result(&table::terminal(&summary))?;
        if let Some(values) = study.not_refined() {
            console.note(&values);
        }
    }
    match end.ending {
        Ending::Complete => Ok(audited.map_or_else(
            || exit_of(&summary),
            |audit| report_audit(&audit, &summary, console),
        )),
        Ending::Stopped { signal } => {
            console.note(&resume(arguments, &folder, global));
            let number = signal.and_then(|signal| u8::try_from(signal).ok());
            Ok(number.map_or(Exit::Budget, Exit::Signal))
        }
        Ending::Budget => {
            console.note(&resume(arguments, &folder, global));
            Ok(Exit::Budget)
        }
    }
}

/// Receives what a sweep reports.
pub struct Observer<'a> {
    /// Progress of a round, by the name of its study.
    pub progress: &'a dyn Fn(&str) -> Box<dyn Progress>,
    /// A message for the user.
    pub message: &'a dyn Fn(&str),
}

/// A sweep that ended.
pub struct Swept {
    /// The study with the widths of its last round.
    pub study: Study,
    /// Its input.
    pub input: SweepInput,
    /// How it ended, with the simulations of all rounds.
    pub end: SweepEnd,
}

/// Sweeps a study into a folder, with the rounds of widths that it adds. Each must fit into `available` bytes.
///
/// # Errors
///
/// The study has nothing to search or does not fit into the memory; the store cannot be used.
pub fn in_rounds(
    study: Study,
    folder: &Path,
    mut options: SweepOptions,
    available: f64,
    observer: &Observer<'_>,
) -> Result<Swept, Failure> {
    thresholds::refuse_without_search(&study)?;
    let (began, budget) = (Instant::now(), options.budget);
    // Without their undecided runs the study's own answers may call for other widths.
    let mut study = if options.retry_undecided {
        study
    } else {
        rounds::first(&study, folder, options.shard.as_ref()).map_err(not_known)?
    };
    let (mut computed_runs, mut reused_runs) = (0, 0);
    loop {
        memory::of_sweep(&study).check("the sweep", options.threads, available)?;
        let progress = (observer.progress)(&study.name);
        let input = SweepInput::of(&study).context("the study has no amplitudes to search")?;
        let physics = Physics::of(&study);
        let mut end = sweep(&input, &physics, folder, &options, progress.as_ref())?;
        drop(progress);
        computed_runs += end.computed_runs;
        reused_runs += end.reused_runs;
        (end.computed_runs, end.reused_runs) = (computed_runs, reused_runs);
        options.budget = budget.map(|budget| budget.saturating_sub(began.elapsed()));
        if end.ending != Ending::Complete {
            return Ok(Swept { study, input, end });
        }
        if options.shard.is_some() && study.search.added_points.is_some() {
            let waits = "this part is answered: points to be added wait for the shards at work";
            (observer.message)(waits);
        }
        let now = Instant::now();
        match rounds::next(&study, folder, &options, &end.summary, now).map_err(not_known)? {
            Next::Round(next) => {
                (observer.message)(&added(&study, &next));
                study = *next;
                options.retry_undecided = false;
                continue;
            }
            Next::Done => {}
            Next::Left { points } => (observer.message)(&format!(
                "{points} points of shards that are not at work are open, and with them the points to \
                 be added: run these shards, or `opshock merge` and `opshock sweep`"
            )),
            Next::Stopped(ending) => end.ending = ending,
        }
        return Ok(Swept { study, input, end });
    }
}

/// Why the widths of the next round are not known.
fn not_known(error: RoundError) -> Failure {
    match error {
        RoundError::Store(error) => error.into(),
        RoundError::AmplitudeGrid(error) => anyhow::Error::new(error)
            .context("the study has no amplitudes to search")
            .into(),
    }
}

/// The points that the next round adds.
fn added(study: &Study, next: &Study) -> String {
    let new = &next.points[study.points.len()..];
    let labels: Vec<String> = new.iter().map(Point::label).collect();
    format!("{} points added: {}", new.len(), labels.join(", "))
}

/// Prints what an audit showed.
fn report_audit(audit: &Audit, summary: &Summary, console: &Console) -> Exit {
    console.note(&audit.sentence());
    for difference in &audit.differences {
        console.note(&difference.to_string());
    }
    if audit.differences.is_empty() {
        exit_of(summary)
    } else {
        Exit::Difference
    }
}

/// What to type to go on.
fn resume(arguments: &SweepArgs, folder: &Path, global: &GlobalArgs) -> String {
    let mut line = format!(
        "saved; resume with: opshock sweep {} --store {}{}",
        quoted(&arguments.study.display().to_string()),
        quoted(&folder.display().to_string()),
        settings(global)
    );
    for store in &arguments.reuse {
        line.push_str(&format!(
            " --reuse {}",
            quoted(&store.display().to_string())
        ));
    }
    if let Some(shard) = &arguments.shard {
        line.push_str(&format!(" --shard {shard}"));
    }
    line
}

/// `--set`, `--unset` and `--accept` as they were given, each with a space before it.
pub(super) fn settings(global: &GlobalArgs) -> String {
    let mut line = String::new();
    for set in &global.set {
        line.push_str(&format!(" --set {}", quoted(set)));
    }
    for key in &global.unset {
        line.push_str(&format!(" --unset {}", quoted(key)));
    }
    if !global.accept.is_empty() {
        line.push_str(&format!(" --accept {}", global.accept.join(",")));
    }
    line
}

/// As a POSIX shell takes it back.
pub(super) fn quoted(word: &str) -> String {
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

/// Memory in GB.
fn gigabytes(text: &str) -> Result<f64, String> {
    let value = text.trim().parse::<f64>().ok();
    value
        .filter(|value| *value > 0.0 && value.is_finite())
        .ok_or_else(|| "must be a number above 0, in GB".to_owned())
}

/// A time as `7h30m`, `90s` or `1.5h`: numbers with units that descend, each at most once.
pub(super) fn duration(text: &str) -> Result<Duration, String> {
    let wrong = || "must be a time with units d, h, m, s in this order, as 7h30m".to_owned();
    let mut units = [('d', 86400.0), ('h', 3600.0), ('m', 60.0), ('s', 1.0)].into_iter();
    let (mut rest, mut total_s) = (text, 0.0);
    if rest.is_empty() {
        return Err(wrong());
    }
    while !rest.is_empty() {
        let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.');
        let (number, unit) = rest.split_at(digits.ok_or_else(wrong)?);
        let number: f64 = number.parse().map_err(|_| wrong())?;
        let unit_name = unit.chars().next().ok_or_else(wrong)?;
        let (name, seconds) = units
            .find(|(name, _)| *name == unit_name)
            .ok_or_else(wrong)?;
        total_s += number * seconds;
        rest = &unit[name.len_utf8()..];
    }
    Duration::try_from_secs_f64(total_s).map_err(|_| wrong())
}

#[cfg(test)]
mod tests {
    use super::duration;

    #[test]
    fn times_are_numbers_with_descending_units() {
        for (text, seconds) in [
            ("7h30m", 27000.0),
            ("90s", 90.0),
            ("1.5h", 5400.0),
            ("1d1h1m1.5s", 90061.5),
            ("0s", 0.0),
        ] {
            let read = duration(text).map(|time| time.as_secs_f64());
            assert_eq!(read, Ok(seconds), "{text}");
        }
        for text in [
            "", "7", "h", "30m7h", "1h1h", "-1h", "1e3s", "1.2.3s", "7 h", "7H", "infs", "nans",
        ] {
            assert!(duration(text).is_err(), "{text}");
        }
        assert!(duration(&format!("{}d", "9".repeat(20))).is_err());
    }
}
