//! Replaces files whole: written aside, synced, renamed, and the folder synced. All files of the program are written
//! here, but for the journal, which does the same by itself.

use std::io::Write;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};

use super::error::StoreError;
use super::files::{list, sync_folder};

/// Names that files aside may begin with.
const PREFIXES: [&str; 2] = [PREFIX, ".probe-"];
const PREFIX: &str = ".aside-";

/// Replaces `path` by `bytes`.
///
/// # Errors
///
/// E183: the disk refused; a former file is then whole and in place, or this one is.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    let replace = || {
        aside(path, bytes)?.persist(path)?;
        sync_folder(folder_of(path))
    };
    replace().map_err(|source| unwritable(path, source))
}

/// Writes files by name into `folder`, which is made when it is missing. Returns the written files.
///
/// All are on the disk before the first gets its name: a disk that is full leaves the former ones.
///
/// # Errors
///
/// E183 at the first one that cannot be written.
pub fn write_all(
    folder: &Path,
    files: impl IntoIterator<Item = (impl AsRef<Path>, impl AsRef<[u8]>)>,
) -> Result<Vec<PathBuf>, StoreError> {
    std::fs::create_dir_all(folder).map_err(|source| unwritable(folder, source))?;
    let mut made = Vec::new();
    for (name, bytes) in files {
        let path = folder.join(name);
        let file = aside(&path, bytes.as_ref()).map_err(|source| unwritable(&path, source))?;
        made.push((file, path));
    }
    let named = made.into_iter().map(|(file, path)| {
        let renamed = file.persist(&path);
        renamed.map_err(|error| unwritable(&path, error.error))?;
        Ok(path)
    });
    let written = named.collect::<Result<_, _>>()?;
    sync_folder(folder).map_err(|source| unwritable(folder, source))?;
    Ok(written)
}

/// Removes from `folder` what a former answer wrote and this one did not: files that are not among `written` and begin as
/// `beginning` of their name says. `keep`, such as the study itself, stays.
///
/// # Errors
///
/// E183: a file cannot be read or removed.
pub fn remove_former(
    folder: &Path,
    written: &[PathBuf],
    keep: &Path,
    beginning: impl Fn(&str) -> Option<&'static str>,
) -> Result<(), StoreError> {
    let keep = std::fs::canonicalize(keep).ok();
    for path in list(folder).map_err(|source| unwritable(folder, source))? {
        let name = path.file_name().and_then(|name| name.to_str());
        let Some(beginning) = name.and_then(&beginning) else {
            continue;
        };
        let is_kept = written.contains(&path) || std::fs::canonicalize(&path).ok() == keep;
        if is_kept || !path.is_file() {
            continue;
        }
        // A file of this name that no answer wrote is somebody's own.
        let text = std::fs::read(&path).map_err(|source| unwritable(&path, source))?;
        if text.starts_with(beginning.as_bytes()) {
            std::fs::remove_file(&path).map_err(|source| unwritable(&path, source))?;
        }
    }
    Ok(())
}

/// A synced file beside `path`, with the permissions that any new file has; it removes itself when
/// it gets no name.
fn aside(path: &Path, bytes: &[u8]) -> std::io::Result<tempfile::TempPath> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    builder.permissions(std::fs::Permissions::from_mode(0o666));
    let mut file = builder.tempfile_in(folder_of(path))?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file.into_temp_path())
}

/// Removes what killed processes left aside in a folder. Only called under its store's lock.
pub(crate) fn clear(folder: &Path) {
    for path in list(folder).unwrap_or_default() {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if PREFIXES.iter().any(|prefix| name.starts_with(prefix)) {
            let _ = std::fs::remove_file(&path);
        }
    }
}

fn unwritable(path: &Path, source: std::io::Error) -> StoreError {
    StoreError::Unwritable {
        path: path.to_owned(),
        source,
    }
}

pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
