//! System calls of a journal, behind a trait so that tests can use a file system that fails.

use std::ffi::OsStr;
use std::fmt::Debug;
use std::fs::File;
use std::io::{Read, Write};
use std::os::unix::ffi::OsStrExt as _;
use std::path::{Path, PathBuf};

use super::error::StoreError;

/// A file system as a journal sees it.
pub trait Files: Debug + Send + Sync {
    /// The file open for writing.
    type Open: OpenFile;

    /// Everything in a file.
    ///
    /// # Errors
    ///
    /// It is missing (`NotFound`) or cannot be read.
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>>;

    /// A new empty file, in place of one of that name.
    ///
    /// # Errors
    ///
    /// It cannot be made.
    fn create(&self, path: &Path) -> std::io::Result<Self::Open>;

    /// Gives a file the name of another, which it replaces.
    ///
    /// # Errors
    ///
    /// It cannot be renamed.
    fn rename(&self, from: &Path, to: &Path) -> std::io::Result<()>;

    /// Makes renames and new files in a folder durable.
    ///
    /// # Errors
    ///
    /// The disk refused; which of them are durable is not known.
    fn sync_folder(&self, folder: &Path) -> std::io::Result<()>;
}

/// Everything in a file; `None` when it is missing.
///
/// # Errors
///
/// E183: it cannot be read.
pub fn read(files: &impl Files, path: &Path) -> Result<Option<Vec<u8>>, StoreError> {
    match files.read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(StoreError::Unreadable {
            path: path.to_owned(),
            source,
        }),
    }
}

/// A file that grows at its end.
pub trait OpenFile: Debug + Send {
    /// Writes the first bytes at the end; returns how many.
    ///
    /// # Errors
    ///
    /// None was written.
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize>;

    /// Waits until everything written is durable.
    ///
    /// # Errors
    ///
    /// What of it is durable is not known, and a repeated call does not show it.
    fn sync(&mut self) -> std::io::Result<()>;

    /// Writes all bytes at the end.
    ///
    /// # Errors
    ///
    /// The first that is no interruption; a part may have been written.
    fn write_all(&mut self, mut bytes: &[u8]) -> std::io::Result<()> {
        while !bytes.is_empty() {
            match self.write(bytes) {
                Ok(0) => return Err(std::io::ErrorKind::WriteZero.into()),
                Ok(written) => bytes = &bytes[written..],
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

/// Paths of what is in a folder, sorted.
///
/// Not by [`std::fs::read_dir`], which panics where the system cannot close the folder.
///
/// # Errors
///
/// The folder is missing (`NotFound`) or cannot be read.
pub fn list(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in rustix::fs::Dir::new(File::open(folder)?)? {
        let entry = entry?;
        let name = entry.file_name().to_bytes();
        if name != b"." && name != b".." {
            found.push(folder.join(OsStr::from_bytes(name)));
        }
    }
    found.sort();
    Ok(found)
}

/// The file system of the machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct RealFiles;

impl Files for RealFiles {
    type Open = File;

    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        File::open(path)?.read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn create(&self, path: &Path) -> std::io::Result<File> {
        File::create(path)
    }

    fn rename(&self, from: &Path, to: &Path) -> std::io::Result<()> {
        std::fs::rename(from, to)
    }

    fn sync_folder(&self, folder: &Path) -> std::io::Result<()> {
        sync_folder(folder)
    }
}

/// Makes a rename or a new file durable.
pub(super) fn sync_folder(folder: &Path) -> std::io::Result<()> {
    File::open(folder)?.sync_all()
}

impl OpenFile for File {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        Write::write(self, bytes)
    }

    fn sync(&mut self) -> std::io::Result<()> {
        self.sync_data()
    }
}
