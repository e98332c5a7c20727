//! A run in progress: its present state and its records so far.

use super::workspace::{HeadWorkspace, pulse_events};
use crate::air_bearing::Attitude;
use crate::disk::DiskMotion;
use crate::head::energy::EnergyWatch;
use crate::head::fields::FieldRecord;
use crate::head::model::{Following, HeadModel, ShockLoad};
use crate::head::outcome::{DimpleRecord, HeadColumns, HeadCost, Place, StopRecord};
use crate::head::slider_contact::ContactWatch;
use crate::rough_contact::nominal::ContactState;
use crate::slider::clearance::Clearance;

pub(super) struct Run<'a> {
    pub(super) model: &'a HeadModel,
    pub(super) motion: &'a dyn DiskMotion,
    pub(super) load: ShockLoad<'a>,
    pub(super) w: &'a mut HeadWorkspace,
    pub(super) time_s: f64,
    pub(super) clearance: Clearance,
    pub(super) smallest: Lowest,
    /// Time of the first touch, once it has occurred, s.
    pub(super) touched_s: Option<f64>,
    /// The failure, once it has occurred: first touch, or damage. Smallest clearance, dimple and stops are recorded up to it.
    pub(super) failed: Option<(f64, Place)>,
    pub(super) dimple: DimpleRecord,
    pub(super) dimple_force_n: f64,
    /// Limiters and lift tab: record, and the latest force.
    pub(super) stops: [Option<(StopRecord, f64)>; 2],
    /// Contact with the disk, where the scene has asperities.
    pub(super) contact: Option<ContactWatch>,
    /// What its asperities bore in the middle of the latest step, where works are asked for.
    pub(super) midway: Option<ContactState>,
    /// Energy of slider and suspension beside it, of a run that goes on after its failure.
    pub(super) energy: Option<EnergyWatch>,
    pub(super) columns: Option<HeadColumns>,
    pub(super) fields: Option<FieldRecord<'a>>,
    pub(super) cost: HeadCost,
    /// Lowest pressure of the film at the latest recorded state, Pa.
    pub(super) lowest_pa: f64,
}

/// The slider's closest approach to the disk so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lowest {
    pub(super) clearance: Clearance,
    pub(super) time_s: f64,
    pub(super) attitude: Attitude,
}

/// A step that was computed and may be accepted.
pub(super) struct TrialStep {
    /// Error over tolerance.
    pub(super) error: f64,
    /// Relative approach over its share.
    pub(super) approach: f64,
    pub(super) attitude: Attitude,
    pub(super) clearance: Clearance,
}

impl<'a> Run<'a> {
    /// Puts the steady state into the workspace.
    pub(super) fn start(
        model: &'a HeadModel,
        motion: &'a dyn DiskMotion,
        load: ShockLoad<'a>,
        stops_at_failure: bool,
        record: bool,
        w: &'a mut HeadWorkspace,
    ) -> Self {
        let n_cells = model.film.n_cells();
        match &model.following {
            Some(Following { start, .. }) => w.y.copy_from_slice(start),
            None => {
                w.y.fill(0.0);
                w.y[..n_cells].copy_from_slice(&model.flight.psi);
            }
        }
        w.rate.fill(0.0);
        w.scratch.reset();
        w.scratch.film.closest_m.fill(f64::INFINITY);
        w.stepper.forget();
        pulse_events(load.pulse, &mut w.pulse_events_s);
        let attitude = model.attitude(&w.y[n_cells..], &motion.pose(0.0));
        let clearance = model.film.min_clearance(&attitude);
        let (x, v) = w.y[n_cells..].split_at(model.mechanics.len());
        let preload = model.mechanics.dimple_force(x, v);
        let mut run = Self {
            model,
            motion,
            load,
            w,
            time_s: 0.0,
            clearance,
            smallest: Lowest {
                clearance,
                time_s: 0.0,
                attitude,
            },
            touched_s: None,
            failed: None,
            dimple: DimpleRecord {
                min_force_n: preload,
                open_s: 0.0,
            },
            dimple_force_n: preload,
            stops: model.mechanics.has_stops().map(|is_there| {
                let record = StopRecord::default();
                is_there.then_some((record, 0.0))
            }),
            contact: None,
            midway: None,
            energy: None,
            columns: record.then(HeadColumns::default),
            fields: (record && !model.field_times_s.is_empty())
                .then(|| FieldRecord::new(model, &model.field_times_s)),
            cost: HeadCost::default(),
            lowest_pa: f64::INFINITY,
        };
        if let Some(fields) = &mut run.fields {
            fields.keep_steady(model, motion, &run.w.y);
        }
        let closest_m = &mut run.w.scratch.film.closest_m;
        model.film.remember(&attitude, closest_m);
        if let Some(first) = run.instant(&attitude) {
            run.contact = Some(ContactWatch::new(preload, first));
            if !stops_at_failure {
                run.see_over_pivot();
                let first = run.energies(&attitude, &first);
                run.energy = Some(EnergyWatch::new(first, &run.w.seen));
            }
        }
        run.film_rate(&attitude);
        run.initial_rate(&attitude);
        run.record(&attitude);
        run
    }

    /// Rate of the film from its equation itself: at time 0, and where that changes. Others come from the stages.
    pub(super) fn film_rate(&mut self, attitude: &Attitude) {
        let w = &mut *self.w;
        let s = &mut w.scratch;
        let film = s.first_order.film(&self.model.film);
        let n_cells = film.n_cells();
        film.flux_residual(&w.y[..n_cells], attitude, &mut s.residual, &mut s.film);
        let rate = &mut w.rate[..n_cells];
        for (rate, r) in rate.iter_mut().zip(&s.residual) {
            *rate = -r;
        }
        film.spread_by_storage(rate);
    }

    /// Rates of slider and suspension at time 0 from their equations.
    fn initial_rate(&mut self, attitude: &Attitude) {
        let (model, w) = (self.model, &mut *self.w);
        let (n_cells, n) = (model.film.n_cells(), model.mechanics.len());
        let psi = &w.y[..n_cells];
        let film = model.film.force(psi, attitude, &mut w.scratch.film);
        let film = std::array::from_fn(|f| film[f] - model.steady_force[f]);
        let (x, v) = w.y[n_cells..].split_at(n);
        w.rate[n_cells..n_cells + n].copy_from_slice(v);
        let a = self.load.just_after(0.0);
        let out = &mut w.rate[n_cells + n..];
        model.mechanics.acceleration(a, film, x, v, out);
    }
}
