//! The store a command reads: named itself, or by its study.

use super::GlobalArgs;
use super::console::Console;
use super::failure::{Failure, Fault};
use crate::report::{RunDot, Saving, ShockFilm, savings};
use crate::store::files::list;
use crate::store::folder::session;
use crate::store::history::read_hdf5;
use crate::store::{self, Audit, Loaded, Results, StoreError, Summary};
use crate::study::Study;
use crate::sweep::refine::refined;
use crate::sweep::{SweepInput, replay};
use std::path::{Path, PathBuf};

/// Folder of the store of the study at `path`: `--store`, else `STUDYFOLDER.opshock` in the
/// working directory.
pub fn folder_of_study(path: &Path, global: &GlobalArgs) -> PathBuf {
    if let Some(folder) = &global.store {
        return folder.clone();
    }
    let folder = std::path::absolute(path).ok();
    let name = folder
        .as_deref()
        .and_then(Path::parent)
        .and_then(Path::file_name)
        .map_or_else(|| "study".into(), std::ffi::OsStr::to_os_string);
    PathBuf::from(name).with_added_extension("opshock")
}

/// Folder of the store that `path`, a store or a study file, stands for.
///
/// # Errors
///
/// A path that is neither.
pub fn folder(path: &Path, global: &GlobalArgs) -> Result<PathBuf, Failure> {
    if path.is_dir() {
        Ok(path.to_owned())
    } else if path.is_file() {
        Ok(folder_of_study(path, global))
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

/// Reads everything finished in a store, and tells what is wrong with it.
///
/// # Errors
///
/// A store that is empty, damaged or newer.
pub fn read(folder: &Path, console: &Console) -> Result<Stored, Failure> {
    let results = results(folder, console)?;
    let runs: Vec<RunDot> = results
        .runs
        .iter()
        // With turned knobs the same amplitude may end otherwise: not an outcome of the study.
        .filter(|row| row.levels.is_none())
        .map(|row| RunDot {
            point: row.point,
            amplitude_g: row.amplitude_g,
            verdict: row.result().verdict.as_str().to_owned(),
            h_min_m: row.result().h_min_m,
        })
        .collect();
    Ok(Stored {
        savings: savings(&results),
        audit: Audit::of_store(folder, &results.summary.digest),
        summary: results.summary,
        plan: results.plan,
        runs,
        resolved_study: resolved_study(folder),
    })
}

/// As [`read`], in full.
///
/// # Errors
///
/// As [`read`].
pub fn results(folder: &Path, console: &Console) -> Result<Results, Failure> {
    let (loaded, results) = store::load(folder)?;
    for (code, message) in &loaded.notes {
        console.tell(&format!("warning: {code}: {message}"));
    }
    let checkpointed = results
        .as_ref()
        .map_or(0, |results| results.runs.len() + results.outside.len());
    // Simulations finished after the last checkpoint count too: the searches are played again.
    let newer = (loaded.runs.len() > checkpointed)
        .then(|| replayed(&resolved_study(folder)?, loaded))
        .flatten();
    let empty = || StoreError::Empty {
        path: folder.to_owned(),
    };
    Ok(newer.or(results).ok_or_else(empty)?)
}

/// The kept shock that a report shows moving: the first, by name, of a deformable ramp that fails,
/// else the first that can be shown.
pub fn film(folder: &Path, resolved_study: &str) -> Option<ShockFilm> {
    let mut paths = list(&folder.join("histories")).ok()?;
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "h5"));
    let is_deformable = |path: &&PathBuf| {
        path.file_name()
            .is_some_and(|name| name.to_string_lossy().starts_with("deformable"))
    };
    let first = paths.iter().filter(is_deformable);
    let mut shown = None;
    for path in first.chain(paths.iter()) {
        let Ok(history) = read_hdf5(path) else {
            continue;
        };
        let Some(film) = ShockFilm::of(&history, resolved_study) else {
            continue;
        };
        if history.verdict == "fails" {
            return Some(film);
        }
        shown.get_or_insert(film);
    }
    shown
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

fn resolved_study(folder: &Path) -> Option<String> {
    std::fs::read_to_string(folder.join("study.resolved.toml")).ok()
}

/// The table from finished simulations; `None` when this program does not read the study.
fn replayed(resolved_study: &str, loaded: Loaded) -> Option<Results> {
    let study = Study::from_text(resolved_study, &[]).ok()?;
    let input = SweepInput::of(&refined(&study, &loaded).ok()?).ok()?;
    Some(replay(&input, loaded, &session(1)))
}
