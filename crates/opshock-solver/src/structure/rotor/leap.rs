//! Advances the rotor (harmonics coupled with hub or base) over a time, and applies impulses to it.

use super::state::{Leap, RotorScratch, RotorState};
use super::whole::Rotor;
use crate::modal::{CoupledFlow, CoupledState, FirstOrderResponse, Phase, PointReadout};
use nalgebra::Complex;

impl Rotor {
    /// Sets the tables of `h_s`, with responses to a wave when its rate is given. Does not allocate in tables that were
    /// set before.
    pub fn set_leap(&self, h_s: f64, sigma_per_s: Option<Complex<f64>>, leap: &mut Leap) {
        leap.h_s = h_s;
        leap.flows.resize(self.parts.len(), CoupledFlow::default());
        leap.responses.resize(self.parts.len(), Vec::new());
        let tables = leap.flows.iter_mut().zip(&mut leap.responses);
        for (part, (flow, responses)) in self.parts.iter().zip(tables) {
            part.modes.set_flow(h_s, flow);
            let rates = part.modes.rates_per_s();
            responses.resize(rates.len(), FirstOrderResponse::default());
            if let (Some(sigma), Some(_)) = (sigma_per_s, &part.drive) {
                for (response, s) in responses.iter_mut().zip(rates) {
                    *response = FirstOrderResponse::new(*s, sigma, h_s);
                }
            }
        }
    }

    /// `to` := `from` after the time, under `amplitude` times a forcing that starts at `phase`, if any.
    pub(super) fn carry(
        &self,
        leap: &Leap,
        forcing: Option<(&Phase, f64)>,
        from: &RotorState,
        to: &mut RotorState,
    ) {
        for (i, part) in self.parts.iter().enumerate() {
            let to = &mut to.parts[i];
            leap.flows[i].apply(&from.parts[i], to);
            if let (Some(drive), Some((phase, amplitude))) = (&part.drive, forcing) {
                for (k, response) in leap.responses[i].iter().enumerate() {
                    drive.add(k, amplitude * response.increment(phase), to);
                }
            }
        }
    }

    /// `ahead` := `now` after free motion over the partial step, or over a whole step.
    pub fn flow(&self, now: &RotorState, partial: Option<&Leap>, ahead: &mut RotorState) {
        self.carry(partial.unwrap_or(&self.step), None, now, ahead);
    }

    /// Advances `state` over a whole step within a stretch of the pulse, or after it.
    pub fn step(&self, phase: Option<&Phase>, state: &mut RotorState, scratch: &mut RotorScratch) {
        scratch.start.copy_from(state);
        self.carry(&self.step, phase.map(|p| (p, 1.0)), &scratch.start, state);
    }

    /// Advances `state` over `h_s` under `amplitude` times a forcing of one closed form.
    pub fn advance(
        &self,
        h_s: f64,
        forcing: Option<(Complex<f64>, &Phase)>,
        amplitude: f64,
        state: &mut RotorState,
        scratch: &mut RotorScratch,
    ) {
        let RotorScratch { leap, start, .. } = scratch;
        start.copy_from(state);
        self.set_leap(h_s, forcing.map(|(sigma, _)| sigma), leap);
        self.carry(
            leap,
            forcing.map(|(_, phase)| (phase, amplitude)),
            start,
            state,
        );
    }

    /// Both gaps after the flow per unit impulse of each contact at its start.
    pub fn compliance(&self, partial: Option<&Leap>) -> [[f64; 2]; 2] {
        let flows = &partial.unwrap_or(&self.step).flows;
        self.sum_over_gaps(|i, entrance, point| flows[i].compliance(entrance, point))
    }

    /// Rates of both gaps per unit impulse of each contact.
    pub fn mobility(&self) -> [[f64; 2]; 2] {
        self.sum_over_gaps(|_, entrance, point| point.read(entrance).1)
    }

    fn sum_over_gaps(
        &self,
        response: impl Fn(usize, &CoupledState, &PointReadout) -> f64,
    ) -> [[f64; 2]; 2] {
        let mut sum = [[0.0; 2]; 2];
        for (i, part) in self.parts.iter().enumerate() {
            let own = part.over_gaps(|entrance, point| response(i, entrance, point));
            add(&mut sum, &own);
        }
        sum
    }

    /// Loss of energy per squared impulse in the ripple of equal impulses, one per step.
    pub fn ripple_loss(&self) -> [[f64; 2]; 2] {
        let mut sum = [[0.0; 2]; 2];
        let parts = self.parts.iter();
        parts.for_each(|part| add(&mut sum, &part.ripple_loss));
        sum
    }

    /// Impulses of both contacts, now and ahead.
    pub fn kick(
        &self,
        impulse: [f64; 2],
        partial: Option<&Leap>,
        now: &mut RotorState,
        ahead: &mut RotorState,
    ) {
        let flows = &partial.unwrap_or(&self.step).flows;
        for (i, part) in self.parts.iter().enumerate() {
            let (now, ahead) = (&mut now.parts[i], &mut ahead.parts[i]);
            part.for_impulses(impulse, |entrance, share| {
                now.add(entrance, share);
                flows[i].add_kick(entrance, share, ahead);
            });
        }
    }
}

/// Adds `b` to `a`.
pub(in crate::structure) fn add(a: &mut [[f64; 2]; 2], b: &[[f64; 2]; 2]) {
    for (a, b) in a.iter_mut().flatten().zip(b.iter().flatten()) {
        *a += b;
    }
}
