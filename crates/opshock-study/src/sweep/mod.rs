//! Sweeps of a study: points in parallel, one writer, progress.
//!
//! A sweep gets verdicts from a [`Simulator`] and reports them to the searches of all points. Finished simulations go
//! through a bounded channel to one writer thread, which puts them on the disk and only then informs [`Progress`]. A
//! sweep run again continues where it stopped, and ends with the same table to the bit: the table is a function of the
//! probes that the searches request, and their verdicts of the scenes.

pub mod added_points;
mod audit;
mod engine;
pub mod forecast;
mod forgotten;
mod from_study;
mod guard;
mod histories;
mod input;
mod latest;
mod lucky;
mod made_up;
mod made_up_interval;
mod merge;
mod neighbours;
mod options;
mod outlook;
mod pace;
pub mod physics;
mod probed;
pub mod progress;
mod recording;
mod registry;
mod remainder;
mod replay;
pub mod rounds;
mod rows;
mod run_time;
pub mod shard;
pub mod simulator;
pub mod spread;
pub mod stop;
mod structure_run_cache;
mod unkept;
mod writer;

pub use audit::audit;
pub use engine::sweep;
pub use input::{PointFilm, SweepInput, SweepPoint, UncertaintyPlan};
pub use merge::{Disagreement, MergeEnd, Merged, merge};
pub use options::{Ending, SweepEnd, SweepOptions};
pub use physics::Physics;
pub use progress::{Estimate, Event, PointLabel, Progress, ProgressKind, Silent};
pub use replay::{replay, stored};
pub use shard::Shard;
pub use simulator::{Onset, Simulator};
pub use stop::{StopFlag, Until};
pub use structure_run_cache::Counts;
pub use unkept::unkept;
