//! Input of the ramp as plain data: its model, place, clearances and contact law.

use super::error::{RampError, first_fault};
use super::model::RampBody;

/// The ramp, its place and its contact with the disk.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct RampParameters {
    /// The ramp itself, of any [`RampModel`](super::RampModel).
    pub model: RampBody,
    /// Static clearance between disk and top arm, m.
    pub clearance_top_m: f64,
    /// Static clearance between disk and bottom arm, m.
    pub clearance_bottom_m: f64,
    /// Radius of the contact points, m.
    pub radius_m: f64,
    /// Angle of the contact points in the disk's sense of rotation, rad.
    pub angle_rad: f64,
    /// Coefficient of restitution of an impact, 0 <= e <= 1; Newton's if e > 0.
    pub restitution: f64,
    /// Local stiffness between each arm and its contact point, N/m; `None`: hard. The spring has hardly any mass, so
    /// restitution has no effect beside it.
    pub contact_stiffness_n_per_m: Option<f64>,
    /// Natural frequency of that spring on its mass, Hz; usually [`CONTACT_FREQUENCY_HZ`].
    pub contact_frequency_hz: f64,
    /// Its damping ratio; usually [`CONTACT_DAMPING_RATIO`].
    pub contact_damping_ratio: f64,
}

/// Frequency of a contact's spring on its mass, Hz: above what an impact transmits to the slider. The mass must not
/// vanish with the step, or the impulses of a lasting contact, one per step, would take the spring's energy at every
/// step.
pub const CONTACT_FREQUENCY_HZ: f64 = 4.0e5;
/// Damping ratio of a contact's spring on its mass: ringing at that frequency is not physical. It corresponds to a loss
/// factor of 6 % at 25 kHz, as polymers have it.
pub const CONTACT_DAMPING_RATIO: f64 = 0.5;

impl RampParameters {
    /// Checks ranges. A clearance of 0 is allowed: disk and arm touch without force.
    ///
    /// # Errors
    /// The first fault found.
    pub fn validate(&self) -> Result<(), RampError> {
        // Without a ramp its numbers have no meaning.
        if self.model.is_absent() {
            return Ok(());
        }
        for (side, clearance) in [
            ("top", self.clearance_top_m),
            ("bottom", self.clearance_bottom_m),
        ] {
            if clearance < 0.0 {
                return Err(RampError::Overlap {
                    side,
                    amount_m: -clearance,
                });
            }
            if !clearance.is_finite() {
                return Err(RampError::Parameter {
                    name: "clearance",
                    value: clearance,
                    allowed: "finite and at least 0",
                });
            }
        }
        if !(0.0..=1.0).contains(&self.restitution) {
            return Err(RampError::Parameter {
                name: "restitution",
                value: self.restitution,
                allowed: "0 to 1",
            });
        }
        if let Some(stiffness) = self.contact_stiffness_n_per_m {
            if !(stiffness > 0.0 && stiffness.is_finite()) {
                return Err(RampError::Parameter {
                    name: "contact stiffness",
                    value: stiffness,
                    allowed: "above 0",
                });
            }
            if self.restitution != 0.0 {
                return Err(RampError::Parameter {
                    name: "restitution",
                    value: self.restitution,
                    allowed: "0 with a contact stiffness",
                });
            }
            let (frequency_hz, ratio) = (self.contact_frequency_hz, self.contact_damping_ratio);
            first_fault(&[
                (
                    "contact frequency",
                    frequency_hz,
                    frequency_hz > 0.0,
                    "finite and above 0",
                ),
                (
                    "contact damping ratio",
                    ratio,
                    (0.0..=1.0).contains(&ratio),
                    "0 to 1",
                ),
            ])?;
        }
        self.model.validate()
    }
}
