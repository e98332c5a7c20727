//! Modes of a ramp: of one arm, or of any body that carries the contact points.

use super::error::{RampError, first_fault};

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

/// One mode of a ramp, of any scale.
///
/// ```text
/// m (q'' + 2 ζ ω q' + ω² q) = φ_top λ_top − φ_bottom λ_bottom + m p a(t),    x_arm = Σ φ_arm q
/// ```
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct ContactMode {
    /// Undamped natural frequency, Hz.
    pub frequency_hz: f64,
    /// Modal mass m, kg.
    pub mass_kg: f64,
    /// Displacement φ of the top and the bottom contact point per unit of the mode.
    pub shape: [f64; 2],
    /// Base participation p: inertia load = mass x participation x a(t).
    pub participation: f64,
    /// Damping ratio ζ.
    pub damping_ratio: f64,
}

/// One term of a relaxing modulus, E(t) = E∞ + Σ Eᵢ e^{−t/τᵢ} (Prony series).
///
/// ```text
/// m q'' + k₀ (q − Σ gᵢ zᵢ) = f,    τᵢ zᵢ' = q − zᵢ
/// ```
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Relaxation {
    /// Share gᵢ = Eᵢ/E₀ of the instantaneous modulus that relaxes.
    pub share: f64,
    /// Relaxation time τᵢ, s.
    pub time_s: f64,
}

impl ContactMode {
    /// Shape of the mode scaled to unit modal mass, 1/√kg.
    pub fn shape_per_sqrt_kg(&self) -> [f64; 2] {
        let scale = self.mass_kg.sqrt().recip();
        self.shape.map(|shape| shape * scale)
    }

    /// Load per unit a(t) on the mode scaled to unit modal mass, √kg.
    pub fn participation_sqrt_kg(&self) -> f64 {
        self.mass_kg.sqrt() * self.participation
    }

    /// The mode as one arm sees it, scaled to shape 1 at its contact point; `None` where that point
    /// rests.
    pub fn at_contact(&self, arm: usize) -> Option<ArmMode> {
        let shape = self.shape[arm];
        (shape != 0.0).then(|| ArmMode {
            frequency_hz: self.frequency_hz,
            mass_kg: self.mass_kg * (shape * shape).recip(),
            participation: self.participation * shape,
            damping_ratio: self.damping_ratio,
        })
    }

    pub(super) fn validate(&self) -> Result<(), RampError> {
        let (positive, ratio) = ("finite and above 0", self.damping_ratio);
        let [top, bottom] = self.shape;
        first_fault(&[
            (
                "frequency_hz",
                self.frequency_hz,
                self.frequency_hz > 0.0,
                positive,
            ),
            ("mass_kg", self.mass_kg, self.mass_kg > 0.0, positive),
            ("shape at the top contact", top, true, "finite"),
            ("shape at the bottom contact", bottom, true, "finite"),
            ("participation", self.participation, true, "finite"),
            (
                "damping_ratio",
                ratio,
                ratio >= 0.0,
                "finite and at least 0",
            ),
        ])
    }
}

impl Relaxation {
    pub(super) fn validate(&self) -> Result<(), RampError> {
        let (share, time_s) = (self.share, self.time_s);
        first_fault(&[
            ("relaxing share", share, share > 0.0, "finite and above 0"),
            (
                "relaxation time",
                time_s,
                time_s > 0.0,
                "finite and above 0",
            ),
        ])
    }
}
