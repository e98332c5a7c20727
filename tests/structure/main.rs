//! Floors, circles, names, architecture page, committed results.

mod architecture;
mod circles;
mod floors;
mod keys;
mod results;
mod skips;
mod wording;
