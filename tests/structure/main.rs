//! Floors, names, architecture page.

mod architecture;
mod floors;
mod wording;
