//! Load/unload ramp: none, rigid, or deformable arms given as modes.

/// One mode of a ramp arm, scaled to shape 1 at the contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmMode {
    /// Undamped natural frequency, Hz.
    pub frequency_hz: f64,
    /// Modal mass, kg.
    pub mass_kg: f64,
    /// Base participation: inertia load = mass x participation x a(t).
    pub participation: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}

/// Which ramp model stands at the rim.
#[derive(Clone, Debug, PartialEq)]
pub enum RampModel {
    /// No ramp.
    None,
    /// Contact points fixed to the base.
    Rigid,
    /// Contact points on flexible arms; top and bottom are separate.
    Deformable {
        /// Modes of the top arm.
        top: Vec<ArmMode>,
        /// Modes of the bottom arm.
        bottom: Vec<ArmMode>,
    },
}

/// The ramp and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct RampParameters {
    /// Model.
    pub model: RampModel,
    /// Static clearance between disk and top arm, m.
    pub clearance_top_m: f64,
    /// Static clearance between disk and bottom arm, m.
    pub clearance_bottom_m: f64,
    /// Radius of the contact points, m.
    pub radius_m: f64,
    /// Angle of the contact points in the disk's sense of rotation, rad.
    pub angle_rad: f64,
    /// Coefficient of restitution of an impact, 0 <= e <= 1 (Newton's law).
    pub restitution: f64,
    /// Local stiffness between each arm and its contact point, N/m; `None`: hard. The spring has
    /// hardly a mass, so restitution has no meaning beside it.
    pub contact_stiffness_n_per_m: Option<f64>,
}

/// What is wrong with a ramp.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RampError {
    /// The disk and an arm overlap before the shock.
    #[error("the {side} arm overlaps the disk by {amount_m:e} m before the shock")]
    Overlap {
        /// Which arm.
        side: &'static str,
        /// Overlap, m.
        amount_m: f64,
    },
    /// A parameter is outside its range.
    #[error("ramp parameter {name} = {value:e} is outside its range ({allowed})")]
    Parameter {
        /// Name of the field.
        name: &'static str,
        /// Value found.
        value: f64,
        /// Allowed range in words.
        allowed: &'static str,
    },
    /// A deformable arm without a mode cannot move at its contact point.
    #[error("the {side} arm has no mode: use a rigid ramp")]
    NoMode {
        /// Which arm.
        side: &'static str,
    },
}

impl RampParameters {
    /// Checks ranges. A clearance of 0 is allowed: disk and arm touch without force.
    ///
    /// # Errors
    /// The first fault found.
    pub fn validate(&self) -> Result<(), RampError> {
        // Without a ramp its numbers mean nothing.
        if self.model == RampModel::None {
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
        }
        if let RampModel::Deformable { top, bottom } = &self.model {
            for (side, arm) in [("top", top), ("bottom", bottom)] {
                if arm.is_empty() {
                    return Err(RampError::NoMode { side });
                }
                arm.iter().try_for_each(ArmMode::validate)?;
            }
        }
        Ok(())
    }
}

impl ArmMode {
    fn validate(&self) -> Result<(), RampError> {
        let positive = "finite and above 0";
        let checks = [
            (
                "frequency_hz",
                self.frequency_hz,
                self.frequency_hz > 0.0,
                positive,
            ),
            ("mass_kg", self.mass_kg, self.mass_kg > 0.0, positive),
            ("participation", self.participation, true, "finite"),
            (
                "damping_ratio",
                self.damping_ratio,
                self.damping_ratio >= 0.0,
                "finite and at least 0",
            ),
        ];
        for (name, value, ok, allowed) in checks {
            if !ok || !value.is_finite() {
                return Err(RampError::Parameter {
                    name,
                    value,
                    allowed,
                });
            }
        }
        Ok(())
    }
}
