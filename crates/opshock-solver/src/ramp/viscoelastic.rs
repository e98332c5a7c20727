//! Ramp model of a polymer: the stiffness of every mode relaxes with its material.
//!
//! ```text
//! E(t) = E₀ (1 − Σ gᵢ (1 − e^{−t/τᵢ}))                                  Prony series
//! m q'' + k₀ (q − Σ gᵢ zᵢ) = f,    τᵢ zᵢ' = q − zᵢ                      every mode
//! E*(ω)/E₀ = 1 − Σ gᵢ/(1 + iωτᵢ),    loss factor η = Im E*/Re E*
//! ```
//!
//! The frequencies of the elastic ramp are taken as those of the instantaneous modulus E₀: modes measured or computed
//! with a slower modulus are to be raised by √(E₀/Re E*) at that frequency. One series for all modes is exact for a
//! body of one material whose Poisson's ratio does not relax; a mount that yields then relaxes as well. Damping ratios
//! of the modes add to the series: 0 leaves all damping to it. Solved exactly, by damped modes
//! ([`crate::modal::coupled`]), with contact, on a hub and on a base that vibrates.
//!
//! Source: Ferry, Viscoelastic Properties of Polymers (1980), ch. 1 and 3 (generalised Maxwell model).

use super::mode::{ContactMode, Relaxation};
use super::model::{RampBody, RampModel};

/// A ramp whose modes relax.
#[derive(Clone, Debug, PartialEq)]
pub struct Viscoelastic {
    /// The ramp at its instantaneous modulus.
    pub elastic: RampBody,
    /// Terms of the series.
    pub prony: Vec<Relaxation>,
}

/// A series for polyoxymethylene at room temperature: loss factor 0.0124 at 1 kHz, 0.0213 at 10 kHz, 0.0285 at
/// 100 kHz, and E₀ 10 % above the modulus at 1 kHz.
///
/// Assumed, not fitted to a measurement: a term per decade, so that the loss factor stays within 0.01 to 0.03 where a
/// ramp's modes are, and rises with frequency, since the material's γ relaxation, measured below room
/// temperature at low frequency, moves to megahertz at room temperature (McCrum, Read and Williams, Anelastic and
/// Dielectric Effects in Polymeric Solids, 1967). Give a measured series where there is one.
pub const POM: [Relaxation; 3] = [
    Relaxation {
        share: 0.02,
        time_s: 1e-4,
    },
    Relaxation {
        share: 0.03,
        time_s: 1e-5,
    },
    Relaxation {
        share: 0.05,
        time_s: 1e-6,
    },
];

impl RampModel for Viscoelastic {
    fn name(&self) -> &'static str {
        "viscoelastic"
    }

    fn contacts(&self) -> Option<Vec<ContactMode>> {
        self.elastic.contacts.clone()
    }

    fn relaxation(&self) -> Vec<Relaxation> {
        self.prony.clone()
    }
}
