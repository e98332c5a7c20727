//! The journal: the file to which every finished run is appended, and from which a store can be rebuilt.
//!
//! ```text
//! "OPSHOCKJ"  format u32  length u32  header (JSON)  crc32 u32
//! then per record
//! "OPJR"  length u32  crc32 u32  kind and content (`record`)
//! ```
//!
//! Little-endian. The header's checksum covers format, length and header; that of a record its length, kind and content.
//! A record is stored once `fdatasync` returned; after a failed write or sync the process writes nothing more.
//!
//! A kill or a power loss may leave the last records incomplete. Every process that opens the store for writing copies
//! the intact records to a new file, which takes the journal's name, and appends to that. Damage in the middle (a flipped
//! bit) costs the record it hits: the reader finds the next record by its mark and its checksum, and reports the bytes
//! skipped. A run is found by a digest of what was simulated, so that records do not depend on each other.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::error::StoreError;
use super::files::{self, Files, OpenFile, RealFiles};
use super::record::Record;

/// Number of the journal's format; a journal of any other is refused.
pub const JOURNAL_FORMAT: u32 = 2;

const MAGIC: &[u8; 8] = b"OPSHOCKJ";
const MARK: &[u8; 4] = b"OPJR";
/// Mark, length and checksum of a record.
const FRAME: usize = 12;
/// Name under which a journal is made before it gets its own.
const ASIDE: &str = ".aside-journal";
/// Largest length of a record; a longer one is not one of ours.
const LONGEST: usize = 1 << 24;

/// The study that a journal belongs to.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct JournalHeader {
    /// Name of the study.
    pub study: String,
    /// Digest of every setting.
    pub digest: String,
    /// The study file, seen from the store's folder.
    pub file: Option<PathBuf>,
    /// The study with every default.
    pub resolved: String,
}

/// Bytes that hold no whole record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Damage {
    /// Place in the file.
    pub offset: u64,
    /// Number of bytes.
    pub length: u64,
    /// At the end of the file: as a kill or a power loss leaves it.
    pub at_end: bool,
}

/// Content of a journal.
#[derive(Debug)]
pub struct JournalContent {
    /// Header; `None` when it is damaged.
    pub header: Option<JournalHeader>,
    /// Whole records in order.
    pub records: Vec<Record>,
    /// What could not be read.
    pub damage: Vec<Damage>,
    /// Bytes up to the end of the last whole record.
    pub whole_bytes: u64,
}

/// Reads a journal; `None` when the file is missing. A damaged header costs no record.
///
/// # Errors
///
/// The file cannot be read, or is of another format.
pub fn read(path: &Path) -> Result<Option<JournalContent>, StoreError> {
    read_in(&RealFiles, path)
}

/// As [`read`], in any file system.
///
/// # Errors
///
/// As [`read`].
pub fn read_in(files: &impl Files, path: &Path) -> Result<Option<JournalContent>, StoreError> {
    files::read(files, path)?
        .map(|bytes| parse(path, &bytes))
        .transpose()
}

/// Reads the bytes of a journal; `path` is only named in the error. A damaged header costs no
/// record.
///
/// # Errors
///
/// [`StoreError::OtherFormat`].
pub fn parse(path: &Path, bytes: &[u8]) -> Result<JournalContent, StoreError> {
    match header_at_start(bytes) {
        Some((format, ..)) if format != JOURNAL_FORMAT => Err(StoreError::OtherFormat {
            path: path.to_owned(),
            found: format,
            known: JOURNAL_FORMAT,
        }),
        Some((_, header, start)) => Ok(records(header, bytes, start)),
        None => Ok(records(None, bytes, 0)),
    }
}

/// Format, header and its end; `None` unless the checksum holds.
fn header_at_start(bytes: &[u8]) -> Option<(u32, Option<JournalHeader>, usize)> {
    if !bytes.starts_with(MAGIC) {
        return None;
    }
    let format = u32_at(bytes, 8)?;
    let end = 16_usize.checked_add(u32_at(bytes, 12)? as usize)?;
    let crc = u32_at(bytes, end)?;
    if crc != crc32fast::hash(&bytes[8..end]) {
        return None;
    }
    // Another format may have another header.
    Some((
        format,
        serde_json::from_slice(&bytes[16..end]).ok(),
        end + 4,
    ))
}

