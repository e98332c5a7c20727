//! What a tolerance is worth: the change of a critical shock between two values of a key, found in pairs so that common numerical
//! errors cancel.

mod answer;
mod pair;
mod simulated;

pub use answer::{Change, WorthAnswer, WorthRow};
pub use pair::{Bracket, End, FINENESS, Pair, Shaken, find};
pub use simulated::{ENDS, STORE, Starts, Worth};
