//! Sweeps: points in parallel, one writer, progress.

pub mod progress;
pub mod simulator;

pub use progress::{Estimate, Event, PointLabel, Progress, Silent};
pub use simulator::{Onset, Simulator};
