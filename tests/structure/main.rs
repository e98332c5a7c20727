//! Floors, circles, names, architecture page, committed results.

mod architecture;
mod circles;
mod floors;
mod results;
mod skips;
mod wording;
