//! Stores: the table of critical shocks, and every simulation behind it.

use crate::failure::or_raise;
use opshock::cli::failure::Failure;
use opshock::cli::stored::{Source, loaded};
use opshock_study::report::answer::Answer;
use opshock_study::report::runs_table;
use opshock_study::store::Results;
use pyo3::prelude::*;
use serde_json::json;
use std::path::{Path, PathBuf};

type Read = (Results, Option<String>, Vec<String>);

fn read(folder: &Path) -> Result<Read, Failure> {
    let mut notes = Vec::new();
    let note = &mut |code: Option<&str>, message: &str| {
        notes.push(code.map_or(message.to_owned(), |code| format!("{code}: {message}")));
    };
    let (results, study) = loaded(&Source::of_folder(folder), note)?;
    Ok((results, study, notes))
}

/// The table of a store, its answer in words, its study with every default and the program that made it, as JSON.
#[pyfunction]
pub fn open_store(py: Python<'_>, folder: PathBuf) -> PyResult<String> {
    let (results, study, notes) = or_raise(py, py.detach(|| read(&folder)))?;
    let store = json!({
        "answer": Answer::of(&results.summary).sentences(),
        "table": results.summary,
        "program": results.session.program(),
        "study_toml": study,
        "warnings": notes,
    });
    Ok(store.to_string())
}

/// Every simulation of a store, as JSON.
#[pyfunction]
pub fn store_runs(py: Python<'_>, folder: PathBuf) -> PyResult<String> {
    let (results, ..) = or_raise(py, py.detach(|| read(&folder)))?;
    Ok(runs_table::json(&results)["runs"].to_string())
}
