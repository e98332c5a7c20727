//! `opshock match`: finds parameters of a study that make a set of observations true.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use super::long_run::LongRun;
use super::stored;
use super::sweep::{duration, quoted, settings};
use super::{memory, modes, steady, study_file};
use anyhow::Context as _;
use clap::Args;
use opshock_paper::claims::Paper;
use opshock_solver::scene::Scene;
use opshock_solver::simulation::Outcome;
use opshock_study::matching::{
    Ended, Evaluations, MatchAnswer, MatchProblem, Printed, Stage, WaveReport, forecast, search,
};
use opshock_study::provenance;
use opshock_study::report::{RunJson, STUDY_OF_A_MATCH, match_files, match_text};
use opshock_study::store::aside;
use opshock_study::study::Study;
use opshock_study::study::memory::Demand;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Find parameters of a study that make a set of observations true; run again, it resumes
#[derive(Args, Debug)]
pub struct MatchArgs {
    /// Match file
    file: PathBuf,
    /// Start nothing new after this time, save and end with exit code 5, as 7h30m
    #[arg(long, value_name = "TIME", value_parser = duration)]
    budget: Option<Duration>,
    /// Write matching studies, tables and plots into a folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &MatchArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let problem = MatchProblem::from_path(&arguments.file, &study_file::sets(global)?, &Paper)?;
    check_memory(&problem, global)?;
    let folder = stored::folder_of_study(&arguments.file, global);
    let running = LongRun::begin(arguments.budget, console)?;
    running.acknowledge_signals();
    let store = problem.open_store(&folder)?;
    for note in &store.notes {
        console.note(&format!("warning: {note}"));
    }
    let asked_to_stop = || running.until.is_over();
    let progress = |stage: Stage, done: usize, of: usize| {
        running.tell_progress(|| format!("{}: {done} of {of} parameter sets", stage.words()));
    };
    // All of this process: the search itself runs on this thread.
    rayon::ThreadPoolBuilder::new()
        .num_threads(global.threads())
        .build_global()
        .context("cannot start threads")?;
    let mut evaluations =
        Evaluations::new(&problem, &Commands, Some(store), &asked_to_stop, &progress);
    let names: Vec<&str> = problem
        .parameters
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    let mut report = |wave: &WaveReport| console.note(&wave_words(wave, &names));
    let found = search(&problem, &mut evaluations, &mut report)?;
    let answer = MatchAnswer::of(&problem, &found);
    console.note(&format!(
        "{} simulated sets of numbers, {} s",
        evaluations.computed,
        running.seconds()
    ));
    if let Some(folder) = &arguments.out {
        let files = match_files(&problem, &answer, &found, &provenance::program())
            .context("cannot draw a figure")?;
        let written = aside::write_all(folder, files)?;
        aside::remove_former(folder, &written, &problem.study.path, study_of_a_match)?;
        console.note(&format!(
            "wrote {} files into {}",
            written.len(),
            folder.display()
        ));
    }
    if console.json {
        console.result_json(&answer)?;
    } else {
        console.result(&match_text(&answer))?;
    }
    if found.ended == Ended::Complete {
        return Ok(Exit::Complete);
    }
    console.note(&format!(
        "saved; resume with: opshock match {} --store {}{}",
        quoted(&arguments.file.display().to_string()),
        quoted(&folder.display().to_string()),
        settings(global)
    ));
    Ok(running.stopped())
}

/// How a file of this name begins, if a match wrote it.
fn study_of_a_match(name: &str) -> Option<&'static str> {
    let number = name
        .strip_prefix("matching-")
        .and_then(|rest| rest.strip_suffix(".toml"));
    let is_named =
        name == "nearest.toml" || number.is_some_and(|number| number.parse::<u32>().is_ok());
    is_named.then_some(STUDY_OF_A_MATCH)
}

/// `opshock plan` of a match file.
///
/// # Errors
///
/// As [`run`], before anything is simulated.
pub(super) fn plan(file: &Path, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let problem = MatchProblem::from_path(file, &study_file::sets(global)?, &Paper)?;
    check_memory(&problem, global)?;
    let stages = forecast(&problem, &Commands);
    let threads = global.threads() as f64;
    let sum = |end: usize| stages.iter().map(|stage| stage.core_h[end]).sum::<f64>() / threads;
    if console.json {
        console.result_json(
            &json!({ "stages": stages, "threads": threads, "hours": [sum(0), sum(1)] }),
        )?;
        return Ok(Exit::Complete);
    }
    let mut text = String::from("stage            s each  parameter sets       core-hours\n");
    for stage in &stages {
        let [least, most] = stage.sets;
        let [low, high] = stage.core_h;
        let _ = writeln!(
            text,
            "{:<15}  {:>6.3}  {:<19}  {low:.2} to {high:.2}",
            stage.stage,
            stage.seconds_each,
            format!("{least} to {most}")
        );
    }
    let _ = write!(
        text,
        "{:.2} to {:.2} hours on {threads} threads, by how much is ruled out early",
        sum(0),
        sum(1)
    );
    if let Some(stage) = stages.first().filter(|stage| stage.sets_a_conflict > 0) {
        let _ = write!(
            text,
            "\nand up to {} parameter sets for each group of observations that conflict",
            stage.sets_a_conflict
        );
    }
    console.result(&text)?;
    Ok(Exit::Complete)
}

/// The largest memory demand of what a thread simulates at a time.
fn check_memory(problem: &MatchProblem, global: &GlobalArgs) -> Result<(), Failure> {
    let plan = problem.study.plan();
    let points = problem.study.points.iter();
    let demand = points
        .map(|point| Demand::run(&point.scene, &plan, true))
        .fold(Demand::default(), Demand::max);
    memory::check("the match", demand, global.threads())
}

fn wave_words(wave: &WaveReport, names: &[&str]) -> String {
    let mut words = format!("{}: {} tried, {} kept", wave.name, wave.tried, wave.kept);
    if !wave.left.is_empty() {
        let left = names
            .iter()
            .zip(&wave.left)
            .map(|(name, share)| format!("{name} {:.0} %", 100.0 * share));
        words.push_str(&format!(
            "; left of {}",
            left.collect::<Vec<_>>().join(", ")
        ));
    }
    words
}

/// The JSON of this program's commands.
pub(super) struct Commands;

impl Printed for Commands {
    fn run(&self, outcome: &Outcome, start_s: f64) -> Value {
        serde_json::to_value(RunJson::new(outcome, start_s, 0.0)).unwrap_or_default()
    }

    fn modes(&self, study: &Study, scene: &Scene) -> Result<Value, String> {
        modes::json_of(study, scene).map_err(|failure| failure.text())
    }

    fn steady(&self, study: &Study, scene: &Scene) -> Result<Value, String> {
        steady::json_of(study, scene).map_err(|failure| failure.text())
    }
}
