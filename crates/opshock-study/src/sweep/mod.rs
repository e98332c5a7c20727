//! Sweeps: points in parallel, one writer, progress.
//!
//! A sweep asks a [`Simulator`] for verdicts and tells them to the searches of all points. What is
//! finished goes through a bounded channel to one writer thread, which puts it on the disk and only
//! then tells [`Progress`]. Running a sweep again goes on where it stopped, and ends with the same
//! table to the bit: the table is a function of the probes that the searches ask, and their verdicts
//! of the scenes.

mod audit;
mod engine;
mod estimate;
pub mod forecast;
mod from_study;
mod guard;
mod held;
mod histories;
mod input;
mod latest;
mod ledger;
mod lucky;
mod merge;
mod neighbours;
mod options;
pub mod physics;
mod probed;
pub mod progress;
pub mod refine;
mod replay;
pub mod rounds;
mod rows;
pub mod shard;
mod shelf;
pub mod simulator;
pub mod stop;
mod unkept;
mod writer;

pub use audit::audit;
pub use engine::sweep;
pub use input::{BarPlan, SweepInput, SweepPoint};
pub use merge::{Disagreement, MergeEnd, Merged, merge};
pub use options::{Ending, SweepEnd, SweepOptions};
pub use physics::Physics;
pub use progress::{Estimate, Event, PointLabel, Progress, ProgressKind, Silent};
pub use replay::{replay, stored};
pub use shard::Shard;
pub use shelf::Counts;
pub use simulator::{Onset, Simulator};
pub use stop::StopFlag;
pub use unkept::unkept;
