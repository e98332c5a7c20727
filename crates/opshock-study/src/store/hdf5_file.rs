//! HDF5 files opened without HDF5's own locks.
//!
//! Files here are written aside and renamed whole, so readers never meet a writer; a store's lock
//! keeps out a second one. HDF5's locks add nothing, fail on file systems that have none, and are
//! inherited by any process that is started while a file is open.

use std::path::Path;

use hdf5::{File, FileBuilder, Result};

/// Makes a new file, or empties an old one.
///
/// # Errors
///
/// HDF5 refused.
pub fn create(path: &Path) -> Result<File> {
    options().create(path)
}

/// Opens a file for reading.
///
/// # Errors
///
/// The file is missing, is not HDF5, or is cut short.
pub fn open(path: &Path) -> Result<File> {
    options().open(path)
}

fn options() -> FileBuilder {
    let mut builder = FileBuilder::new();
    builder.with_fapl(|access| access.file_locking(false));
    builder
}
