//! Version, commit and physics versions that every product carries.

/// Version of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Commit the program was built from: twelve hexadecimal digits, with `+changes` when the sources
/// differed from it, or `unknown` when they were in no repository.
pub const COMMIT: &str = env!("OPSHOCK_COMMIT");

/// `opshock VERSION (COMMIT)`, the line under every figure and table.
pub fn program() -> String {
    format!("opshock {VERSION} ({COMMIT})")
}

/// What `--version` prints after the name.
pub const LONG_VERSION: &str =
    concat!(env!("CARGO_PKG_VERSION"), " (", env!("OPSHOCK_COMMIT"), ")");

/// Physics version of the structure stage (disk, ramp, contact). Raised by hand when the same
/// scene gives other numbers than before; stored runs of an older version are then run again.
pub const PHYSICS_STRUCTURE: u32 = 8;

/// Physics version of the head stage (film, slider, suspension, criterion).
pub const PHYSICS_HEAD: u32 = 12;
