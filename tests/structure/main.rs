//! Tests of the source tree: layers, circular imports, lengths, names, architecture page, committed results.

mod architecture;
mod circles;
mod codes;
mod floors;
mod keys;
mod results;
mod sizes;
mod skips;
mod wording;
