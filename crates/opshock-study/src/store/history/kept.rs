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
use crate::store::summary::AxisValue;

/// Letters of the place on the axes at most: a name of 255 is the longest that file systems take.
const LONGEST_PLACE: usize = 150;

/// A simulation of a study whose history may be kept.
#[derive(Clone, Copy, Debug)]
pub struct KeptRun<'a> {
    /// Ramp model.
    pub ramp: &'a str,
    /// Pulse width, ms.
    pub pulse_ms: f64,
    /// Sign.
    pub sign: Sign,
    /// Names of the study's further axes.
    pub axes: &'a [String],
    /// Its place on them.
    pub values: &'a [AxisValue],
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
    /// Its file in a store: `histories/RAMP_WIDTHms_SIGN[_AXIS=VALUE...]_AMPLITUDEg_DIGEST.h5`.
    pub fn path(&self, store: &Path) -> PathBuf {
        let [name, _] = self.names();
        store.join(HISTORIES).join(name)
    }

    /// Name of its file, and the one that programs gave it which left the axes out.
    pub(in crate::store) fn names(&self) -> [String; 2] {
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
        [self.place(), String::new()].map(|place| {
            format!(
                "{}_{}ms_{sign}{place}_{:.3}g{labels}_{}.h5",
                self.ramp,
                self.pulse_ms,
                self.amplitude_g,
                &self.key.point.hex()[..12]
            )
        })
    }

    /// Its place on the further axes, in letters that any file system takes.
    fn place(&self) -> String {
        let pairs = self.axes.iter().zip(self.values);
        let text: String = pairs
            .map(|(axis, value)| format!("_{axis}={value}"))
            .collect();
        let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "._=+-".contains(letter);
        text.chars()
            .map(|letter| if is_plain(letter) { letter } else { '-' })
            .take(LONGEST_PLACE)
            .collect()
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

    /// Its file in a store and what that holds; `None` when there is none.
    fn find(&self, store: &Path) -> Result<Option<(PathBuf, Vec<u8>)>, StoreError> {
        for name in self.names() {
            let path = store.join(HISTORIES).join(name);
            if let Some(bytes) = files::read(&RealFiles, &path)? {
                return Ok(Some((path, bytes)));
            }
        }
        Ok(None)
    }

    /// Copies its history from one store into another; `false` when there is none.
    ///
    /// # Errors
    ///
    /// As [`KeptRun::read`]; E183 it cannot be written.
    pub fn copy(&self, from: &Path, to: &Path) -> Result<bool, StoreError> {
        let Some((path, bytes)) = self.find(from)? else {
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
        let Some((path, bytes)) = self.find(store)? else {
            return Ok(None);
        };
        let history = parse(&path, &bytes)?;
        Ok((history.run == self.content()).then_some(history))
    }
}
