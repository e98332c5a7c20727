//! Decides each statement of the paper by a number that this program computes.
//!
//! A [`Claim`] is a row: the paper's words, the number, and the bounds between which the statement
//! holds. The number comes from one of two places:
//!
//! | from | statements | its uncertainty |
//! |---|---|---|
//! | [`Shocks`]: the two shocks with three ramps | sections 4.1 and 4.2 | the shocks with each parameter refined |
//! | [`Summary`]: critical shocks | section 4.3 | the uncertainty intervals of the table |
//!
//! Where the paper gives a figure, "about" is met within 10 per cent and a bare figure within 5;
//! where it says "more", "slightly" or "noticeably", the bound is part of the row and a reader may
//! dispute it.

mod answer;
mod catalogue;
mod critical;
mod files;
mod finding;
mod observations;
mod parameter;
mod sensitivity;
mod sensitivity_files;
mod shock_numbers;
mod shocks;

pub use answer::{Answer, ClaimRow, rows, tally};
pub use catalogue::{CLAIMS, Claim, Source};
pub use files::{ClaimTable, write_claims};
pub use finding::{Finding, Part, Spread, findings};
pub use observations::Paper;
pub use sensitivity::{
    Found, Row, Sensitivity, Side, Variant, coarse_sets, merged, shock_sets, touched_ramps,
    with_sets,
};
pub use sensitivity_files::write_sensitivity;
pub use shocks::{Case, ShockError, Shocks, Task, Three};

#[cfg(doc)]
use opshock_study::store::summary::Summary;
