//! The journal: an append-only file, the truth of a store.
//!
//! ```text
//! "OPSHOCKJ"  format u32  length u32  header (JSON)  crc32 u32
//! then per record
//! "OPJR"  length u32  crc32 u32  kind and content (`record`)
//! ```
//!
//! Little-endian. The checksum covers the length and the content. A record counts once
//! `fdatasync` returned; a failed write or sync is final for the process.
//!
//! A kill or a power loss may leave the last records torn: what is not whole at the end is cut
//! off when the journal is opened for writing. Damage in the middle (a flipped bit) costs the
//! record it hits: the reader finds the next record by its mark and its checksum, and says what
//! it skipped. Runs are found by content, so records do not depend on each other.

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::error::StoreError;
use super::record::Record;

/// Number of the journal's format; raised when an older reader would go wrong.
pub const JOURNAL_FORMAT: u32 = 1;

const MAGIC: &[u8; 8] = b"OPSHOCKJ";
const MARK: &[u8; 4] = b"OPJR";
/// Mark, length and checksum of a record.
const FRAME: usize = 12;
/// A longer record is not one of ours.
const LONGEST: usize = 1 << 24;

/// What a journal says about itself.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct JournalHeader {
    /// Name of the study.
    pub study: String,
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
/// The file cannot be read, or is newer.
pub fn read(path: &Path) -> Result<Option<JournalContent>, StoreError> {
    let mut bytes = Vec::new();
    match File::open(path) {
        Ok(mut file) => file
            .read_to_end(&mut bytes)
            .map_err(|source| unreadable(path, source))?,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(unreadable(path, source)),
    };
    parse(path, &bytes).map(Some)
}

/// Reads the bytes of a journal; `path` is only named in the error. A damaged header costs no
/// record.
///
/// # Errors
///
/// [`StoreError::Newer`].
pub fn parse(path: &Path, bytes: &[u8]) -> Result<JournalContent, StoreError> {
    match header_at_start(bytes) {
        Some((format, ..)) if format > JOURNAL_FORMAT => Err(StoreError::Newer {
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

fn unreadable(path: &Path, source: std::io::Error) -> StoreError {
    StoreError::Unreadable {
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
pub struct JournalWriter {
    path: PathBuf,
    file: File,
    /// Bytes on the disk.
    durable: u64,
    /// A write or sync failed: what is on the disk beyond `durable` is not known any more.
    failed: bool,
}

impl JournalWriter {
    /// Makes a journal with these records, aside, synced, then renamed over `path`.
    ///
    /// # Errors
    ///
    /// The file cannot be written.
    pub fn create(
        path: &Path,
        header: &JournalHeader,
        records: &[Record],
    ) -> Result<JournalWriter, StoreError> {
        let unwritable = |source| StoreError::Unwritable {
            path: path.to_owned(),
            source,
        };
        let mut bytes = header_bytes(header);
        for record in records {
            bytes.extend_from_slice(&frame(record));
        }
        super::aside::replace(path, &bytes).map_err(unwritable)?;
        JournalWriter::append_to(path, bytes.len() as u64)
    }

    /// Opens a journal that was read, and cuts off what is not whole at its end.
    ///
    /// # Errors
    ///
    /// The file cannot be written.
    pub fn append_to(path: &Path, whole_bytes: u64) -> Result<JournalWriter, StoreError> {
        let open = || -> std::io::Result<File> {
            let mut file = OpenOptions::new().read(true).write(true).open(path)?;
            if file.metadata()?.len() != whole_bytes {
                file.set_len(whole_bytes)?;
                file.sync_data()?;
            }
            file.seek(SeekFrom::Start(whole_bytes))?;
            Ok(file)
        };
        let file = open().map_err(|source| StoreError::Unwritable {
            path: path.to_owned(),
            source,
        })?;
        Ok(JournalWriter {
            path: path.to_owned(),
            file,
            durable: whole_bytes,
            failed: false,
        })
    }

    /// Writes records and waits until they are on the disk.
    ///
    /// # Errors
    ///
    /// The write or the sync failed; none of these records counts, and every later append fails.
    pub fn append(&mut self, records: &[Record]) -> Result<(), StoreError> {
        let unwritable = |source| StoreError::Unwritable {
            path: self.path.clone(),
            source,
        };
        if self.failed {
            return Err(unwritable(std::io::Error::other(
                "an earlier write or sync failed",
            )));
        }
        let bytes: Vec<u8> = records.iter().flat_map(frame).collect();
        let written = self
            .file
            .write_all(&bytes)
            .and_then(|()| self.file.sync_data());
        match written {
            Ok(()) => {
                self.durable += bytes.len() as u64;
                Ok(())
            }
            Err(error) => {
                self.failed = true;
                // A short write on a full disk; the reader would skip it anyway.
                let _ = self.file.set_len(self.durable);
                Err(unwritable(error))
            }
        }
    }
}
