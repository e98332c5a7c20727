//! Writes `results.h5`.

use std::path::Path;

use hdf5::Group;

use super::columns::{self, group, put_number, put_text, texts};
use super::point_columns::{axis_columns, bracket_columns, keep_columns, point_columns};
use super::rows::{RESULTS_FORMAT, Results};
use super::run_columns::{history_column, row_columns, run_columns, time_columns};
use crate::search::amplitude_grid::REFERENCE_G;
use crate::store::error::StoreError;
use crate::store::record::RunRecord;
use crate::store::{aside, hdf5_file, seal};

/// Replaces `path` by these results of the store in `store`: made and sealed in memory, written aside, synced, renamed.
///
/// # Errors
///
/// The folder cannot be written; the old file is then whole and in place.
pub fn write(path: &Path, results: &Results, store: &Path) -> Result<(), StoreError> {
    aside::write(path, &bytes(path, results, store)?)
}

/// The bytes of these results, sealed; `path` is only named in the error. Each run names its history when `store` holds
/// one.
///
/// # Errors
///
/// E183: out of memory.
pub fn bytes(path: &Path, results: &Results, store: &Path) -> Result<Vec<u8>, StoreError> {
    hdf5_file::bytes(|root| fill(root, results, store))
        .map(seal::seal)
        .map_err(|error| StoreError::not_made(path, &error))
}

fn fill(root: &Group, results: &Results, store: &Path) -> hdf5::Result<()> {
    let Results {
        summary, session, ..
    } = results;
    put_text(root, "format", "opshock results")?;
    put_number(root, "format_version", RESULTS_FORMAT)?;
    put_text(
        root,
        "description",
        "critical shocks of a study and the simulations behind them",
    )?;
    put_text(root, "program_version", &session.program_version)?;
    put_text(root, "commit", &session.commit)?;
    put_number(root, "physics_structure", session.physics_structure)?;
    put_number(root, "physics_head", session.physics_head)?;
    put_text(root, "study", &summary.study)?;
    put_text(root, "study_digest", &summary.digest)?;
    put_text(root, "axes", &summary.axes.join(" "))?;
    put_number(root, "steps_per_octave", results.steps_per_octave)?;
    put_number(root, "reference_g", REFERENCE_G)?;
    put_number(root, "start_s", results.start_s)?;
    put_text(root, "plan", &results.plan)?;
    put_text(root, "content_blake3", &results.content_digest())?;

    let points = group(root, "points", "a row per point of the study")?;
    columns::write(&points, &point_columns(summary))?;
    columns::write(&points, &keep_columns(results))?;
    let axes = group(&points, "axes", "settings that the study varies, by point")?;
    columns::write(&axes, &axis_columns(summary))?;

    let brackets = group(
        root,
        "brackets",
        "every surviving amplitude with the next higher one, which fails: by point, rising",
    )?;
    columns::write(&brackets, &bracket_columns(summary))?;

    let runs = group(root, "runs", "a row per simulation, by point and sequence")?;
    columns::write(&runs, &row_columns(&results.runs))?;
    columns::write(&runs, &[history_column(results, store)])?;
    let records: Vec<&RunRecord> = results.runs.iter().map(|row| &row.run).collect();
    columns::write(&runs, &run_columns(&records, results.start_s))?;

    let machine = group(
        root,
        "machine",
        "what depends on machine, threads and time of day",
    )?;
    fill_machine(&machine, results, &records)
}

fn fill_machine(at: &Group, results: &Results, records: &[&RunRecord]) -> hdf5::Result<()> {
    let session = &results.session;
    put_text(at, "host", &session.host)?;
    put_number(at, "process", session.process)?;
    put_number(at, "threads", session.threads as u64)?;
    put_number(at, "started_unix_s", session.started_unix_s)?;
    put_number(at, "written_unix_s", results.written_unix_s)?;
    put_text(at, "os", std::env::consts::OS)?;
    put_text(at, "architecture", std::env::consts::ARCH)?;
    let runs = group(at, "runs", "a row per row of /runs")?;
    columns::write(&runs, &time_columns(records))?;
    let records: Vec<&RunRecord> = results.outside.iter().collect();
    let outside = group(
        at,
        "outside",
        "a row per finished simulation that no search asked for",
    )?;
    put_text(&outside, "outside_blake3", &results.outside_digest())?;
    let digest = texts(
        "point_digest",
        "content of the simulated point",
        &records,
        |run| run.key.point.hex(),
    );
    columns::write(&outside, &[digest])?;
    columns::write(&outside, &run_columns(&records, results.start_s))?;
    columns::write(&outside, &time_columns(&records))
}
