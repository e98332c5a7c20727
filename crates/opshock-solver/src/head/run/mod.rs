//! One shock: the time loop, its events, the search for touch between steps, the record.

mod books;
mod resume;
mod running;
mod shock;
mod steps;
mod touch;
mod workspace;

pub use resume::{HeadState, Stretch};
pub use workspace::HeadWorkspace;
