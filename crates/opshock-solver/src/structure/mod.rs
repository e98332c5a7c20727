//! Disk, ramp and their contact: one run gives a structural history.

/// Numerical resolution of the structure.
#[derive(Clone, Debug, PartialEq)]
pub struct StructureResolution {
    /// Step of the grid on which motion is stored and contact is resolved, s.
    pub step_s: f64,
}
