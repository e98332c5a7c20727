//! Errors of a store.

use std::path::{Path, PathBuf};

/// A store that cannot be used. Every one ends the program with exit code 6.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The folder holds another study.
    #[error(
        "{code}: {path} holds results of another study ({found}) than {wanted}: {differ}; {hint}",
        code = self.code()
    )]
    OtherStudy {
        /// Folder.
        path: PathBuf,
        /// Study in it: its file as seen from the folder, else its name.
        found: String,
        /// Study asked for.
        wanted: String,
        /// Settings that differ.
        differ: String,
        /// What to do.
        hint: &'static str,
    },
    /// Written by a newer or an older program.
    #[error(
        "{code}: {path} has format {found}, this program reads {known}; {}",
        if found > known { "use a newer opshock" } else { "compute it anew, in another folder" },
        code = self.code()
    )]
    OtherFormat {
        /// File.
        path: PathBuf,
        /// Its format.
        found: u32,
        /// The format known here.
        known: u32,
    },
    /// Not what it should be, or cut short.
    #[error("{code}: {path}: {what}; {hint}", code = self.code())]
    Damaged {
        /// File.
        path: PathBuf,
        /// What is wrong.
        what: String,
        /// What to do.
        hint: &'static str,
    },
    /// Cannot be written.
    #[error("{code}: cannot write {path}", code = self.code())]
    Unwritable {
        /// File or folder.
        path: PathBuf,
        /// Reason.
        source: std::io::Error,
    },
    /// Cannot be read.
    #[error("{code}: cannot read {path}", code = self.code())]
    Unreadable {
        /// File or folder.
        path: PathBuf,
        /// Reason.
        source: std::io::Error,
    },
    /// Another process writes it.
    #[error("{code}: {path} is in use by {holder}", code = self.code())]
    Locked {
        /// Folder.
        path: PathBuf,
        /// Who: process id, host, start time.
        holder: String,
    },
    /// Nothing was stored.
    #[error(
        "{code}: {path} holds no results; run `opshock sweep` first, and `opshock merge` where shards have swept",
        code = self.code()
    )]
    Empty {
        /// Folder.
        path: PathBuf,
    },
}

impl StoreError {
    /// Stable code of the message.
    pub fn code(&self) -> &'static str {
        match self {
            StoreError::OtherStudy { .. } => "E188",
            StoreError::OtherFormat { .. } => "E181",
            StoreError::Damaged { .. } => "E182",
            StoreError::Unwritable { .. } | StoreError::Unreadable { .. } => "E183",
            StoreError::Locked { .. } => "E184",
            StoreError::Empty { .. } => "E187",
        }
    }

    /// A file that HDF5 could not make in memory.
    pub(super) fn not_made(path: &Path, error: &hdf5::Error) -> StoreError {
        StoreError::Unwritable {
            path: path.to_owned(),
            source: std::io::Error::other(error.to_string()),
        }
    }

    /// Exit code of the program.
    pub const EXIT_CODE: u8 = 6;
}
