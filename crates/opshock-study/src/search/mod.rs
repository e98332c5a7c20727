//! Search for the critical amplitude: names the next amplitude and takes its verdict, without physics and files.
//!
//! Failure need not be monotone in the amplitude, so every verdict is kept as evidence and the answer is read from it:
//! the bracket is the lowest failing amplitude in the evidence and the highest surviving one below it. Amplitudes
//! are points of a fixed logarithmic grid ([`amplitude_grid`]). The [`order`] of the points decides which answers a
//! point starts from; [`point`] is the search of one point and [`campaign`] that of all of them. All are state machines
//! that name the next probe and take its verdict: the same verdicts give the same probes and the same answer, whatever
//! computed them, in any order and on any number of threads.

pub mod added_points;
pub mod amplitude_grid;
mod bracketing;
pub mod campaign;
mod campaign_rounds;
pub mod decisive;
pub mod evidence;
pub mod findings;
mod follow;
mod hint;
mod known_verdicts;
pub mod lookahead;
mod monotonicity_scan;
pub mod order;
pub mod outcome;
pub mod point;
pub mod probe;
pub mod settings;
#[cfg(test)]
mod tests;
pub mod uncertainty;

pub use added_points::AddedPoints;
pub use amplitude_grid::{AmplitudeGrid, AmplitudeGridError, AmplitudeRange};
pub use campaign::{Campaign, Touch};
pub use findings::Findings;
pub use order::{Coordinates, Order, Ramp};
pub use outcome::{Flag, Status};
pub use point::{Asked, KnownVerdict, PointSearch, Start};
pub use probe::{Probe, ProbeResult, Purpose, Retry, RunCost, Sign, UndecidedCause, Verdict};
pub use settings::{MonotonicityScan, SearchSettings};
pub use uncertainty::{Uncertainty, UncertaintyInput};
