//! Floors, names, architecture page, committed results.

mod architecture;
mod floors;
mod results;
mod skips;
mod wording;
