//! Updates the records of a run after each step: contacts, histories, pressure fields.

use super::running::Run;
use crate::air_bearing::Attitude;
use crate::head::energy::{EnergyState, EnergyWatch};
use crate::head::fields::StepEnds;
use crate::head::outcome::Place;
use crate::head::slider_contact::{ContactWatch, Instant};
use crate::slider::clearance::Clearance;

impl Run<'_> {
    /// Records the state reached `dt_s` after the last: dimple and stops up to the touch, pressure, columns.
    pub(super) fn record_step(&mut self, dt_s: f64, attitude: &Attitude) {
        self.see_over_pivot();
        let (model, w) = (self.model, &*self.w);
        let n_cells = model.film.n_cells();
        let [x, v] = &w.seen;
        let before = self.dimple_force_n;
        self.dimple_force_n = model.mechanics.dimple_force(x, v);
        if self.failed.is_none() {
            self.dimple.min_force_n = self.dimple.min_force_n.min(self.dimple_force_n);
            let open_ends = [before, self.dimple_force_n]
                .iter()
                .filter(|&&f| f == 0.0)
                .count();
            self.dimple.open_s += 0.5 * open_ends as f64 * dt_s;
        }
        if model.mechanics.n_stops() > 0 {
            let forces = model.mechanics.stop_forces(x, v);
            for (stop, force) in self.stops.iter_mut().zip(forces) {
                if let Some((record, latest)) = stop {
                    if self.failed.is_none() {
                        record.add_step([*latest, force], dt_s, self.time_s);
                    }
                    *latest = force;
                }
            }
        }
        if let Some(now) = self.instant(attitude) {
            let (film, closest_m) = (&self.model.film, &self.w.scratch.film.closest_m);
            let elastic_j = || film.asperities_elastic_j(attitude, closest_m);
            let contact = self.contact.as_mut().expect("made at the start");
            contact.add(now, elastic_j);
            if self.energy.is_some() {
                let now = self.energies(attitude, &now);
                let energy = self.energy.as_mut().expect("seen");
                energy.add(now, &self.w.seen);
            }
        }
        let psi = &self.w.y[..n_cells];
        let lowest = model.film.lowest_pressure_pa(psi, attitude);
        self.cost.min_pressure_pa = self.cost.min_pressure_pa.min(lowest);
        self.lowest_pa = lowest;
        self.record(attitude);
    }

    /// Takes the heights at `to` into the smallest ones so far of the asperities, after what they bore midway.
    pub(super) fn remember_heights(&mut self, to: &Attitude) {
        let film = &self.model.film;
        let closest_m = &mut self.w.scratch.film.closest_m;
        if let (Some(contact), Some(_)) = (&self.contact, &self.energy) {
            let from = contact.attitude();
            let mean = Attitude {
                centre_height_m: 0.5 * (from.centre_height_m + to.centre_height_m),
                pitch_rad: 0.5 * (from.pitch_rad + to.pitch_rad),
                roll_rad: 0.5 * (from.roll_rad + to.roll_rad),
            };
            self.midway = film.contact(&mean, closest_m);
        }
        film.remember(to, closest_m);
    }

    /// Puts coordinates and velocities over the pivot into the workspace.
    pub(super) fn see_over_pivot(&mut self) {
        let (model, w) = (self.model, &mut *self.w);
        let (x, v) = w.y[model.film.n_cells()..].split_at(model.mechanics.len());
        let [moved, rate] = self.motion.pivot(self.time_s);
        let [seen, seen_rate] = &mut w.seen;
        model.mechanics.over_pivot(moved, x, seen);
        model.mechanics.over_pivot(rate, v, seen_rate);
    }

    /// Whether the present state is the first with damage, where that is the failure.
    pub(super) fn is_damaged_now(&mut self) -> bool {
        let (Some(limits), None) = (&self.model.damage, self.failed) else {
            return false;
        };
        let contact = self.contact.as_ref();
        let is_damaged = contact.is_some_and(|contact| contact.exceeds(limits));
        if is_damaged {
            let Clearance { x_m, y_m, .. } = self.clearance;
            self.failed = Some((self.time_s, Place { x_m, y_m }));
        }
        is_damaged
    }

    /// What the asperities bear in the present state, where the scene has their contact.
    pub(super) fn instant(&self, attitude: &Attitude) -> Option<Instant> {
        let closest_m = &self.w.scratch.film.closest_m;
        let state = self.model.film.contact(attitude, closest_m)?;
        Some(Instant {
            time_s: self.time_s,
            clearance_m: self.clearance.value_m,
            place: Place {
                x_m: self.clearance.x_m,
                y_m: self.clearance.y_m,
            },
            state,
            midway: self.midway,
            attitude: *attitude,
        })
    }

    /// Energies of slider and suspension and what works on them in the present state, with `seen` over the pivot.
    pub(super) fn energies(&mut self, attitude: &Attitude, now: &Instant) -> EnergyState {
        let (model, w) = (self.model, &mut *self.w);
        let (n_cells, n) = (model.film.n_cells(), model.mechanics.len());
        let (psi, rest) = w.y.split_at(n_cells);
        let (x, v) = rest.split_at(n);
        let s = &mut w.scratch;
        let film = s.first_order.film(&model.film);
        let force = film.force(psi, attitude, &mut s.film);
        let [pressed, rubbed] = [now.state.normal_load(), now.state.friction_load()];
        let [seen, seen_rate] = &w.seen;
        let mechanics = &model.mechanics;
        let damping_w = mechanics.damping_w(seen, seen_rate);
        let mut damping_midway_w = damping_w;
        if let Some((before_s, [x0, v0])) = self.energy.as_ref().map(EnergyWatch::latest) {
            let dt_s = self.time_s - before_s;
            let [x, v, _] = &mut w.scratch.seen;
            for k in 0..n {
                x[k] = 0.5 * (x0[k] + seen[k]) + 0.125 * dt_s * (v0[k] - seen_rate[k]);
                v[k] = 1.5 * (seen[k] - x0[k]) / dt_s - 0.25 * (v0[k] + seen_rate[k]);
            }
            damping_midway_w = mechanics.damping_w(x, v);
        }
        let [moved_m, _] = self.motion.pivot(self.time_s);
        let out = &mut w.scratch.mechanical;
        mechanics.acceleration(0.0, [0.0; 3], seen, seen_rate, out);
        EnergyState {
            kinetic_j: mechanics.kinetic_j(v),
            elastic_j: mechanics.elastic_j(seen),
            time_s: self.time_s,
            slider: std::array::from_fn(|q| x[q]),
            shock_kg_m: mechanics.along_load(x),
            load_m_per_s2: [
                self.load.value(self.time_s),
                self.load.just_after(self.time_s),
            ],
            pivot: [moved_m, mechanics.along_load(out)],
            film: std::array::from_fn(|f| {
                force[f] - model.steady_force[f] - pressed[f] - rubbed[f]
            }),
            contact: now.state,
            midway: now.midway.unwrap_or_default(),
            damping_w,
            damping_midway_w,
        }
    }

    pub(super) fn record(&mut self, attitude: &Attitude) {
        let Some(columns) = &mut self.columns else {
            return;
        };
        let n_cells = self.model.film.n_cells();
        let x = &self.w.y[n_cells..];
        let steady = &self.model.flight.attitude;
        columns.time_s.push(self.time_s);
        // Relative to the rigidly moving base, as the disk's motion is given.
        let carried_m = self.load.carried_m(self.time_s);
        columns.slider_z_m.push(x[0] + carried_m);
        columns.slider_pitch_rad.push(steady.pitch_rad + x[1]);
        columns.slider_roll_rad.push(steady.roll_rad + x[2]);
        columns.min_clearance_m.push(self.clearance.value_m);
        let s = &mut self.w.scratch;
        let film = s.first_order.film(&self.model.film);
        let force = film.air_force(&self.w.y[..n_cells], attitude, &mut s.film);
        columns.bearing_force_n.push(force[0]);
        columns.bearing_pitch_n_m.push(force[1]);
        columns.bearing_roll_n_m.push(force[2]);
        columns.dimple_force_n.push(self.dimple_force_n);
        let [limiters, lift_tab] = &self.stops;
        columns.limiter_force_n.extend(limiters.map(|(_, f)| f));
        columns.lift_tab_force_n.extend(lift_tab.map(|(_, f)| f));
        let contact = self.contact.as_ref();
        columns
            .asperity_force_n
            .extend(contact.map(ContactWatch::force_n));
    }

    /// Keeps the requested pressure fields of the trial step, from the present state up to `until_s`.
    pub(super) fn keep_fields(&mut self, dt_s: f64, until_s: f64) {
        let Some(fields) = &mut self.fields else {
            return;
        };
        let w = &*self.w;
        let step = StepEnds {
            start_s: self.time_s,
            dt_s,
            y: [&w.y, w.stepper.value()],
            rate: [&w.rate, w.stepper.rate()],
        };
        fields.keep_step(self.model, self.motion, &step, until_s);
    }
}
