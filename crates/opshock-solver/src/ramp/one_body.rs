//! Ramp model whose arms are one flexible body, so that a force on one arm moves the other as well.

use super::mode::ContactMode;
use super::model::RampModel;

/// One mode of a ramp of which both arms are one body, of unit modal mass.
///
/// ```text
/// q'' + 2 ζ ω q' + ω² q = φ_top λ_top − φ_bottom λ_bottom + p a(t),    x_arm = Σ φ_arm q
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
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

/// Contact points on one flexible body: what pushes one arm moves the other as well.
#[derive(Clone, Debug, PartialEq)]
pub struct OneBody {
    /// Modes of the body.
    pub modes: Vec<CoupledMode>,
}

impl RampModel for OneBody {
    fn name(&self) -> &'static str {
        "coupled"
    }

    fn contacts(&self) -> Option<Vec<ContactMode>> {
        let mode = |mode: &CoupledMode| ContactMode {
            frequency_hz: mode.frequency_hz,
            mass_kg: 1.0,
            shape: mode.shape_per_sqrt_kg,
            participation: mode.participation_sqrt_kg,
            damping_ratio: mode.damping_ratio,
        };
        Some(self.modes.iter().map(mode).collect())
    }
}

impl From<&ContactMode> for CoupledMode {
    /// The mode scaled to unit modal mass.
    fn from(mode: &ContactMode) -> Self {
        Self {
            frequency_hz: mode.frequency_hz,
            shape_per_sqrt_kg: mode.shape_per_sqrt_kg(),
            participation_sqrt_kg: mode.participation_sqrt_kg(),
            damping_ratio: mode.damping_ratio,
        }
    }
}
