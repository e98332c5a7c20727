//! Amplitudes of the rotor's modes, part by part, and their flow over a time.

use crate::modal::{Coordinates, CoupledFlow, CoupledState, FirstOrderResponse};

/// Amplitudes of the modes of every part.
#[derive(Clone, Debug, Default)]
pub(in crate::structure) struct RotorState {
    pub parts: Vec<CoupledState>,
}

impl RotorState {
    pub fn copy_from(&mut self, other: &Self) {
        for (own, other) in self.parts.iter_mut().zip(&other.parts) {
            own.copy_from(other);
        }
    }

    pub fn add(&mut self, other: &Self, factor: f64) {
        for (own, other) in self.parts.iter_mut().zip(&other.parts) {
            own.add(other, factor);
        }
    }

    pub fn reset(&mut self) {
        self.parts.iter_mut().for_each(CoupledState::reset);
    }
}

/// Scratch.
#[derive(Clone, Debug, Default)]
pub(in crate::structure) struct RotorScratch {
    pub(super) leap: Leap,
    pub(super) coordinates: Vec<Coordinates>,
    pub(super) start: RotorState,
    pub(super) point: RotorState,
    /// State whose work and loss are computed.
    pub walk: RotorState,
}

/// Flow of every mode over one time, and its response to the pulse's wave.
#[derive(Clone, Debug, Default)]
pub(in crate::structure) struct Leap {
    pub(super) h_s: f64,
    pub(super) flows: Vec<CoupledFlow>,
    pub(super) responses: Vec<Vec<FirstOrderResponse>>,
}
