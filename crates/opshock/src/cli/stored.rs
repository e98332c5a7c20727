//! Finds and reads the store (a sweep's results) of a command: named itself, or by its study.

use super::console::Console;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::study_file;
use anyhow::Context as _;
use opshock_solver::simulation::Mechanism;
use opshock_study::report::{RunDot, Saving, ShockFilm, savings};
use opshock_study::store::folder::session;
use opshock_study::store::{self, Audit, Loaded, Owner, Results, StoreError, Summary};
use opshock_study::study::Study;
use opshock_study::sweep::added_points::refined;
use opshock_study::sweep::{SweepInput, replay};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Folder of the store of the study file at `path`: `--store`, else the file's name with `.opshock` in
/// place of `.toml`, beside it.
pub fn folder_of_study(path: &Path, global: &GlobalArgs) -> PathBuf {
    if let Some(folder) = &global.store {
        return folder.clone();
    }
    match path.extension() {
        Some(ending) if ending == "toml" => path.with_extension("opshock"),
        _ => path.with_added_extension("opshock"),
    }
}

/// A store that a command reads.
pub struct Source {
    /// Its folder.
    pub folder: PathBuf,
    /// The study whose results it has to hold; `None` where the store itself was named.
    study: Option<Study>,
}

impl Source {
    /// The store in a folder, of whatever study.
    pub fn of_folder(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            study: None,
        }
    }

    /// Whether a study was named, and not the store itself.
    pub fn is_of_study(&self) -> bool {
        self.study.is_some()
    }

    /// The study file named.
    pub fn file(&self) -> Option<&Path> {
        self.study.as_ref()?.file.as_deref()
    }

    /// Refuses a store that was made for other settings than the study named.
    ///
    /// # Errors
    ///
    /// E188.
    pub fn check(&self, owner: &Owner) -> Result<(), Failure> {
        if let Some(study) = &self.study {
            let (digest, resolved) = (study.digest_hex(), study.resolved_toml());
            owner.belongs(&self.folder, &study.path, &digest, &resolved)?;
        }
        Ok(())
    }
}

/// The store that `path`, a store or a study file, stands for.
///
/// # Errors
///
/// A path that is neither; a study that is not valid.
pub fn source(path: &Path, global: &GlobalArgs) -> Result<Source, Failure> {
    if path.is_dir() {
        Ok(Source::of_folder(path))
    } else if path.is_file() {
        Ok(Source {
            folder: folder_of_study(path, global),
            study: Some(Study::from_path(path, &study_file::sets(global)?)?),
        })
    } else {
        Err(Failure::Usage(vec![Fault {
            value: Some(path.display().to_string()),
            allowed: Some("a store or a study file".into()),
            hint: Some("run `opshock sweep STUDY` first".into()),
            ..Fault::new("usage", format!("{} does not exist", path.display()))
        }]))
    }
}

/// What a store holds.
pub struct Stored {
    /// Critical shocks.
    pub summary: Summary,
    /// Every simulation behind them, `point` a row of the summary.
    pub runs: Vec<RunDot>,
    /// The study with every default.
    pub resolved_study: Option<String>,
    /// The last audit.
    pub audit: Option<Audit>,
    /// What the rules saved.
    pub savings: Vec<Saving>,
    /// Effects and rules, as JSON.
    pub plan: String,
}

/// Reads everything finished in a store, and warns of what is wrong with it.
///
/// # Errors
///
/// A store that is empty, damaged, newer or of another study.
pub fn read(source: &Source, console: &Console) -> Result<Stored, Failure> {
    let (results, study) = load(source, console)?;
    Ok(Stored::of(&source.folder, &results, study, &HashMap::new()))
}

impl Stored {
    /// What `results` of the store in `folder` say of its study, and what lies beside them; with the `mechanisms` that
    /// [`Results::mechanisms`] found, where they are wanted.
    pub fn of(
        folder: &Path,
        results: &Results,
        resolved_study: Option<String>,
        mechanisms: &HashMap<usize, Mechanism>,
    ) -> Self {
        let runs = results
            .runs
            .iter()
            .enumerate()
            // Runs with changed discretisation parameters may end otherwise: not outcomes of the study.
            .filter(|(_, row)| row.levels.is_none())
            .map(|(place, row)| RunDot {
                point: row.point,
                amplitude_g: row.amplitude_g,
                verdict: row.result().verdict.as_str().to_owned(),
                h_min_m: row.result().h_min_m,
                mechanism: mechanisms.get(&place).copied(),
            });
        Self {
            savings: savings(results),
            audit: Audit::of_store(folder, &results.summary.digest),
            summary: results.summary.clone(),
            plan: results.plan.clone(),
            runs: runs.collect(),
            resolved_study,
        }
    }
}

