//! Time loop of a run: computes, accepts or rejects steps between events, until the run ends.

use super::running::{Lowest, Run, TrialStep};
use crate::air_bearing::Attitude;
use crate::head::energy::EnergyWatch;
use crate::head::fields::FieldRecord;
use crate::head::film_passes::relative_size;
use crate::head::outcome::{Cause, HeadCost, HeadRun, Place, SliderContact, Verdict};
use crate::head::stage::Stages;
use crate::head::stage_scratch::StageFailure;
use crate::integrator::StepControl;
use crate::mutant;

/// Smallest step, s: below it a stage that does not converge leaves the run undecided.
const SMALLEST_STEP_S: f64 = 1e-14;

/// Largest step, s: a share of the shortest period in the disk's motion that matters here.
const LARGEST_STEP_S: f64 = 10e-6;

/// Ambient air of this thickness is the least gas to which errors of a cell's gas are relative, m.
const LEAST_GAS_M: f64 = 3e-12;

/// First step of a run, s.
const FIRST_STEP_S: f64 = 1e-7;

/// Why the loop ended.
pub(super) enum End {
    Window,
    Failure,
    Undecided(Cause),
}

impl Run<'_> {
    pub(super) fn advance(&mut self, window_s: f64, stops_at_failure: bool) -> End {
        let resolution = &self.model.resolution;
        let table = self.model.tableau;
        let mut control = StepControl::new(table.error_order, SMALLEST_STEP_S, LARGEST_STEP_S);
        let mut dt = control.of_series(FIRST_STEP_S);
        let (mut next_motion, mut next_pulse) = (0, 0);
        let ends_untouched = stops_at_failure && mutant::is_on("R6 touch");
        while self.time_s < window_s {
            let event = self.next_event(window_s, &mut next_motion, &mut next_pulse);
            let left = event - self.time_s;
            // A step that would leave a tiny rest before the event is halved, or extended to the event.
            let trial = if dt >= 0.999 * left {
                left
            } else if dt > 0.5 * left {
                0.5 * left
            } else {
                dt
            };
            if self.cost.steps + self.cost.rejected >= resolution.max_steps {
                return End::Undecided(Cause::StepLimit {
                    time_s: self.time_s,
                    max_steps: resolution.max_steps,
                });
            }
            match self.try_step(trial) {
                Err(failure) => {
                    self.cost.rejected += 1;
                    self.w.scratch.discard_factors();
                    if trial <= 2.0 * SMALLEST_STEP_S {
                        return End::Undecided(self.cause(failure));
                    }
                    dt = control.after_failure(trial);
                }
                Ok(trial_step) if trial_step.error > 1.0 => {
                    self.cost.rejected += 1;
                    if trial <= 2.0 * SMALLEST_STEP_S {
                        return End::Undecided(Cause::NotConverged {
                            time_s: self.time_s,
                            residual: trial_step.error * resolution.tolerance,
                        });
                    }
                    dt = control.after_reject(trial, trial_step.error);
                }
                Ok(trial_step) if trial_step.approach > 1.25 && trial > 4.0 * SMALLEST_STEP_S => {
                    self.cost.rejected += 1;
                    dt = control.of_series(trial * (0.9 / trial_step.approach).max(0.1));
                }
                Ok(trial_step) => {
                    // The time at an event is the event's own, so that rounding never leaves a tiny step beside it.
                    let end_s = if trial == left {
                        event
                    } else {
                        self.time_s + trial
                    };
                    if let Some(touch) = self.search_step(trial, &trial_step) {
                        if stops_at_failure {
                            self.cost.steps += u64::from(touch.time_s > self.time_s);
                            self.touch(trial, touch.time_s, &touch);
                            return End::Failure;
                        }
                        self.touch(trial, end_s, &touch);
                    }
                    self.accept(trial, end_s, &trial_step);
                    if self.is_damaged_now() && stops_at_failure {
                        return End::Failure;
                    }
                    if ends_untouched {
                        return End::Window;
                    }
                    let wanted = control.after_accept(trial, trial_step.error);
                    // A step shortened by an event is no evidence against the step length before it.
                    let wanted = if trial < dt { wanted.max(dt) } else { wanted };
                    let bound = trial / trial_step.approach.max(1e-3);
                    dt = if wanted > bound {
                        control.of_series(bound)
                    } else {
                        wanted
                    };
                }
            }
        }
        End::Window
    }

    /// End of the next step at the latest: the next jump or kink after now.
    fn next_event(&self, window_s: f64, motion: &mut usize, pulse: &mut usize) -> f64 {
        let after = self.time_s * (1.0 + 1e-12) + SMALLEST_STEP_S;
        let mut event = window_s;
        for (events, next) in [
            (self.motion.events_s(), motion),
            (self.w.pulse_events_s.as_slice(), pulse),
        ] {
            while events.get(*next).is_some_and(|&t| t <= after) {
                *next += 1;
            }
            if let Some(&t) = events.get(*next) {
                event = event.min(t);
            }
        }
        event
    }

    fn try_step(&mut self, dt_s: f64) -> Result<TrialStep, StageFailure> {
        let (model, w) = (self.model, &mut *self.w);
        let gap_m = model.gap_scale(self.clearance.value_m);
        let mut stages = Stages {
            model,
            motion: self.motion,
            load: self.load,
            scratch: &mut w.scratch,
            exchange: w.exchange.as_mut(),
            gap_m,
        };
        w.stepper
            .step(&mut stages, self.time_s, dt_s, &w.y, &w.rate)?;
        let n_cells = model.film.n_cells();
        let y = w.stepper.value();
        let pose = self.motion.pose(self.time_s + dt_s);
        let attitude = model.attitude(&y[n_cells..], &pose);
        let clearance = model.film.min_clearance(&attitude);
        if !clearance.value_m.is_finite() {
            return Err(StageFailure::NotFinite("clearance"));
        }
        let error = self.error_norm(gap_m);
        if !error.is_finite() {
            return Err(StageFailure::NotFinite("error estimate"));
        }
        let closed_by = self.clearance.value_m - clearance.value_m;
        let from = model.gap_scale(self.clearance.value_m.abs());
        Ok(TrialStep {
            error,
            approach: (closed_by / from).max(0.0) / model.resolution.approach_share,
            attitude,
            clearance,
        })
    }

    /// Error of the trial step over tolerance: gap error at the slider's ends, directly and through its velocity, error
    /// of the film's gas, and error due to the suspension's modes.
    fn error_norm(&mut self, gap_m: f64) -> f64 {
        let model = self.model;
        let (n_cells, n) = (model.film.n_cells(), model.mechanics.len());
        let (e_psi, rest) = self.w.stepper.error().split_at(n_cells);
        let (e_x, e_v) = rest.split_at(n);
        let psi = &self.w.stepper.value()[..n_cells];
        let film = relative_size(e_psi, psi, LEAST_GAS_M * model.film.ambient_pa());
        let gap = model.gap_change(e_x) + model.velocity_to_gap_s * model.gap_change(e_v);
        let forces = &mut self.w.scratch.mechanical;
        let force = model.mechanics.suspension_force_error(e_x, forces);
        let suspension = force / model.film_n_per_m;
        ((gap + suspension) / gap_m + film) / model.resolution.tolerance
    }

    /// Accepts the whole trial step, which ends at `end_s`.
    fn accept(&mut self, dt_s: f64, end_s: f64, step: &TrialStep) {
        self.keep_fields(dt_s, end_s);
        let before_s = self.time_s;
        self.time_s = end_s;
        let w = &mut *self.w;
        w.y.copy_from_slice(w.stepper.value());
        w.rate.copy_from_slice(w.stepper.rate());
        w.stepper.accept(dt_s);
        self.clearance = step.clearance;
        self.remember_heights(&step.attitude);
        let (model, w) = (self.model, &mut *self.w);
        let da = self.load.jump(self.time_s);
        if da != 0.0 {
            let velocities = model.film.n_cells() + model.mechanics.len();
            model
                .mechanics
                .add_acceleration_jump(da, &mut w.rate[velocities..]);
        }
        self.jump_of_pivot();
        self.cost.steps += 1;
        // A touch at the very end of the step has its row already.
        if self.time_s > before_s {
            self.record_step(dt_s, &step.attitude);
        }
        self.flatten_empty_cells(&step.attitude);
    }

    /// Takes cells of the film that are empty now to first order.
    fn flatten_empty_cells(&mut self, attitude: &Attitude) {
        let (film, w) = (&self.model.film, &mut *self.w);
        let psi = &w.y[..film.n_cells()];
        let first_order = &mut w.scratch.first_order;
        if film.is_empty_at(self.lowest_pa) && first_order.add_empty(film, psi, attitude) {
            self.forget();
            self.film_rate(attitude);
        }
    }

    /// Applies a jump of the pivot's velocity now: dampers feel it at once.
    fn jump_of_pivot(&mut self) {
        let [moved, after] = self.motion.pivot(self.time_s);
        let [_, before] = self.motion.pivot(self.time_s * (1.0 - 1e-12));
        if after == before {
            return;
        }
        let (mechanics, w) = (&self.model.mechanics, &mut *self.w);
        let (n_cells, n) = (self.model.film.n_cells(), mechanics.len());
        let (x, v) = w.y[n_cells..].split_at(n);
        let [seen, seen_rate] = &mut w.seen;
        mechanics.over_pivot(moved, x, seen);
        for (rate, sign) in [(before, -1.0), (after, 1.0)] {
            mechanics.over_pivot(rate, v, seen_rate);
            let out = &mut w.scratch.mechanical;
            mechanics.acceleration(0.0, [0.0; 3], seen, seen_rate, out);
            for (rate, out) in w.rate[n_cells + n..].iter_mut().zip(&*out) {
                *rate += sign * out;
            }
        }
    }

    fn cause(&self, failure: StageFailure) -> Cause {
        match failure {
            StageFailure::NotConverged(residual) => Cause::NotConverged {
                time_s: self.time_s,
                residual,
            },
            StageFailure::NotFinite(quantity) => Cause::NotFinite {
                time_s: self.time_s,
                quantity,
            },
        }
    }

    pub(super) fn finish(self, end: End) -> HeadRun {
        let (verdict, broke_off) = match (self.failed, end) {
            (Some((t_fail_s, place)), end) => {
                let cause = match end {
                    End::Undecided(cause) => Some(cause),
                    End::Window | End::Failure => None,
                };
                (Verdict::Fails { t_fail_s, place }, cause)
            }
            (None, End::Undecided(cause)) => (Verdict::Undecided { cause }, None),
            (None, End::Window | End::Failure) => (Verdict::Survives, None),
        };
        let counters = self.w.scratch.counters;
        let (film, closest_m) = (&self.model.film, &self.w.scratch.film.closest_m);
        let slider_contact = self.contact.map(|watch| SliderContact {
            touched_s: self.touched_s,
            yielded_j: film.yielded_j(closest_m),
            energy: self.energy.map(EnergyWatch::finish),
            ..watch.finish()
        });
        let Lowest {
            clearance,
            time_s,
            attitude,
        } = self.smallest;
        HeadRun {
            verdict,
            min_clearance_m: clearance.value_m,
            t_min_clearance_s: time_s,
            place: Place {
                x_m: clearance.x_m,
                y_m: clearance.y_m,
            },
            lowest: attitude,
            end_s: self.time_s,
            broke_off,
            dimple: self.dimple,
            limiters: self.stops[0].map(|(record, _)| record),
            lift_tab: self.stops[1].map(|(record, _)| record),
            slider_contact,
            columns: self.columns,
            fields: self.fields.map(FieldRecord::finish),
            cost: HeadCost {
                film_residuals: counters.residuals,
                film_solves: counters.solves,
                factorisations: counters.factorisations,
                linearisations: counters.linearisations,
                max_residual: counters.max_residual,
                mass_balance_error: counters.mass_balance_error,
                ..self.cost
            },
        }
    }
}
