//! Errors of building or running a structural model.

use crate::disk::DiskError;
use crate::ramp::RampError;
use crate::shock::PulseError;

/// Why a structural model cannot be built or run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StructureError {
    /// Disk.
    #[error(transparent)]
    Disk(#[from] DiskError),
    /// Ramp.
    #[error(transparent)]
    Ramp(#[from] RampError),
    /// Pulse.
    #[error(transparent)]
    Pulse(#[from] PulseError),
    /// An oblique shock without a hub that it could tilt, or with shares that are not numbers.
    #[error("an oblique shock needs a hub, on which it tilts the disk, and finite shares")]
    Direction,
    /// Invalid modes of a base: too many, too light, or under an oblique shock.
    #[error(
        "a vibrating base has at most 16 modes of finite numbers, a frequency above 0 and a damping ratio \
         in [0, 1), is heavier than disk, hub and arms where they stand on it, and takes a straight shock"
    )]
    Base,
    /// Step or window out of range.
    #[error("{name} = {value:e} is outside its range ({allowed})")]
    Time {
        /// Name of the quantity.
        name: &'static str,
        /// Value found.
        value: f64,
        /// Allowed range in words.
        allowed: &'static str,
    },
    /// A motion that is not a finite number.
    #[error("the structure's motion is not finite at {time_s:e} s")]
    NotFinite {
        /// Time, s.
        time_s: f64,
    },
}
