//! Journal, HDF5 results, lock, resume.

pub mod history;
pub mod summary;

pub use summary::{AxisValue, ErrorPart, Flag, PointSummary, Status, Summary, Totals};
