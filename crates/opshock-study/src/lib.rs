//! Studies of operational shock: reading them, searching critical amplitudes, storing, reporting.
//!
//! A *study* turns axes into points; a point is a search over shock amplitude; each probe is one
//! simulation with a verdict. Points run in parallel, one writer saves them, the report reads
//! only what was saved.

pub mod accuracy;
pub mod hard_cases;
pub mod identity;
pub mod matching;
pub mod provenance;
pub mod report;
pub mod search;
pub mod store;
pub mod study;
pub mod sweep;
