//! `opshock yield`: which share of the drives that are built survives a specification? Run again, it resumes.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use super::long_run::LongRun;
use super::{memory, mode_shapes, stored, study_file, sweep};
use anyhow::Context as _;
use clap::Args;
use opshock_study::population::{
    Interrupted, Nominal, Part, Population, PopulationAnswer, STORE, Tolerances,
};
use opshock_study::provenance;
use opshock_study::qualification::Spec;
use opshock_study::report::populated::{self, Populated};
use opshock_study::store::aside;
use opshock_study::study::{StudyError, StudyErrors};
use std::path::PathBuf;
use std::time::Duration;

/// Find out which share of drives with tolerances survives a specification; run again, it resumes
#[derive(Args, Debug)]
pub struct YieldArgs {
    /// Study file
    study: PathBuf,
    /// Tolerance file: distributions of keys, number of drives
    #[arg(long, value_name = "FILE")]
    tolerances: PathBuf,
    /// Specification file: amplitudes, pulses, margins
    #[arg(long, value_name = "FILE")]
    spec: PathBuf,
    /// Folder for yield.html, .md, .csv, .json, .svg, .png, and the worst drives as studies
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Share that must survive, per cent: exit code 0 when it is shown, 8 when it is disproved, 4 when neither is
    #[arg(long, value_name = "PCT", value_parser = per_cent)]
    at_least: Option<f64>,
    /// Start nothing new after this time, save and end with exit code 5, as 7h30m
    #[arg(long, value_name = "TIME", value_parser = sweep::duration)]
    budget: Option<Duration>,
    /// Simulate one part of the drives, as 2/4, without an answer; another --store for each part
    #[arg(long, value_name = "K/N", value_parser = part, conflicts_with_all = ["at_least", "out"])]
    shard: Option<Part>,
    /// Store of another part, or of other drives, whose answers are taken; may be repeated
    #[arg(long, value_name = "STORE")]
    reuse: Vec<PathBuf>,
}

const ALL: Part = Part { number: 1, of: 1 };

fn per_cent(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok();
    value
        .filter(|value| *value > 0.0 && *value < 100.0)
        .ok_or_else(|| "must be a number between 0 and 100".to_owned())
}

fn part(text: &str) -> Result<Part, String> {
    let parts = text.split_once('/');
    let number = |text: &str| text.parse::<u64>().ok();
    let part = parts.and_then(|(k, n)| Some((number(k)?, number(n)?)));
    part.filter(|(number, of)| (1..=*of).contains(number) && *of <= 100_000)
        .map(|(number, of)| Part { number, of })
        .ok_or_else(|| "must be k/n with k from 1 to n, as 2/4".to_owned())
}

/// Runs the command.
pub fn run(arguments: &YieldArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let out = arguments.out.as_deref();
    out.map_or(Ok(()), |out| mode_shapes::check_folder("--out", out))?;
    let study = study_file::read(&arguments.study, global, console)?;
    let sets = study_file::sets(global)?;
    let tolerances = Tolerances::from_path(&arguments.tolerances, &arguments.study, &sets)?;
    let spec = Spec::from_path(&arguments.spec, &arguments.study, &sets)?;
    tolerances.check_spec(&spec)?;
    for requirement in &spec.requirements {
        study_file::refuse_unaccepted(&requirement.study, &global.accept)?;
    }
    let studies = spec.requirements.iter().map(|one| &one.study);
    let demand = memory::of_drives(studies, 1.0, 1);
    memory::check("the drives", demand, global.threads())?;
    let folder = match &global.store {
        Some(folder) => folder.clone(),
        None => stored::folder_of_study(&arguments.study, global).with_extension("yield"),
    };
    let running = LongRun::begin(arguments.budget, console)?;
    running.acknowledge_signals();
    let mut store = tolerances.open_store(&folder, STORE)?;
    for other in &arguments.reuse {
        store.reuse(other)?;
    }
    for note in &store.notes {
        console.note(&format!("warning: {note}"));
    }
    let nominal = spec.requirements.iter();
    let nominal: Vec<Nominal> = nominal.map(|one| Nominal::of(&one.study)).collect();
    let population = Population {
        nominal: &nominal,
        tolerances: &tolerances,
        spec: &arguments.spec,
        study: &arguments.study,
    };
    let part = arguments.shard.unwrap_or(ALL);
    let found = population.simulate(
        &mut store,
        part,
        global.threads(),
        &running.until,
        |done, of| {
            running.tell_progress(|| format!("{done} of {of} drives, {} s", running.seconds()));
        },
    );
    let drives = match found {
        Ok(drives) => drives,
        Err(Interrupted::Stopped) => return Ok(running.ended_early()),
        Err(Interrupted::Store(error)) => return Err(error.into()),
        Err(Interrupted::Refused(drive, values, errors)) => {
            return Err(refused(drive, &values, errors).into());
        }
    };
    if part != ALL {
        console.note(&format!(
            "{} drives of this part are there; run without --shard, with --reuse for every part's store, for the answer",
            drives.len()
        ));
        return Ok(Exit::Complete);
    }
    let answer = PopulationAnswer::of(&tolerances, &spec, &drives);
    let populated = Populated {
        study: &study.name,
        drive: &format!("{}{}", arguments.study.display(), sweep::settings(global)),
        program: &provenance::program(),
        tolerances: &tolerances,
        spec: &spec,
        drives: &drives,
        answer: &answer,
    };
    if let Some(out) = out {
        let files = populated::populated_files(&populated).context("cannot draw a figure")?;
        let written = aside::write_all(out, files)?;
        aside::remove_former(
            out,
            &written,
            &arguments.study,
            populated::file_of_a_population,
        )?;
        console.note(&format!(
            "wrote {} files into {}",
            written.len(),
            out.display()
        ));
    }
    if console.json {
        console.result_json(&populated::json(&populated))?;
    } else {
        console.result(&populated::text(&populated))?;
    }
    let Some(share) = arguments.at_least.map(|per_cent| per_cent / 100.0) else {
        return Ok(Exit::Complete);
    };
    let [low, high] = answer.all.survival;
    Ok(match () {
        () if low >= share => Exit::Complete,
        () if high < share => Exit::Failed,
        () => Exit::Open,
    })
}

/// The study's faults, with the drive that has them.
fn refused(drive: u64, values: &str, errors: StudyErrors) -> StudyErrors {
    let refused = errors.errors.into_iter().map(|mut fault: StudyError| {
        fault.message = format!(
            "{} (drive {drive} of the population: {values})",
            fault.message
        );
        fault.hint =
            "narrow the tolerances by a range, or correlate them, so that every drive can exist"
                .into();
        fault
    });
    StudyErrors::new(refused.collect())
}
