//! Search for the critical amplitude: ask and tell, no physics, no files.
//!
//! Failure need not be monotone in the amplitude, so every verdict is kept as evidence and the
//! answer is read from it: `A_fail` is the lowest failing amplitude in the evidence, `A_crit` the
//! highest surviving one below it. Amplitudes are nodes of a fixed logarithmic [`lattice`];
//! the [`order`] of the points says who learns from whom; [`point`] is the search of one point and
//! [`campaign`] that of all of them. All are state machines that name the next probe and are told
//! its verdict: the same verdicts give the same probes and the same answer, whoever computed the
//! verdicts, in which order and on how many threads.

pub mod bar;
pub mod campaign;
mod certify;
pub mod evidence;
pub mod findings;
mod follow;
mod hint;
mod hunt;
pub mod lattice;
pub mod lookahead;
pub mod order;
pub mod outcome;
pub mod point;
pub mod probe;
pub mod refine;
pub mod settings;
#[cfg(test)]
mod tests;

pub use bar::{Bar, BarInput};
pub use campaign::{Campaign, Touch};
pub use findings::Findings;
pub use lattice::{Lattice, LatticeError, NodeRange};
pub use order::{Coordinates, Order, RampClass};
pub use outcome::{Flag, Status};
pub use point::{Asked, PointSearch, Start};
pub use probe::{Probe, ProbeResult, Purpose, Retry, RunCost, Sign, UndecidedCause, Verdict};
pub use refine::Refine;
pub use settings::{Certify, SearchSettings};
