//! Reads and writes `DynLULS.def`: slider, pulse, disk and ramp of a dynamic run (load, unload, shock).
//!
//! Two lines of header, then 19 sections that a line of asterisks opens (`layout`). In a section a line of
//! names is followed by a line of values. Names are known of the first four sections, and of the disk's
//! material and the place of its ramp; those values are read by name. Others are read by their order:
//!
//! | section | values |
//! |---|---|
//! | shock | mode, start, width, magnitude, time constant |
//! | matrices | number of rows, a step's share, the slider's first freedom |
//! | disk | before E: radii, thickness; the last two: Rayleigh damping |
//!
//! Each has a range, so that values in another order are rejected and not mistaken for these.

mod contents;
pub(super) mod deck;
pub mod flexure;
pub(super) mod layout;
mod read;
mod values;
mod write;

pub use contents::{
    Contents, DeckSuspension, Disk, DynamicFile, Gas, Matrices, Ramp, Shape, Shock,
};
pub use read::read;
pub use write::write;
