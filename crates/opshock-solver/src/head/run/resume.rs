//! Continues a run of a head from the state in which another run of the same shock ended.
//!
//! At the instant of a restart a run discards everything its steps have accumulated: guesses, factors, contraction and
//! the length of the next step. What follows depends on state and rate alone, so that a run from the onset and one from
//! a kept state agree bit for bit after the restart.

use super::running::{Lowest, Run};
use super::workspace::{HeadWorkspace, pulse_events};
use crate::disk::DiskMotion;
use crate::head::energy::EnergyWatch;
use crate::head::first_order_cells::FirstOrderCells;
use crate::head::model::{HeadModel, ShockLoad};
use crate::head::outcome::{DimpleRecord, HeadCost, StopRecord};
use crate::head::slider_contact::ContactWatch;
use crate::head::stage_scratch::Counters;
use crate::slider::clearance::Clearance;

/// How far a head runs, and from where.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stretch<'a> {
    /// End of the run after the onset, s.
    pub end_s: f64,
    /// Instant at which the head discards its steps and factors, s; none after `end_s`.
    pub restart_s: Option<f64>,
    /// State of a run of the same shock that ended there without a failure.
    pub from: Option<&'a HeadState>,
    /// Whether the state at the end is kept, if the head has not failed.
    pub keeps_end: bool,
}

/// State of a head at the end of a run without a failure.
#[derive(Clone, Debug)]
pub struct HeadState {
    time_s: f64,
    y: Vec<f64>,
    rate: Vec<f64>,
    /// Smallest heights so far where asperities touched, m.
    closest_m: Vec<f64>,
    /// Cells of the film of first order.
    first_order: Vec<usize>,
    clearance: Clearance,
    smallest: Lowest,
    touched_s: Option<f64>,
    dimple: DimpleRecord,
    dimple_force_n: f64,
    stops: [Option<(StopRecord, f64)>; 2],
    contact: Option<ContactWatch>,
    energy: Option<EnergyWatch>,
    cost: HeadCost,
    counters: Counters,
}

impl HeadState {
    /// Memory used, bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Self>()
            + size_of::<f64>() * (self.y.len() + self.rate.len() + self.closest_m.len())
            + size_of::<usize>() * self.first_order.len()
    }
}

impl<'a> Run<'a> {
    /// Continues from `state`. Nothing is recorded.
    pub(super) fn resume(
        model: &'a HeadModel,
        motion: &'a dyn DiskMotion,
        load: ShockLoad<'a>,
        state: &HeadState,
        w: &'a mut HeadWorkspace,
    ) -> Self {
        w.y.copy_from_slice(&state.y);
        w.rate.copy_from_slice(&state.rate);
        w.scratch.reset();
        w.scratch.first_order = FirstOrderCells::new(&model.film, &state.first_order);
        w.scratch.film.closest_m.copy_from_slice(&state.closest_m);
        w.scratch.counters = state.counters;
        w.stepper.forget();
        pulse_events(load.pulse, &mut w.pulse_events_s);
        Self {
            model,
            motion,
            load,
            w,
            time_s: state.time_s,
            clearance: state.clearance,
            smallest: state.smallest,
            touched_s: state.touched_s,
            failed: None,
            dimple: state.dimple,
            dimple_force_n: state.dimple_force_n,
            stops: state.stops,
            contact: state.contact.clone(),
            midway: None,
            energy: state.energy.clone(),
            columns: None,
            fields: None,
            cost: state.cost,
            lowest_pa: f64::INFINITY,
        }
    }

    /// The present state.
    pub(super) fn state(&self) -> HeadState {
        HeadState {
            time_s: self.time_s,
            y: self.w.y.clone(),
            rate: self.w.rate.clone(),
            closest_m: self.w.scratch.film.closest_m.clone(),
            first_order: self.w.scratch.first_order.cells().to_vec(),
            clearance: self.clearance,
            smallest: self.smallest,
            touched_s: self.touched_s,
            dimple: self.dimple,
            dimple_force_n: self.dimple_force_n,
            stops: self.stops,
            contact: self.contact.clone(),
            energy: self.energy.clone(),
            cost: self.cost,
            counters: self.w.scratch.counters,
        }
    }

    /// Discards what steps have accumulated.
    pub(super) fn forget(&mut self) {
        self.w.scratch.forget();
        self.w.stepper.forget();
    }
}
