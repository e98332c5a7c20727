//! Names of the files and folders of a store.

/// Name of the results file in a store.
pub const RESULTS_FILE: &str = "results.h5";
/// Folder of the kept histories in a store.
pub const HISTORIES: &str = "histories";
/// Name of the journal in a store.
pub const JOURNAL_FILE: &str = "journal";
/// Name of the study with every default in a store.
pub(super) const RESOLVED_FILE: &str = "study.resolved.toml";
