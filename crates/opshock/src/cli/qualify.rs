//! `opshock qualify`: does a drive meet a specification? Run again, it resumes.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::long_run::LongRun;
use super::{memory, mode_shapes, stored, study_file, sweep};
use anyhow::Context as _;
use clap::Args;
use opshock_study::provenance;
use opshock_study::qualification::{Spec, Verdict};
use opshock_study::report::qualified::{self, Boundary, Qualified, Tested};
use opshock_study::store::names::{JOURNAL_FILE, RESULTS_FILE};
use opshock_study::store::{Summary, aside};
use opshock_study::study::Study;
use opshock_study::sweep::{Ending, Physics, ProgressKind, SweepInput, SweepOptions};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Find out whether a drive meets a specification: passes, fails or undecided for each requirement; run again, it resumes
#[derive(Args, Debug)]
pub struct QualifyArgs {
    /// Study file
    study: PathBuf,
    /// Specification file: amplitudes, pulses, margins
    #[arg(long, value_name = "FILE")]
    spec: PathBuf,
    /// Folder for qualification.html, .md, .csv, .json and .xml (JUnit), and damage_boundary.csv, .svg and .png
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Start nothing that would end after this time, save and end with exit code 5, as 7h30m
    #[arg(long, value_name = "TIME", value_parser = sweep::duration)]
    budget: Option<Duration>,
}

/// Folder of the damage boundary beside those of the requirements, none of whose names begins with a dot.
const BOUNDARY_FOLDER: &str = ".damage_boundary";

/// Runs the command.
pub fn run(
    arguments: &QualifyArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let out = arguments.out.as_deref();
    out.map_or(Ok(()), |out| mode_shapes::check_folder("--out", out))?;
    let study = study_file::read(&arguments.study, global, console)?;
    let sets = study_file::sets(global)?;
    let spec = Spec::from_path(&arguments.spec, &arguments.study, &sets)?;
    let of_requirements = spec.requirements.iter().map(|one| &one.study);
    for study in of_requirements.chain(&spec.damage_boundary) {
        study_file::refuse_unaccepted(study, &global.accept)?;
        let available = memory::available_bytes();
        let of_sweep = memory::of_sweep(study);
        of_sweep.check("the sweep", global.threads(), available)?;
    }
    let base = base(arguments, global);
    refuse_store(&base)?;
    let folders = folders(&base, &spec);
    let running = LongRun::begin(arguments.budget, console)?;
    let options = |reuse: &[PathBuf]| SweepOptions {
        stop: running.until.stop.clone(),
        budget: running.until.left(),
        reuse: reuse.to_vec(),
        ..SweepOptions::with_threads(global.threads())
    };
    let mut summaries = Vec::new();
    for (place, requirement) in spec.requirements.iter().enumerate() {
        // Requirements that differ in their amplitude alone share simulations.
        let options = options(&folders[..place]);
        let (study, folder) = (&requirement.study, &folders[place]);
        let (summary, ending) = answered(study, folder, &options, global, console)?;
        if ending != Ending::Complete {
            return Ok(running.ended_early());
        }
        summaries.push(summary);
    }
    let mut boundary = None;
    if let Some(study) = &spec.damage_boundary {
        let folder = base.join(&spec.name).join(BOUNDARY_FOLDER);
        let (summary, ending) = answered(study, &folder, &options(&folders), global, console)?;
        match ending {
            Ending::Complete => boundary = Boundary::of(study, &summary),
            // The verdict does not rest on it.
            _ => console.note(
                "the damage boundary is not finished; run the same command again to go on with it",
            ),
        }
    }
    let tested = spec.requirements.iter().zip(&summaries);
    let qualified = Qualified {
        study: &study.name,
        drive: &format!("{}{}", arguments.study.display(), sweep::settings(global)),
        program: &provenance::program(),
        spec: &spec,
        tested: tested
            .map(|(requirement, summary)| Tested::of(requirement, summary))
            .collect(),
        boundary,
    };
    if let Some(out) = out {
        let files = qualified::qualified_files(&qualified).context("cannot draw a figure")?;
        let written = aside::write_all(out, files)?;
        aside::remove_former(out, &written, &arguments.study, qualified::optional_file)?;
        for path in written {
            console.note(&format!("wrote {}", path.display()));
        }
    }
    if console.json {
        console.result_json(&qualified::json(&qualified))?;
    } else {
        console.result(&qualified::text(&qualified))?;
        if qualified.verdict() == Verdict::Undecided {
            console.note(
                "what its interval leaves undecided may be decided by a smaller target: --set search.target_uncertainty_pct=0.3, or --set resolution.preset=fine",
            );
        }
    }
    Ok(match qualified.verdict() {
        Verdict::Passes => Exit::Complete,
        Verdict::Fails => Exit::Failed,
        Verdict::Undecided => Exit::Open,
    })
}

/// Folder of the stores, one for each requirement: `--store`, else `STUDY.qualify` beside the study file.
fn base(arguments: &QualifyArgs, global: &GlobalArgs) -> PathBuf {
    match &global.store {
        Some(folder) => folder.clone(),
        None => stored::folder_of_study(&arguments.study, global).with_extension("qualify"),
    }
}

/// A store for each requirement, by the names of specification and requirement.
fn folders(base: &Path, spec: &Spec) -> Vec<PathBuf> {
    let names = spec.requirements.iter().map(|one| &one.name);
    names.map(|name| base.join(&spec.name).join(name)).collect()
}

/// A store has no room for others.
fn refuse_store(base: &Path) -> Result<(), Failure> {
    let is_store = [JOURNAL_FILE, RESULTS_FILE]
        .iter()
        .any(|name| base.join(name).exists());
    if !is_store {
        return Ok(());
    }
    Err(Failure::Usage(vec![Fault {
        key: Some("--store".into()),
        value: Some(base.display().to_string()),
        allowed: Some("a folder for the stores of the requirements".into()),
        ..Fault::new("usage", format!("{} is a store of a sweep", base.display()))
    }]))
}

/// Critical shocks of a study's points.
fn answered(
    study: &Study,
    folder: &Path,
    options: &SweepOptions,
    global: &GlobalArgs,
    console: &Console,
) -> Result<(Summary, Ending), Failure> {
    let input = SweepInput::of(study).context("the study has no amplitudes to search")?;
    let kind = if console.quiet {
        ProgressKind::Warnings
    } else {
        global.progress.into()
    };
    let progress = kind.start(&study.name);
    let end = opshock_study::sweep::sweep(
        &input,
        &Physics::of(study),
        folder,
        options,
        progress.as_ref(),
    )?;
    Ok((end.summary, end.ending))
}
