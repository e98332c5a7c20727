//! Ensures one writer per store: an advisory lock on the file `lock`, which also names its holder.
//!
//! The kernel drops the lock when its holder ends, however it ends; the remaining text has no effect.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::time::Duration;

use super::error::StoreError;
use super::machine;

/// A held lock; dropped with the process or the value.
#[derive(Debug)]
pub struct StoreLock {
    _file: File,
}

impl StoreLock {
    /// Takes the lock of a store's folder.
    ///
    /// # Errors
    ///
    /// [`StoreError::Locked`] with the holder's process id, host and start time, or the file
    /// cannot be written.
    pub fn take(folder: &Path) -> Result<StoreLock, StoreError> {
        let path = folder.join("lock");
        let unwritable = |source| StoreError::Unwritable {
            path: path.clone(),
            source,
        };
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .map_err(unwritable)?;
        match persistently(&file) {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let mut holder = String::new();
                let _ = file.read_to_string(&mut holder);
                let holder = match holder.trim() {
                    "" => "another process".to_owned(),
                    text => text.to_owned(),
                };
                return Err(StoreError::Locked {
                    path: folder.to_owned(),
                    holder,
                });
            }
            Err(TryLockError::Error(source)) => return Err(unwritable(source)),
        }
        let text = format!(
            "process {} on {} since {}\n",
            std::process::id(),
            machine::host(),
            machine::utc_now()
        );
        file.set_len(0)
            .and_then(|()| file.seek(SeekFrom::Start(0)))
            .and_then(|_| file.write_all(text.as_bytes()))
            .map_err(unwritable)?;
        Ok(StoreLock { _file: file })
    }
}

/// Tries for a quarter of a second: [`is_held`] of another process takes the lock for an instant.
fn persistently(file: &File) -> Result<(), TryLockError> {
    for _ in 0..5 {
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(50)),
            other => return other,
        }
    }
    file.try_lock()
}

/// Some process writes the store in `folder` now. On a file system without locks, none seems to.
pub fn is_held(folder: &Path) -> bool {
    let file = File::open(folder.join("lock"));
    file.is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}
