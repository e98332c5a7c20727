//! The run that a history kept in a store is of: its file's name, and what the file must say.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::stored::{StoredHistory, parse};
use crate::search::{Retry, Sign};
use crate::store::aside;
use crate::store::error::StoreError;
use crate::store::files::{self, RealFiles};
use crate::store::names::HISTORIES;
use crate::store::record::RunKey;

/// A simulation of a study whose history may be kept.
#[derive(Clone, Copy, Debug)]
pub struct KeptRun<'a> {
    /// Ramp model.
    pub ramp: &'a str,
    /// Pulse width, ms.
    pub pulse_ms: f64,
    /// Sign.
    pub sign: Sign,
    /// Amplitude without sign, G.
    pub amplitude_g: f64,
    /// The simulation by its content, physics versions included.
    pub key: RunKey,
    /// Onset of the pulse on the study's time axis, s.
    pub start_s: f64,
    /// Plan of the study as JSON: of it, the outputs decide what is recorded.
    pub plan: &'a str,
}

impl KeptRun<'_> {
    /// Its file in a store: `histories/RAMP_WIDTHms_SIGN_AMPLITUDEg_DIGEST.h5`.
    pub fn path(&self, store: &Path) -> PathBuf {
        let mut labels = String::new();
        if self.key.window_factor != 1 {
            labels += "_window";
        }
        if let Some(retry) = Retry::from_place(self.key.retry).filter(|&retry| retry != Retry::None)
        {
            labels += "_";
            labels += &retry.label().replace('/', "_");
        }
        let sign = match self.sign {
            Sign::Plus => "plus",
            Sign::Minus => "minus",
        };
        store.join(HISTORIES).join(format!(
            "{}_{}ms_{sign}_{:.3}g{labels}_{}.h5",
            self.ramp,
            self.pulse_ms,
            self.amplitude_g,
            &self.key.point.hex()[..12]
        ))
    }

    /// Digest of everything that decides what a history of it holds.
    pub fn content(&self) -> String {
        let plan: Value = serde_json::from_str(self.plan).unwrap_or_default();
        let RunKey {
            point,
            amplitude_bits,
            window_factor,
            retry,
        } = self.key;
        let mut hasher = blake3::Hasher::new();
        hasher.update(b"opshock history 1");
        hasher.update(&point.0);
        hasher.update(&amplitude_bits.to_le_bytes());
        hasher.update(&[window_factor, retry]);
        hasher.update(&self.start_s.to_bits().to_le_bytes());
        for name in ["effects", "outputs", "field_times_s"] {
            hasher.update(plan[name].to_string().as_bytes());
            hasher.update(b"\n");
        }
        hasher.finalize().to_hex().to_string()
    }

    /// Copies its history from one store into another; `false` when there is none.
    ///
    /// # Errors
    ///
    /// As [`KeptRun::read`]; E183 it cannot be written.
    pub fn copy(&self, from: &Path, to: &Path) -> Result<bool, StoreError> {
        let path = self.path(from);
        let Some(bytes) = files::read(&RealFiles, &path)? else {
            return Ok(false);
        };
        let is_it = parse(&path, &bytes)?.run == self.content();
        if is_it {
            aside::write(&self.path(to), &bytes)?;
        }
        Ok(is_it)
    }

    /// Its history in a store; `None` when there is none, or the file is of another run.
    ///
    /// # Errors
    ///
    /// E182 the file is damaged or has no seal, E183 it cannot be read.
    pub fn read(&self, store: &Path) -> Result<Option<StoredHistory>, StoreError> {
        let path = self.path(store);
        let Some(bytes) = files::read(&RealFiles, &path)? else {
            return Ok(None);
        };
        let history = parse(&path, &bytes)?;
        Ok((history.run == self.content()).then_some(history))
    }
}