/// As [`read`], with every simulation.
///
/// # Errors
///
/// As [`read`].
pub fn results(source: &Source, console: &Console) -> Result<Results, Failure> {
    Ok(load(source, console)?.0)
}

/// As [`results`], and the study with every default.
///
/// # Errors
///
/// As [`read`].
pub fn load(source: &Source, console: &Console) -> Result<(Results, Option<String>), Failure> {
    loaded(source, &mut |code, message| {
        let code = code.map_or(String::new(), |code| format!("{code}: "));
        console.note(&format!("warning: {code}{message}"));
    })
}

/// As [`load`]; what is wrong with the store goes to `note`, code (if there is one) and sentence.
///
/// # Errors
///
/// As [`read`].
pub fn loaded(
    source: &Source,
    note: &mut dyn FnMut(Option<&str>, &str),
) -> Result<(Results, Option<String>), Failure> {
    let (mut loaded, results) = store::load(&source.folder)?;
    for (code, message) in &loaded.notes {
        note(Some(code), message);
    }
    let owner = owner(&mut loaded, &source.folder)?;
    source.check(&owner)?;
    // Simulations finished, or a study changed, after the last checkpoint are not in it: then the
    // searches are replayed from the journal.
    let results = results.filter(|results| results.summary.digest == owner.digest);
    let n_runs = loaded.runs.len();
    let newer =
        |results: &Results| n_runs.saturating_sub(results.runs.len() + results.outside.len());
    if results.as_ref().is_some_and(|results| newer(results) == 0) {
        return Ok((results.expect("was found"), owner.resolved));
    }
    let text = owner.resolved.as_deref().unwrap_or_default();
    match (replayed(text, loaded), results) {
        (Ok(replayed), _) => Ok((replayed, owner.resolved)),
        // A study of another version of the program: what was saved last is still a table.
        (Err(_), Some(results)) => {
            let message = format!(
                "{} simulations are newer than results.h5 and not shown: this program does not read \
                 the study that the store keeps",
                newer(&results)
            );
            note(None, &message);
            Ok((results, owner.resolved))
        }
        (Err(error), None) => Err(error),
    }
}

/// The study that the store in `folder` says it belongs to.
///
/// # Errors
///
/// E182: nothing of it is left.
pub fn owner(loaded: &mut Loaded, folder: &Path) -> Result<Owner, StoreError> {
    let owner = loaded.owner.take();
    let known = owner.filter(|owner| !owner.digest.is_empty());
    known.ok_or_else(|| StoreError::Damaged {
        path: folder.join("journal"),
        what: "it does not hold its study, and study.resolved.toml is missing".into(),
        hint: "`opshock sweep` of its study writes both anew and uses what is whole",
    })
}

/// The kept shock that a report shows moving: the first, by name, of a deformable ramp that fails,
/// else the first that can be shown.
///
/// # Errors
///
/// E182: a history is damaged; E183: one cannot be read.
pub fn film(
    folder: &Path,
    results: &Results,
    resolved_study: &str,
) -> Result<Option<ShockFilm>, StoreError> {
    let mut kept: Vec<_> = results.kept_runs().collect();
    kept.sort_by_cached_key(|run| (run.ramp != "deformable", run.path(folder)));
    let mut shown = None;
    for run in kept {
        let Some(history) = run.read(folder)? else {
            continue;
        };
        let Some(film) = ShockFilm::of(&history, resolved_study) else {
            continue;
        };
        if history.verdict == "fails" {
            return Ok(Some(film));
        }
        shown.get_or_insert(film);
    }
    Ok(shown)
}

/// What is finished in a store; nothing for one that is empty or missing.
///
/// # Errors
///
/// A store that is damaged or newer.
pub fn finished(folder: &Path) -> Result<Loaded, Failure> {
    match store::load(folder) {
        Ok((loaded, _)) => Ok(loaded),
        Err(StoreError::Empty { .. }) => Ok(Loaded::default()),
        Err(error) => Err(error.into()),
    }
}

/// The table from finished simulations.
///
/// # Errors
///
/// This program does not read the study.
fn replayed(resolved_study: &str, loaded: Loaded) -> Result<Results, Failure> {
    let study = Study::from_text(resolved_study, &[])?;
    let no_range = "the study has no amplitudes to search";
    let refined = refined(&study, &loaded).context(no_range)?;
    let input = SweepInput::of(&refined).context(no_range)?;
    Ok(replay(&input, loaded, &session(1)))
}
