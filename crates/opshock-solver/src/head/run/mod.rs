//! Runs one shock through a head: time loop, events, search for touch between steps, records.

mod balances;
mod resume;
mod running;
mod shock;
mod steps;
mod touch;
mod workspace;

pub use resume::{HeadState, Stretch};
pub use workspace::HeadWorkspace;
