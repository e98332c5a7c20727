//! Pose of the slider over the disk: height, pitch and roll.

use crate::slider::clearance::ClearanceMap;

/// Pose of the slider's reference plane over the disk's local plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Attitude {
    /// Height of the reference plane over the disk at the slider's centre (no crown), m.
    pub centre_height_m: f64,
    /// Pitch, rad; positive: leading edge up.
    pub pitch_rad: f64,
    /// Roll, rad; positive: outer side (+y) up.
    pub roll_rad: f64,
}

/// Clearance of the usual attitude, m.
const USUAL_CLEARANCE_M: f64 = 1e-8;

/// Height of the windward edge over the other in the usual attitude, m.
const USUAL_RISE_M: f64 = 1e-7;

/// Windward edge up by a usual amount, no roll, the closest point at `USUAL_CLEARANCE_M`. `wind` is the disk's velocity
/// along x; only its sign matters.
pub(super) fn usual_attitude(clearance: &ClearanceMap, length_m: f64, wind: f64) -> Attitude {
    let pitch_rad = USUAL_RISE_M.copysign(wind) / length_m;
    Attitude {
        centre_height_m: USUAL_CLEARANCE_M - clearance.minimum(0.0, pitch_rad, 0.0).value_m,
        pitch_rad,
        roll_rad: 0.0,
    }
}
