//! Seals HDF5 files with a checksum behind their end: the HDF5 library may crash on a file with flipped bytes, so they
//! are found before it reads the file.
//!
//! ```text
//! ... HDF5 ...   blake3 of it, 32 bytes   "OPSHOCKS"
//! ```
//!
//! It is made of the bytes that were meant, not of those that reached the disk. HDF5 readers do not
//! look behind the end of their data, and a program that changes the file cuts the seal off.

const MARK: &[u8; 8] = b"OPSHOCKS";
const LENGTH: usize = 32 + MARK.len();

/// What the end of a file says about the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sealed<'a> {
    /// No seal.
    Without,
    /// It matches: the file without it.
    Whole(&'a [u8]),
    /// It does not.
    Broken,
}

/// Bytes of a file with their seal behind them.
pub(super) fn seal(mut bytes: Vec<u8>) -> Vec<u8> {
    let digest = blake3::hash(&bytes);
    bytes.extend_from_slice(digest.as_bytes());
    bytes.extend_from_slice(MARK);
    bytes
}

/// Looks at the seal of a file.
pub(super) fn check(bytes: &[u8]) -> Sealed<'_> {
    if !bytes.ends_with(MARK) || bytes.len() < LENGTH {
        return Sealed::Without;
    }
    let (content, seal) = bytes.split_at(bytes.len() - LENGTH);
    if seal.starts_with(blake3::hash(content).as_bytes()) {
        Sealed::Whole(content)
    } else {
        Sealed::Broken
    }
}
