//! Floors, names, architecture page.

mod architecture;
mod floors;
mod skips;
mod wording;
