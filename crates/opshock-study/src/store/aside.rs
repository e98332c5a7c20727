//! Files replaced whole: written aside, synced, renamed, and the folder synced.

use std::fs::File;
use std::io::Write;
use std::path::Path;

/// Replaces `path` by `bytes`.
pub(super) fn replace(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut aside = file(path)?;
    aside.write_all(bytes)?;
    persist(aside, path)
}

/// Copies a file to `path`, which gets all of it or nothing.
pub fn keep_copy(from: &Path, path: &Path) -> std::io::Result<()> {
    let mut aside = file(path)?;
    std::io::copy(&mut File::open(from)?, &mut aside)?;
    persist(aside, path)
}

/// A file beside `path`, with the permissions that any new file has.
pub(super) fn file(path: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".aside-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder_of(path))
}

/// Syncs a finished file and renames it over `path`.
pub(super) fn persist(aside: tempfile::NamedTempFile, path: &Path) -> std::io::Result<()> {
    aside.as_file().sync_all()?;
    aside.persist(path).map_err(|error| error.error)?;
    sync_folder(folder_of(path))
}

/// Makes a rename or a new file durable.
pub(super) fn sync_folder(folder: &Path) -> std::io::Result<()> {
    File::open(folder)?.sync_all()
}

pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
