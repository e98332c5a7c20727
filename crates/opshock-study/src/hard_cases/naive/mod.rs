//! Naive methods that were replaced by better ones, as short as possible: their effect on the hard cases is measured
//! with them.

pub mod asperities;
pub mod contact;
pub mod film;
pub mod plate;
pub mod search;
pub mod time;
