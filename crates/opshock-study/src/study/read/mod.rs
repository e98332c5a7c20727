//! Turns a tree of TOML values into checked settings, by the table of keys.
//!
//! Every value is checked alone here: known key, kind, range, usual range. What depends on
//! several keys is checked in `validity`.

mod axis;
mod limit;
mod message;
mod reader;
mod value;

pub use limit::{MAX_POINTS, too_many_points};
pub use reader::{Reader, join};
