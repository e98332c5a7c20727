//! `opshock claims`: judges the paper's statements by this program's numbers.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::figures::{critical_shocks, swept};
use super::global::GlobalArgs;
use super::{memory, study_file};
use anyhow::Context as _;
use clap::Args;
use opshock_paper::claims::{
    Case, ClaimTable, Finding, Sensitivity, ShockError, Shocks, Task, Variant, coarse_sets,
    findings, merged, rows, shock_sets, touched_ramps, with_sets, write_claims, write_sensitivity,
};
use opshock_solver::scene::Scene;
use opshock_solver::scene::discretisation::{Discretisation, Levels};
use opshock_study::provenance;
use opshock_study::store::Summary;
use opshock_study::study::memory::Demand;
use opshock_study::study::{Ramp, Study};
use opshock_study::sweep::{Ending, Physics, Silent, StopFlag, SweepInput, SweepOptions, sweep};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Judge the paper's statements: number, uncertainty, holds or not, and on what it depends
#[derive(Args, Debug)]
pub struct ClaimsArgs {
    /// Study file
    study: PathBuf,
    /// Folder of claims.md, claims.csv and claims.json, and of the sensitivity
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Critical shocks [default: the store of the study, when it has been swept]
    #[arg(long, value_name = "STORE|TABLE.csv")]
    critical: Option<PathBuf>,
    /// Move every parameter that the paper does not print, and keep the searches in a folder; run
    /// again, it resumes
    #[arg(long, value_name = "DIR")]
    sensitivity: Option<PathBuf>,
    /// Leave the searches out: only statements about the two shocks are tried
    #[arg(long, requires = "sensitivity")]
    shocks_only: bool,
}

/// Runs the command.
pub fn run(
    arguments: &ClaimsArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let study = study_file::read(&arguments.study, global, console)?;
    if arguments.sensitivity.is_some() && arguments.out.is_none() {
        return Err(Failure::Usage(vec![Fault {
            key: Some("--sensitivity".into()),
            allowed: Some("--out DIR beside it".into()),
            ..Fault::new("usage", "--sensitivity needs a folder for its products")
        }]));
    }
    let critical = match &arguments.critical {
        Some(named) => Some(critical_shocks(named, console)?),
        None => swept(
            &arguments.study,
            global,
            console,
            "section 4.3 is not asked",
        )?,
    };
    let runner = Runner::new(global)?;
    let asked = with_sets(&study, &study_file::sets(global)?, &[&shock_sets()])?;
    let (own, finer) = runner.with_finer_discretisations(&asked)?;
    let summary = critical.as_ref().map(|(summary, _)| summary);
    let found = findings(&own, summary);
    let finer: Vec<(String, Vec<Option<Finding>>)> = finer
        .iter()
        .map(|(discretisation, shocks)| ((*discretisation).to_owned(), findings(shocks, None)))
        .collect();

    let sensitivity = match (&arguments.sensitivity, &arguments.out) {
        (Some(kept), _) => {
            let Some(all) = runner.sensitivity(
                &study,
                &own,
                global,
                (!arguments.shocks_only).then_some(kept.as_path()),
                console,
            )?
            else {
                console.note("saved; run again to go on");
                return Ok(Exit::Budget);
            };
            Some(all)
        }
        (None, Some(out)) => known_sensitivity(out, &study, console),
        (None, None) => None,
    };
    let table = ClaimTable {
        study: study.path.display().to_string(),
        digest: study.digest_hex(),
        program: provenance::program(),
        critical: critical.map(|(_, source)| source),
        has_sensitivity: sensitivity.is_some(),
        claims: rows(found, &finer, sensitivity.as_ref()),
    };
    let mut written = Vec::new();
    if let Some(out) = &arguments.out {
        // Both, so that they say the same.
        if let Some(all) = &sensitivity {
            written.extend(write_sensitivity(out, all, &table.claims)?);
        }
        written.extend(write_claims(out, &table)?);
    }
    for path in written {
        console.note(&format!("wrote {}", path.display()));
    }
    if console.json {
        console.result_json(&table)?;
    } else {
        console.result(&table.markdown())?;
    }
    Ok(Exit::Complete)
}

/// The sensitivity that lies in the folder, when it is of this study and this physics.
fn known_sensitivity(out: &Path, study: &Study, console: &Console) -> Option<Sensitivity> {
    let path = out.join("sensitivity.json");
    let text = std::fs::read_to_string(&path).ok()?;
    match serde_json::from_str::<Sensitivity>(&text) {
        Ok(known) if known.is_of(study) => Some(known),
        Ok(_) => {
            console.note(&format!(
                "{}: of another study or physics version, not used",
                path.display()
            ));
            None
        }
        Err(error) => {
            console.note(&format!("{}: {error}, not used", path.display()));
            None
        }
    }
}

