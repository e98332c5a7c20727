//! Finds touch, overlap and smallest clearance between steps.

use super::running::{Lowest, Run, TrialStep};
use crate::air_bearing::Attitude;
use crate::head::outcome::Place;
use crate::integrator::hermite;
use crate::slider::clearance::Clearance;

/// Equal parts of a step, at whose ends the clearance is evaluated.
const LOOKS: usize = 5;

/// The first passage of the clearance that is called failure, inside a step.
pub(super) struct Touch {
    /// Share of the step.
    pub(super) theta: f64,
    pub(super) time_s: f64,
    pub(super) clearance: Clearance,
}

impl Run<'_> {
    /// Looks for the smallest clearance and for passages of limits inside the step from the present state to the stepper's; the
    /// one that is the run's failure when it lies there.
    pub(super) fn search_step(&mut self, dt_s: f64, step: &TrialStep) -> Option<Touch> {
        let is_over = self.failed.is_some();
        if is_over && self.touched_s.is_some() {
            return None;
        }
        let (model, w) = (self.model, &*self.w);
        let n_cells = model.film.n_cells();
        let n = model.mechanics.len();
        let (x0, v0) = w.y[n_cells..].split_at(n);
        let (x1, v1) = w.stepper.value()[n_cells..].split_at(n);
        let (start_s, motion) = (self.time_s, self.motion);
        let at = |theta: f64| -> Attitude {
            let x: [f64; 3] = std::array::from_fn(|i| {
                hermite::value(theta, dt_s, [x0[i], x1[i]], [v0[i], v1[i]])
            });
            let pose = motion.pose(start_s + theta * dt_s);
            model.attitude(&x, &pose)
        };
        let look = |theta: f64| model.film.min_clearance(&at(theta));
        let ends = self.clearance.value_m.min(step.clearance.value_m);
        let inside = (1..LOOKS)
            .map(|i| look(i as f64 / LOOKS as f64).value_m)
            .fold(f64::INFINITY, f64::min);
        let (theta, lowest) = if inside < ends {
            let (theta, _) = hermite::minimum(LOOKS, |theta| look(theta).value_m);
            (theta, look(theta))
        } else if step.clearance.value_m <= self.clearance.value_m {
            (1.0, step.clearance)
        } else {
            (0.0, self.clearance)
        };
        if !is_over && lowest.value_m < self.smallest.clearance.value_m {
            self.smallest = Lowest {
                clearance: lowest,
                time_s: start_s + theta * dt_s,
                attitude: at(theta),
            };
        }
        let passage = |limit_m: f64| {
            let below = |theta: f64| look(theta).value_m - limit_m;
            let is_passed = lowest.value_m < limit_m;
            is_passed.then(|| hermite::first_below_zero(LOOKS, Some(theta), below).unwrap_or(theta))
        };
        let is_first = self.touched_s.is_none();
        let touch = is_first.then(|| passage(model.fail_below_m)).flatten();
        if let Some(theta) = touch {
            self.touched_s = Some(start_s + theta * dt_s);
        }
        let (theta, limit) = match &model.damage {
            _ if is_over => return None,
            None => (touch?, model.fail_below_m),
            Some(damage) => {
                let limit = -damage.overlap_m?;
                (passage(limit)?, limit)
            }
        };
        let mut clearance = look(theta);
        if theta > 0.0 {
            // Located to 1e-9 of the step: the remaining distance to the limit is the search's own error.
            clearance.value_m = limit;
        }
        Some(Touch {
            theta,
            time_s: start_s + theta * dt_s,
            clearance,
        })
    }

    /// Takes the run to this failure, inside the trial step. The state there is that of the cubic through both ends,
    /// in which it was located. Fields are kept up to `until_s`, while the start of the step is still available
    /// for interpolation.
    pub(super) fn touch(&mut self, dt_s: f64, until_s: f64, touch: &Touch) {
        self.keep_fields(dt_s, until_s);
        let w = &mut *self.w;
        let ends = w.stepper.value().iter().zip(w.stepper.rate());
        for ((y, rate), (y1, rate1)) in w.y.iter_mut().zip(&w.rate).zip(ends) {
            *y = hermite::value(touch.theta, dt_s, [*y, *y1], [*rate, *rate1]);
        }
        let before_s = self.time_s;
        self.time_s = touch.time_s;
        self.clearance = touch.clearance;
        let n_cells = self.model.film.n_cells();
        let pose = self.motion.pose(self.time_s);
        let attitude = self.model.attitude(&self.w.y[n_cells..], &pose);
        self.remember_heights(&attitude);
        self.smallest = Lowest {
            clearance: touch.clearance,
            time_s: touch.time_s,
            attitude,
        };
        // A slider that begins below the limit fails at once: that instant is already recorded.
        if self.time_s > before_s {
            self.record_step(self.time_s - before_s, &attitude);
        }
        let place = Place {
            x_m: touch.clearance.x_m,
            y_m: touch.clearance.y_m,
        };
        self.failed = Some((touch.time_s, place));
    }
}
