//! State and scratch of runs of one head, sized once.

use crate::fixed_point::FixedPoint;
use crate::head::model::HeadModel;
use crate::head::stage_scratch::StageScratch;
use crate::integrator::Stepper;
use crate::shock::{Pulse, PulseShape};

/// State and scratch of one run at a time, sized once for a model.
#[derive(Clone, Debug)]
pub struct HeadWorkspace {
    /// ψ of every cell, coordinates, velocities.
    pub(super) y: Vec<f64>,
    pub(super) rate: Vec<f64>,
    pub(super) stepper: Stepper,
    pub(super) scratch: StageScratch,
    pub(super) exchange: Option<FixedPoint>,
    /// Coordinates and velocities relative to the pivot.
    pub(super) seen: [Vec<f64>; 2],
    pub(super) pulse_events_s: Vec<f64>,
}

impl HeadWorkspace {
    /// Storage for runs of `model`.
    pub fn new(model: &HeadModel) -> Self {
        let n = model.n_unknowns();
        Self {
            y: vec![0.0; n],
            rate: vec![0.0; n],
            stepper: Stepper::new(model.tableau, n),
            scratch: StageScratch::new(model),
            exchange: model
                .resolution
                .coupling
                .method()
                .map(|m| FixedPoint::new(m, 3)),
            seen: [0, 1].map(|_| vec![0.0; model.mechanics.len()]),
            pulse_events_s: Vec::new(),
        }
    }
}

/// Instants at which the pulse jumps or kinks.
pub(super) fn pulse_events(pulse: &Pulse, out: &mut Vec<f64>) {
    out.clear();
    match &pulse.shape {
        PulseShape::Trapezoid { rise_share } => {
            let rise = rise_share * pulse.width_s;
            out.extend([rise, pulse.width_s - rise]);
        }
        PulseShape::Table { time_s, .. } => out.extend_from_slice(time_s),
        PulseShape::HalfSine
        | PulseShape::Haversine
        | PulseShape::Square
        | PulseShape::DampedSine { .. } => {}
    }
    out.push(pulse.width_s);
}