/// A discretisation parameter, and the shocks with it refined by one step.
type Finer = (&'static str, Shocks);

/// Runs shocks and coarse searches on the asked number of threads.
struct Runner {
    pool: rayon::ThreadPool,
    threads: usize,
}

impl Runner {
    fn new(global: &GlobalArgs) -> Result<Runner, Failure> {
        let threads = global.threads();
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .context("cannot start threads")?;
        Ok(Runner { pool, threads })
    }

    /// Runs tasks; those with the same scene and amplitude as a known run take it over.
    fn run(
        &self,
        tasks: &[Task],
        known: &[(Scene, Arc<Case>)],
    ) -> Result<Vec<Arc<Case>>, ShockError> {
        let run = |(place, task): (usize, &Task)| match known.get(place) {
            Some((scene, case)) if scene == task.scene() => Ok(Arc::new(task.shifted(case))),
            _ => task.run().map(Arc::new),
        };
        self.pool
            .install(|| tasks.par_iter().enumerate().map(run).collect())
    }

    fn with_finer_discretisations(&self, study: &Study) -> Result<(Shocks, Vec<Finer>), Failure> {
        let tasks = |levels| Shocks::tasks(study, levels).map_err(shock_failure);
        let own = tasks(Levels::NONE)?;
        let finer = Discretisation::ALL.map(|discretisation| {
            Ok((
                discretisation,
                tasks(Levels::NONE.changed(discretisation, 1))?,
            ))
        });
        let all_finer = finer.into_iter().collect::<Result<Vec<_>, Failure>>()?;
        let all = all_finer.iter().flat_map(|(_, tasks)| tasks).chain(&own);
        let demand = all
            .clone()
            .map(Task::demand)
            .fold(Demand::default(), Demand::max);
        // The histories of all stay.
        let models = all.map(|task| task.demand().steps).sum();
        memory::check("the shocks", Demand { models, ..demand }, self.threads)?;
        let cases = self.run(&own, &[]).map_err(shock_failure)?;
        // What is not refined is the same scene.
        let scenes = own.iter().map(|task| task.scene().clone());
        let known: Vec<_> = scenes.zip(cases.iter().cloned()).collect();
        let mut finer = Vec::new();
        for (discretisation, tasks) in all_finer {
            let cases = self.run(&tasks, &known).map_err(shock_failure)?;
            finer.push((discretisation.as_str(), Shocks::of(cases)));
        }
        Ok((Shocks::of(cases), finer))
    }

    /// `None` when a signal stopped it. Without a folder to keep them in there are no searches.
    fn sensitivity(
        &self,
        study: &Study,
        own: &Shocks,
        global: &GlobalArgs,
        kept: Option<&Path>,
        console: &Console,
    ) -> Result<Option<Sensitivity>, Failure> {
        let stop = StopFlag::default();
        stop.listen().context("cannot listen to signals")?;
        let user = study_file::sets(global)?;
        let read = |sets: &[&[String]]| with_sets(study, &user, sets);
        let coarse = read(&[&coarse_sets()])?;
        let base = match kept {
            None => None,
            Some(kept) => match self.search(&coarse, &kept.join("study"), &stop)? {
                None => return Ok(None),
                found => found,
            },
        };
        let asked = read(&[&shock_sets()])?;
        let scenes = Shocks::tasks(&asked, Levels::NONE).map_err(shock_failure)?;
        let known: Vec<(Scene, Arc<Case>)> = scenes
            .iter()
            .map(|task| task.scene().clone())
            .zip(own.cases())
            .collect();
        let mut found = Vec::new();
        let variants = Variant::all(study);
        let count = variants.len();
        for (place, variant) in variants.into_iter().enumerate() {
            console.note(&format!(
                "{} of {count}: {}",
                place + 1,
                variant.sets.join(" ")
            ));
            let moved = read(&[&shock_sets(), &variant.sets])?;
            let tasks = Shocks::tasks(&moved, Levels::NONE).map_err(shock_failure)?;
            let shocks = match self.run(&tasks, &known) {
                Ok(cases) => Shocks::of(cases),
                Err(error) => {
                    console.note(&format!("warning: no answer: {error}"));
                    found.push((variant, None));
                    continue;
                }
            };
            let table = match (&base, kept) {
                (Some(base), Some(kept)) => {
                    let moved = read(&[&coarse_sets(), &variant.sets])?;
                    let touched = touched_ramps(&coarse, &moved);
                    if touched.is_empty() {
                        Some(base.clone())
                    } else {
                        let only = ramps_set(&touched);
                        let moved = read(&[&coarse_sets(), &variant.sets, &only])?;
                        let folder = kept.join(variant.stem());
                        let Some(changed) = self.search(&moved, &folder, &stop)? else {
                            return Ok(None);
                        };
                        Some(merged(base, &changed))
                    }
                }
                _ => None,
            };
            found.push((variant, Some((shocks, table))));
        }
        let program = provenance::program();
        let all = Sensitivity::of(study, &program, (own, base.as_ref()), &found);
        Ok(Some(all))
    }

    /// A sweep kept in its own store; `None` when a signal stopped it.
    fn search(
        &self,
        study: &Study,
        folder: &Path,
        stop: &StopFlag,
    ) -> Result<Option<Summary>, Failure> {
        let mut store = folder.as_os_str().to_owned();
        store.push(".opshock");
        let store = PathBuf::from(store);
        memory::check("the sweep", memory::of_sweep(study), self.threads)?;
        let input = SweepInput::of(study).context("the study has no amplitudes to search")?;
        let options = SweepOptions {
            stop: stop.clone(),
            ..SweepOptions::with_threads(self.threads)
        };
        let end = sweep(&input, &Physics::of(study), &store, &options, &Silent)?;
        Ok((end.ending == Ending::Complete).then_some(end.summary))
    }
}

fn ramps_set(ramps: &[Ramp]) -> Vec<String> {
    let words: Vec<String> = ramps
        .iter()
        .map(|ramp| format!("{:?}", ramp.as_str()))
        .collect();
    vec![format!("ramp.models=[{}]", words.join(", "))]
}

fn shock_failure(error: ShockError) -> Failure {
    match error {
        ShockError::Choice(error) => error.into(),
        ShockError::Scene { label, reason } => {
            Failure::Usage(vec![Fault::new("scene", format!("{label}: {reason}"))])
        }
    }
}
