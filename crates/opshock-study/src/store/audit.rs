//! Result of an audit: finished simulations run again with the full model, and the differences.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::aside;
use super::error::StoreError;

/// Name of the file in a store.
const AUDIT_FILE: &str = "audit.json";

/// A sample of a store's simulations against the same ones with `effects = "full"`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Audit {
    /// Digest of the study whose store it was.
    pub study_digest: String,
    /// Version of the program that audited.
    pub program_version: String,
    /// Its commit.
    pub commit: String,
    /// Share of the simulations requested, 0 to 1.
    pub share: f64,
    /// Simulations behind the study's answers.
    pub of_runs: usize,
    /// Simulations run again.
    pub runs: usize,
    /// What differed.
    pub differences: Vec<Difference>,
}

/// One number of one simulation that differs with the full model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// The point, as tables name it.
    pub point: String,
    /// Amplitude, G.
    pub amplitude_g: f64,
    /// Name of the quantity, with its unit.
    pub quantity: String,
    /// As stored.
    #[serde(alias = "planned")]
    pub stored: String,
    /// With the full model.
    pub full: String,
}

impl Audit {
    /// What it showed, in a sentence.
    pub fn sentence(&self) -> String {
        let found = match self.differences.len() {
            0 => "no difference".to_owned(),
            1 => "1 difference".to_owned(),
            n => format!("{n} differences"),
        };
        let Self { runs, of_runs, .. } = self;
        format!("audit: {runs} of {of_runs} simulations run again with all effects, {found}")
    }

    /// Keeps it in the store in `folder`.
    ///
    /// # Errors
    ///
    /// E183: the folder cannot be written.
    pub fn keep(&self, folder: &Path) -> Result<(), StoreError> {
        let text = serde_json::to_string_pretty(self).expect("an audit serialises") + "\n";
        aside::write(&folder.join(AUDIT_FILE), text.as_bytes())
    }

    /// The audit kept in `folder`, when it was one of the study with this digest.
    pub fn of_store(folder: &Path, study_digest: &str) -> Option<Self> {
        let text = std::fs::read_to_string(folder.join(AUDIT_FILE)).ok()?;
        let audit: Self = serde_json::from_str(&text).ok()?;
        (audit.study_digest == study_digest).then_some(audit)
    }
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            point,
            amplitude_g,
            quantity,
            stored,
            full,
        } = self;
        write!(
            f,
            "{point} at {amplitude_g:.4} G: {quantity} is {stored} as stored and {full} with the full model"
        )
    }
}
