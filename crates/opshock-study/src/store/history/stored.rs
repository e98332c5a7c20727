//! Reads a kept history back, for drawings.

use std::collections::BTreeMap;
use std::path::Path;

use hdf5::types::VarLenUnicode;
use opshock_solver::simulation::Mechanism;

use crate::store::error::StoreError;
use crate::store::hdf5_file;
use crate::store::seal::{self, Sealed};

/// The columns on the time of disk and ramp, and whose they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StoredHistory {
    /// Digest of the run it is of ([`KeptRun::content`](super::KeptRun::content)); empty outside a
    /// store.
    pub run: String,
    /// Coordinates of the point, as `ramp`, `pulse_ms`, `sign`.
    pub point: BTreeMap<String, String>,
    /// Amplitude without sign, G.
    pub amplitude_g: f64,
    /// `survives`, `fails`, `undecided`.
    pub verdict: String,
    /// Why it failed; none where it did not, or a program wrote the file that had no such name.
    pub mechanism: Option<Mechanism>,
    /// Columns by name, in SI.
    pub columns: BTreeMap<String, Vec<f64>>,
}

/// Reads the bytes that [`write_hdf5`](super::write_hdf5) wrote; `path` is only named in the error.
///
/// # Errors
///
/// E182 they do not match their seal, have none, or are no history.
pub fn parse(path: &Path, bytes: &[u8]) -> Result<StoredHistory, StoreError> {
    let damaged = |what: String| StoreError::Damaged {
        path: path.to_owned(),
        what,
        hint: "`opshock sweep` records it anew if the study still keeps it; else remove it",
    };
    match seal::check(bytes) {
        Sealed::Whole(inside) => {
            content(inside).map_err(|error| damaged(format!("not a history of opshock ({error})")))
        }
        Sealed::Broken => Err(damaged("its bytes do not match its seal".into())),
        Sealed::Without => Err(damaged(
            "it has no seal: it is cut short, or another program wrote it".into(),
        )),
    }
}

fn content(inside: &[u8]) -> hdf5::Result<StoredHistory> {
    let file = hdf5_file::open(inside)?;
    let text = |name: &str| -> hdf5::Result<String> {
        let value: VarLenUnicode = file.attr(name)?.read_scalar()?;
        Ok(value.to_string())
    };
    let mut point = BTreeMap::new();
    for name in file.attr_names()? {
        if let Some(key) = name.strip_prefix("point_") {
            // Format 1 has numbers as text.
            let value = match file.attr(&name)?.read_scalar::<f64>() {
                Ok(number) => number.to_string(),
                Err(_) => text(&name)?,
            };
            point.insert(key.to_owned(), value);
        }
    }
    let mut columns = BTreeMap::new();
    for dataset in file.datasets()? {
        let name = dataset.name();
        if dataset.ndim() == 1 {
            columns.insert(
                name.trim_start_matches('/').to_owned(),
                dataset.read_raw::<f64>()?,
            );
        }
    }
    Ok(StoredHistory {
        run: text("run_blake3")?,
        point,
        amplitude_g: file.attr("amplitude_g")?.read_scalar()?,
        verdict: text("verdict")?,
        mechanism: text("mechanism")
            .ok()
            .and_then(|word| Mechanism::from_word(&word)),
        columns,
    })
}
