//! Ramp model of two separate flexible arms, each given by its own modes.

use super::mode::{ArmMode, ContactMode};
use super::model::RampModel;

/// Contact points on two separate flexible arms: a force on one does not move the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Arms {
    /// Modes of the top arm.
    pub top: Vec<ArmMode>,
    /// Modes of the bottom arm.
    pub bottom: Vec<ArmMode>,
}

impl RampModel for Arms {
    fn name(&self) -> &'static str {
        "deformable"
    }

    fn contacts(&self) -> Option<Vec<ContactMode>> {
        let of = |arm: &[ArmMode], shape: [f64; 2]| -> Vec<ContactMode> {
            let mode = |mode: &ArmMode| ContactMode {
                frequency_hz: mode.frequency_hz,
                mass_kg: mode.mass_kg,
                shape,
                participation: mode.participation,
                damping_ratio: mode.damping_ratio,
            };
            arm.iter().map(mode).collect()
        };
        Some([of(&self.top, [1.0, 0.0]), of(&self.bottom, [0.0, 1.0])].concat())
    }
}
