//! Load/unload ramp: none, rigid, deformable arms given as modes each, or both arms as one body.

/// One mode of a ramp arm, scaled to shape 1 at the contact point.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
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

/// One mode of a ramp of which both arms are one body, of unit modal mass.
///
/// ```text
/// q'' + 2 ζ ω q' + ω² q = φ_top λ_top − φ_bottom λ_bottom + p a(t),    x_arm = Σ φ_arm q
/// ```
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct CoupledMode {
    /// Undamped natural frequency, Hz.
    pub frequency_hz: f64,
    /// Displacement φ of the top and the bottom contact point per unit of the mode, 1/√kg.
    pub shape_per_sqrt_kg: [f64; 2],
    /// Base participation p: load per inertia load per mass a(t), √kg.
    pub participation_sqrt_kg: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}

impl CoupledMode {
    /// The mode of the ramp upside down: load and displacements change sign together, and so the mode's
    /// coordinate, and the arms change places.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let [top, bottom] = self.shape_per_sqrt_kg;
        Self {
            shape_per_sqrt_kg: [bottom, top],
            ..*self
        }
    }
}

/// Which ramp model stands at the rim.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
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
    /// Contact points on one flexible body: what pushes one arm moves the other as well.
    Coupled {
        /// Modes of the body.
        modes: Vec<CoupledMode>,
    },
}

/// The ramp and where it stands.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
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
    /// Natural frequency of that spring on its mass, Hz; usually [`CONTACT_FREQUENCY_HZ`].
    pub contact_frequency_hz: f64,
    /// Its damping ratio; usually [`CONTACT_DAMPING_RATIO`].
    pub contact_damping_ratio: f64,
}

/// Frequency of a contact's spring on its mass, Hz: above what an impact carries to the slider. The
/// mass must not vanish with the step, or the impulses of a lasting contact, one a step, would take
/// the spring's energy at every step.
pub const CONTACT_FREQUENCY_HZ: f64 = 4.0e5;
/// Damping ratio of a contact's spring on its mass: ringing at that frequency is no physics. It is a
/// loss factor of 6 % at 25 kHz, as polymers have it.
pub const CONTACT_DAMPING_RATIO: f64 = 0.5;

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
    /// No mode of the body moves a contact point.
    #[error("no mode of the ramp moves its {side} contact point: use a rigid ramp")]
    CannotMove {
        /// Which arm.
        side: &'static str,
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
        if let RampModel::Deformable { top, bottom } = &self.model {
            for (side, arm) in [("top", top), ("bottom", bottom)] {
                if arm.is_empty() {
                    return Err(RampError::NoMode { side });
                }
                arm.iter().try_for_each(ArmMode::validate)?;
            }
        }
        if let RampModel::Coupled { modes } = &self.model {
            modes.iter().try_for_each(CoupledMode::validate)?;
            for (at, side) in ["top", "bottom"].into_iter().enumerate() {
                if modes.iter().all(|mode| mode.shape_per_sqrt_kg[at] == 0.0) {
                    return Err(RampError::CannotMove { side });
                }
            }
        }
        Ok(())
    }
}

impl CoupledMode {
    /// The mode as one arm sees it, scaled to shape 1 at its contact point; `None` where that point
    /// rests.
    pub fn at_contact(&self, arm: usize) -> Option<ArmMode> {
        let shape = self.shape_per_sqrt_kg[arm];
        (shape != 0.0).then(|| ArmMode {
            frequency_hz: self.frequency_hz,
            mass_kg: (shape * shape).recip(),
            participation: self.participation_sqrt_kg * shape,
            damping_ratio: self.damping_ratio,
        })
    }

    fn validate(&self) -> Result<(), RampError> {
        let [top, bottom] = self.shape_per_sqrt_kg;
        let participation = self.participation_sqrt_kg;
        let checks = [
            (
                "frequency_hz",
                self.frequency_hz,
                self.frequency_hz > 0.0,
                "finite and above 0",
            ),
            ("shape at the top contact", top, true, "finite"),
            ("shape at the bottom contact", bottom, true, "finite"),
            ("participation", participation, true, "finite"),
            (
                "damping_ratio",
                self.damping_ratio,
                self.damping_ratio >= 0.0,
                "finite and at least 0",
            ),
        ];
        first_fault(&checks)
    }
}

/// Name, value, whether it is in range, the range in words: the first that is not.
fn first_fault(checks: &[(&'static str, f64, bool, &'static str)]) -> Result<(), RampError> {
    let fault = checks
        .iter()
        .find(|(_, value, ok, _)| !(*ok && value.is_finite()));
    match fault {
        Some(&(name, value, _, allowed)) => Err(RampError::Parameter {
            name,
            value,
            allowed,
        }),
        None => Ok(()),
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
        first_fault(&checks)
    }
}
