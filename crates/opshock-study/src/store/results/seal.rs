//! A checksum behind the end of an HDF5 file: the HDF5 library may crash on a file with flipped
//! bytes, so they are found before it sees the file.
//!
//! ```text
//! ... HDF5 ...   blake3 of it, 32 bytes   "OPSHOCKS"
//! ```
//!
//! HDF5 readers do not look behind the end of their data, and a program that changes the file cuts
//! the seal off; a file without one is judged by its content alone.

use std::io::Write;
use std::path::Path;

const MARK: &[u8; 8] = b"OPSHOCKS";
const LENGTH: usize = 32 + MARK.len();

/// What the end of a file says about the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Seal {
    /// There is none.
    Without,
    /// It matches.
    Whole,
    /// It does not.
    Broken,
}

/// Writes the seal of a finished file.
pub(super) fn put(path: &Path) -> std::io::Result<()> {
    let digest = blake3::hash(&std::fs::read(path)?);
    let mut file = std::fs::OpenOptions::new().append(true).open(path)?;
    file.write_all(digest.as_bytes())?;
    file.write_all(MARK)
}

/// Looks at the seal of a file.
pub(super) fn check(path: &Path) -> std::io::Result<Seal> {
    let bytes = std::fs::read(path)?;
    if !bytes.ends_with(MARK) || bytes.len() < LENGTH {
        return Ok(Seal::Without);
    }
    let (content, seal) = bytes.split_at(bytes.len() - LENGTH);
    let is_whole = seal.starts_with(blake3::hash(content).as_bytes());
    Ok(if is_whole { Seal::Whole } else { Seal::Broken })
}
