//! `opshock worth`: by how much does a tolerance change the critical shock? Run again, it resumes.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use super::long_run::LongRun;
use super::{memory, mode_shapes, stored, study_file, sweep};
use anyhow::Context as _;
use clap::Args;
use opshock_study::population::{Interrupted, Tolerances};
use opshock_study::provenance;
use opshock_study::report::valued::{self, Valued};
use opshock_study::store::aside;
use opshock_study::study::{SetArg, Study};
use opshock_study::sweep::{ProgressKind, SweepInput};
use opshock_study::worth::{ENDS, STORE, Worth, WorthAnswer};
use std::path::PathBuf;
use std::time::Duration;

/// Find out by how much each tolerance changes the critical shocks of a study; run again, it resumes
#[derive(Args, Debug)]
pub struct WorthArgs {
    /// Study file
    study: PathBuf,
    /// Tolerance file: distributions of keys
    #[arg(long, value_name = "FILE")]
    tolerances: PathBuf,
    /// Folder for worth.html, .md, .csv and .json
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Start nothing new after this time, save and end with exit code 5, as 7h30m
    #[arg(long, value_name = "TIME", value_parser = sweep::duration)]
    budget: Option<Duration>,
}

/// Settings laid over the study: the pairs have uncertainties of their own.
const SETS: [&str; 2] = ["search.uncertainty=false", "outputs=[\"critical_shock\"]"];

/// Runs the command.
pub fn run(arguments: &WorthArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    let out = arguments.out.as_deref();
    out.map_or(Ok(()), |out| mode_shapes::check_folder("--out", out))?;
    let study = study_file::read(&arguments.study, global, console)?;
    let mut sets = study_file::sets(global)?;
    for text in SETS {
        let argument = SetArg::parse(text).context("a setting")?;
        sets.retain(|known| known.key != argument.key);
        sets.push(argument);
    }
    let nominal = Study::from_path(&arguments.study, &sets)?;
    let tolerances = Tolerances::from_path(&arguments.tolerances, &arguments.study, &sets)?;
    study_file::refuse_unaccepted(&nominal, &global.accept)?;
    memory::check(
        "the pairs",
        memory::of_drives([&nominal], 2.0, nominal.search.max_refinements.min(2)),
        global.threads(),
    )?;
    let places = 0..tolerances.parameters.len();
    let ends = places.map(|place| tolerances.studies_at(place, ENDS));
    let ends: Vec<[Study; 2]> = ends.collect::<Result<_, _>>()?;
    let folder = match &global.store {
        Some(folder) => folder.clone(),
        None => stored::folder_of_study(&arguments.study, global).with_extension("worth"),
    };
    let running = LongRun::begin(arguments.budget, console)?;
    let mut store = tolerances.open_store(&folder, STORE)?;
    for note in &store.notes {
        console.note(&format!("warning: {note}"));
    }
    // Where the pairs begin: critical shocks as a sweep finds them.
    SweepInput::of(&nominal).context("the study has no amplitudes to search")?;
    let kind = match console.quiet {
        true => ProgressKind::Warnings,
        false => global.progress.into(),
    };
    let worth = Worth::new(&nominal, &ends);
    let (threads, until) = (global.threads(), &running.until);
    let found = worth.starts(&folder.join("critical"), threads, until, kind);
    let found = found.and_then(|starts| {
        running.acknowledge_signals();
        worth.simulate(&starts, &mut store, threads, until, |done, of| {
            running.tell_progress(|| format!("{done} of {of} pairs, {} s", running.seconds()));
        })
    });
    let pairs = match found {
        Ok(pairs) => pairs,
        Err(Interrupted::Store(error)) => return Err(error.into()),
        Err(Interrupted::Stopped | Interrupted::Refused(..)) => return Ok(running.ended_early()),
    };
    let answer = WorthAnswer::of(&tolerances, &nominal, &pairs);
    let valued = Valued {
        study: &study.name,
        drive: &format!("{}{}", arguments.study.display(), sweep::settings(global)),
        program: &provenance::program(),
        tolerances: &tolerances.text,
        answer: &answer,
    };
    if let Some(out) = out {
        for path in aside::write_all(out, valued::valued_files(&valued))? {
            console.note(&format!("wrote {}", path.display()));
        }
    }
    if console.json {
        console.result_json(&valued::json(&valued))?;
    } else {
        console.result(&valued::text(&valued))?;
    }
    let is_open = |row: &opshock_study::worth::WorthRow| {
        row.changes.iter().any(|change| change.change_g.is_none())
    };
    Ok(match answer.rows.iter().any(is_open) {
        true => Exit::Open,
        false => Exit::Complete,
    })
}
