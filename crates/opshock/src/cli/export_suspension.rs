//! `opshock export --format suspension`: writes the finite elements of a study's suspension as matrices.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use super::import::written::{shown, write_new};
use super::study_file;
use anyhow::Context as _;
use opshock_study::study::imported_suspension::write;
use serde_json::json;
use std::path::Path;

/// Writes `susp_M.dat`, `susp_K.dat`, `susp_cords.dat` and the section of a study that reads them.
pub fn run(
    source: &Path,
    out: &Path,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let study = study_file::read(source, global, console)?;
    // Every study has a point.
    let scene = &study.points[0].scene;
    let written = write(&scene.suspension).context("the suspension has no matrices")?;
    let files = [
        ("susp_M.dat", written.mass.as_str()),
        ("susp_K.dat", written.stiffness.as_str()),
        ("susp_cords.dat", written.places.as_str()),
        ("suspension.toml", written.section.as_str()),
    ];
    let paths = shown(&write_new(out, &files)?);
    if console.json {
        console.result_json(&json!({ "files": paths }))?;
    } else {
        console.result(&(paths.join("\n") + "\n"))?;
    }
    Ok(Exit::Complete)
}
