//! Reads table and runs of a store, without simulating.

use super::input::SweepInput;
use super::registry::Registry;
use crate::store::{self, Loaded, Results, Session, StoreError, folder};
use std::path::Path;

/// Table and runs from what is stored, without simulating.
pub fn replay(input: &SweepInput, loaded: Loaded, session: &Session) -> Results {
    let mut registry = Registry::new(input, loaded);
    registry.absorb_all();
    registry.results(session)
}

/// Table and runs of a store in its present state, also of a sweep in progress or a killed one; nothing is simulated,
/// locked or changed.
///
/// # Errors
///
/// [`StoreError`]: nothing is stored, the files are damaged or of another format.
pub fn stored(input: &SweepInput, folder: &Path) -> Result<Results, StoreError> {
    let (loaded, results) = store::load(folder)?;
    let session = results.map_or_else(|| folder::session(0), |results| results.session);
    Ok(replay(input, loaded, &session))
}
