//! Version, commit and physics versions that every product carries.

use std::sync::LazyLock;

/// Version of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Commit the program was built from: twelve hexadecimal digits, with `+changes` when the sources
/// differed from it, or `unknown` when they were in no repository.
pub const COMMIT: &str = env!("OPSHOCK_COMMIT");

/// `opshock VERSION (COMMIT, physics STRUCTURE/HEAD)`, the line under every figure and table.
pub fn program() -> String {
    program_of(VERSION, COMMIT, [PHYSICS_STRUCTURE, PHYSICS_HEAD])
}

/// The same of another program: the one whose numbers a store holds.
pub fn program_of(version: &str, commit: &str, [structure, head]: [u32; 2]) -> String {
    format!("opshock {version} ({commit}, physics {structure}/{head})")
}

/// What `--version` prints after the name.
pub fn long_version() -> &'static str {
    static TEXT: LazyLock<String> = LazyLock::new(program);
    TEXT.strip_prefix("opshock ").unwrap_or_default()
}

/// Physics version of the structure stage (disk, ramp, contact). Raised by hand when the same
/// scene gives other numbers than before; stored runs of an older version are then run again.
pub const PHYSICS_STRUCTURE: u32 = 8;

/// Physics version of the head stage (film, slider, suspension, criterion).
pub const PHYSICS_HEAD: u32 = 15;