fn records(header: Option<JournalHeader>, bytes: &[u8], start: usize) -> JournalContent {
    let mut content = JournalContent {
        header,
        records: Vec::new(),
        damage: Vec::new(),
        whole_bytes: start as u64,
    };
    let mut at = start;
    while at < bytes.len() {
        if let Some((record, end)) = record_at(bytes, at) {
            content.records.push(record);
            content.whole_bytes = end as u64;
            at = end;
            continue;
        }
        let next = (at + 1..bytes.len())
            .find(|&place| bytes[place..].starts_with(MARK) && record_at(bytes, place).is_some());
        let end = next.unwrap_or(bytes.len());
        content.damage.push(Damage {
            offset: at as u64,
            length: (end - at) as u64,
            at_end: next.is_none(),
        });
        at = end;
    }
    content
}

fn record_at(bytes: &[u8], at: usize) -> Option<(Record, usize)> {
    let frame = bytes.get(at..at + FRAME)?;
    if !frame.starts_with(MARK) {
        return None;
    }
    let length = u32_at(frame, 4)? as usize;
    if length > LONGEST {
        return None;
    }
    let content = bytes.get(at + FRAME..at + FRAME + length)?;
    if checksum(content) != u32_at(frame, 8)? {
        return None;
    }
    Some((Record::decode(content)?, at + FRAME + length))
}

fn checksum(content: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&(content.len() as u32).to_le_bytes());
    hasher.update(content);
    hasher.finalize()
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(four.try_into().ok()?))
}

fn unwritable(path: &Path, source: std::io::Error) -> StoreError {
    StoreError::Unwritable {
        path: path.to_owned(),
        source,
    }
}

fn frame(record: &Record) -> Vec<u8> {
    let content = record.encode();
    let mut bytes = Vec::with_capacity(FRAME + content.len());
    bytes.extend_from_slice(MARK);
    bytes.extend_from_slice(&(content.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&checksum(&content).to_le_bytes());
    bytes.extend_from_slice(&content);
    bytes
}

fn header_bytes(header: &JournalHeader) -> Vec<u8> {
    let content = serde_json::to_vec(header).expect("a name serialises");
    let mut bytes = MAGIC.to_vec();
    bytes.extend_from_slice(&JOURNAL_FORMAT.to_le_bytes());
    bytes.extend_from_slice(&(content.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&content);
    let crc = crc32fast::hash(&bytes[8..]);
    bytes.extend_from_slice(&crc.to_le_bytes());
    bytes
}

/// A journal open for appending.
#[derive(Debug)]
pub struct JournalWriter<F: OpenFile = File> {
    path: PathBuf,
    file: F,
    /// A write or sync failed: what is on the disk behind the last success is not known any more.
    failed: bool,
}

impl JournalWriter {
    /// [`JournalWriter::create_in`] the file system of the machine.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn create(
        path: &Path,
        header: &JournalHeader,
        records: &[Record],
    ) -> Result<JournalWriter, StoreError> {
        JournalWriter::create_in(&RealFiles, path, header, records)
    }
}

impl<F: OpenFile> JournalWriter<F> {
    /// Makes a journal with these records aside, syncs it, and renames it over `path`.
    ///
    /// A journal is opened again by this alone, with the records read from it. Appending to the old file would be
    /// unsafe: after a failed sync its bytes may be readable and yet on no disk, and no later sync writes them.
    ///
    /// # Errors
    ///
    /// The file cannot be written; the former one is in place.
    pub fn create_in<D: Files<Open = F>>(
        files: &D,
        path: &Path,
        header: &JournalHeader,
        records: &[Record],
    ) -> Result<JournalWriter<F>, StoreError> {
        let mut bytes = header_bytes(header);
        for record in records {
            bytes.extend_from_slice(&frame(record));
        }
        let folder = super::aside::folder_of(path);
        let aside = folder.join(ASIDE);
        let make = || -> std::io::Result<F> {
            let mut file = files.create(&aside)?;
            file.write_all(&bytes)?;
            file.sync()?;
            files.rename(&aside, path)?;
            files.sync_folder(folder)?;
            Ok(file)
        };
        Ok(JournalWriter {
            file: make().map_err(|source| unwritable(path, source))?,
            path: path.to_owned(),
            failed: false,
        })
    }

    /// Writes records and waits until they are on the disk.
    ///
    /// # Errors
    ///
    /// The write or the sync failed; none of these records is stored, and every later append fails.
    pub fn append(&mut self, records: &[Record]) -> Result<(), StoreError> {
        if self.failed {
            let earlier = std::io::Error::other("an earlier write or sync failed");
            return Err(unwritable(&self.path, earlier));
        }
        let bytes: Vec<u8> = records.iter().flat_map(frame).collect();
        let written = self.file.write_all(&bytes).and_then(|()| self.file.sync());
        self.failed = written.is_err();
        written.map_err(|source| unwritable(&self.path, source))
    }
}
