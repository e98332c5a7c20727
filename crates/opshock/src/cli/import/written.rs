//! Writes the files of an import, and turns faults of its input into errors.

use crate::cli::failure::{Failure, Fault};
use opshock_import::Faults;
use opshock_study::store::aside;
use opshock_study::study::{StudyError, StudyErrors};
use std::path::{Path, PathBuf};

/// Faults of files as faults of a study, so that one place prints both.
pub(super) fn refused(faults: Faults) -> Failure {
    let errors = faults.listed.into_iter().map(StudyError::from);
    let mut errors = StudyErrors::new(errors.collect());
    errors.unlisted += faults.unlisted;
    Failure::Study(errors)
}

/// Writes files into a folder that is made where there is none; nothing that is there is replaced.
pub(in crate::cli) fn write_new(
    folder: &Path,
    files: &[(&str, &str)],
) -> Result<Vec<PathBuf>, Failure> {
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.join(name)).collect();
    if let Some(there) = paths.iter().find(|path| path.exists()) {
        let fault = Fault {
            key: Some("--out".to_owned()),
            value: Some(there.display().to_string()),
            hint: Some("give another folder; nothing that is there is replaced".to_owned()),
            ..Fault::new("usage", format!("{} exists already", there.display()))
        };
        return Err(Failure::Usage(vec![fault]));
    }
    let written = aside::write_all(folder, files.iter().copied());
    if written.is_err() {
        // None was there: what got its name goes, so that the same command may be given again.
        for path in &paths {
            let _ = std::fs::remove_file(path);
        }
    }
    Ok(written?)
}

/// Paths as text.
pub(in crate::cli) fn shown(paths: &[PathBuf]) -> Vec<String> {
    paths
        .iter()
        .map(|path| path.display().to_string())
        .collect()
}
