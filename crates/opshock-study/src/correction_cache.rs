//! Defect corrections of films, kept between processes.
//!
//! Sampling one takes some tenths of a second for a shock, and up to some ten seconds for the finer films of an uncertainty
//! interval. Each is a file of some 25 kB, named by the digest of all that it depends on, the program included. Its first 32
//! bytes are the digest of the others: what does not fit is sampled anew and replaced. Files appear whole ([`aside`]), so that
//! processes may use one folder at the same time.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::SystemTime;

use opshock_solver::air_bearing::CorrectionForces;
use opshock_solver::scene::Scene;
use opshock_solver::simulation::KeptCorrections;

use crate::identity::correction_key;
use crate::provenance;
use crate::store::aside;

/// Names the folder; empty: none.
pub const FOLDER_VARIABLE: &str = "OPSHOCK_CACHE_DIR";

/// Bytes that the folder may hold: some 2600 corrections.
const MOST_BYTES: u64 = 64 << 20;

/// Bytes of a file before the correction.
const DIGEST: usize = blake3::OUT_LEN;

/// A folder of corrections.
pub struct CorrectionCache {
    folder: PathBuf,
    program: String,
    report: Box<dyn Fn(&str) + Send + Sync>,
    is_reported: AtomicBool,
}

impl CorrectionCache {
    /// In `folder`, such as the [default one](default_folder); `report` gets a sentence the first time that it cannot be written.
    /// `None` where nothing tells the program from others.
    pub fn new(folder: PathBuf, report: impl Fn(&str) + Send + Sync + 'static) -> Option<Self> {
        Some(Self {
            folder,
            program: this_program()?,
            report: Box::new(report),
            is_reported: AtomicBool::new(false),
        })
    }

    fn path(&self, scene: &Scene) -> PathBuf {
        let key = correction_key(scene, &self.program);
        let name: String = key.iter().map(|byte| format!("{byte:02x}")).collect();
        self.folder.join(name)
    }

    fn write(
        &self,
        path: &Path,
        correction: &CorrectionForces,
    ) -> Result<(), Box<dyn std::error::Error>> {
        let mut bytes = vec![0; DIGEST];
        ciborium::into_writer(correction, &mut bytes)?;
        let digest = blake3::hash(&bytes[DIGEST..]);
        bytes[..DIGEST].copy_from_slice(digest.as_bytes());
        std::fs::create_dir_all(&self.folder)?;
        aside::write(path, &bytes)?;
        Ok(trim(&self.folder, MOST_BYTES)?)
    }
}

impl KeptCorrections for CorrectionCache {
    fn has(&self, scene: &Scene) -> bool {
        self.path(scene).is_file()
    }

    fn find(&self, scene: &Scene) -> Option<CorrectionForces> {
        let path = self.path(scene);
        let correction = read(&std::fs::read(&path).ok()?)?;
        // Those used last are kept longest; where that cannot be noted, the oldest go first.
        if let Ok(file) = std::fs::File::open(&path) {
            let _ = file.set_modified(SystemTime::now());
        }
        Some(correction)
    }

    fn keep(&self, scene: &Scene, correction: &CorrectionForces) {
        if let Err(error) = self.write(&self.path(scene), correction)
            && !self.is_reported.swap(true, Ordering::Relaxed)
        {
            (self.report)(&format!(
                "defect corrections are not kept for other processes: {error}; {FOLDER_VARIABLE} names another folder"
            ));
        }
    }
}

/// `OPSHOCK_CACHE_DIR`, or `opshock` in the user's folder for caches: `XDG_CACHE_HOME`, or `.cache` at home. `None`: nowhere.
pub fn default_folder() -> Option<PathBuf> {
    let named = |variable: &str| std::env::var_os(variable).map(PathBuf::from);
    if let Some(folder) = named(FOLDER_VARIABLE) {
        return Some(folder).filter(|folder| !folder.as_os_str().is_empty());
    }
    // The XDG specification has relative paths ignored.
    let caches = named("XDG_CACHE_HOME").filter(|folder| folder.is_absolute());
    let caches = caches.or_else(|| Some(named("HOME")?.join(".cache")));
    caches
        .filter(|folder| folder.is_absolute())
        .map(|folder| folder.join("opshock"))
}

/// Names this program and no other: by its commit, or, of sources that are no commit's, by its file.
fn this_program() -> Option<String> {
    let program = provenance::program();
    if provenance::COMMIT
        .bytes()
        .all(|byte| byte.is_ascii_hexdigit())
    {
        return Some(program);
    }
    let path = std::env::current_exe().ok()?;
    // Inside another program, such as Python, the file is not ours.
    let is_own = path.file_name()?.as_encoded_bytes().starts_with(b"opshock");
    let data = std::fs::metadata(&path).ok().filter(|_| is_own)?;
    let made = data.modified().ok()?.duration_since(SystemTime::UNIX_EPOCH);
    Some(format!("{program} {} {:?}", data.len(), made.ok()?))
}

/// What a sound file holds.
fn read(bytes: &[u8]) -> Option<CorrectionForces> {
    let (digest, content) = bytes.split_at_checked(DIGEST)?;
    if blake3::hash(content).as_bytes() != digest {
        return None;
    }
    ciborium::from_reader(content).ok()
}

/// Whether it is the name of a correction: the user's own files may be in the folder too.
fn is_ours(name: &std::ffi::OsStr) -> bool {
    let digits = name.as_encoded_bytes();
    digits.len() == 32
        && digits
            .iter()
            .all(|digit| b"0123456789abcdef".contains(digit))
}

/// Removes the corrections used longest ago, until the others have at most half of `most_bytes`, if all have more than that.
fn trim(folder: &Path, most_bytes: u64) -> std::io::Result<()> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        // Another process may remove it meanwhile.
        if let Ok(data) = entry.metadata()
            && data.is_file()
            && is_ours(&entry.file_name())
        {
            files.push((data.modified()?, data.len(), entry.path()));
        }
    }
    let mut bytes: u64 = files.iter().map(|(_, bytes, _)| bytes).sum();
    if bytes <= most_bytes {
        return Ok(());
    }
    files.sort();
    for (_, own, path) in files {
        if bytes <= most_bytes / 2 {
            break;
        }
        bytes -= own;
        // Gone already, or not ours to remove: the next one is.
        let _ = std::fs::remove_file(path);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_used_longest_ago_make_room() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name.repeat(32));
        let own = folder.path().join("notes of the user");
        std::fs::write(&own, [0; 1000]).expect("written");
        for (age_s, name) in [(30, "c"), (10, "a"), (20, "b"), (40, "d")] {
            std::fs::write(at(name), [0; 100]).expect("written");
            let file = std::fs::File::options().write(true).open(at(name));
            let used = SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(age_s);
            file.and_then(|file| file.set_modified(used)).expect("set");
        }
        let left = || ["a", "b", "c", "d"].map(|name| at(name).exists());
        trim(folder.path(), 400).expect("read");
        assert_eq!(left(), [true; 4]);
        trim(folder.path(), 399).expect("read");
        assert_eq!(left(), [false, false, false, true]);
        assert!(own.exists());
    }
}
