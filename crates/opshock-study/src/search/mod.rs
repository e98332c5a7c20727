//! Search for the critical amplitude: ask and tell, no physics, no files.

pub mod probe;

pub use probe::{Probe, ProbeResult, Purpose, Retry, RunCost, Sign, UndecidedCause, Verdict};
