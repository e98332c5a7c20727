//! Chooses the next step from the error of the last one, out of a geometric series of step sizes.
//!
//! ```text
//! Δt_new = Δt · 0.9 (1/e)^(1/p) T^(0.3/p)      e error over tolerance, p power of its estimate
//! ```
//!
//! rounded down to Δt_max ρ^−k, with Δt_max the largest step. T is the e before over e, within 0.2 and 1. A step grows by
//! ρ at least or not at all: the iteration matrix depends on Δt alone, and reusing it saves more than a few per cent.

/// Ratio ρ of neighbouring step sizes.
const RATIO: f64 = 1.25;

/// Chooses steps of the geometric series between a smallest and a largest step.
#[derive(Clone, Copy, Debug)]
pub struct StepControl {
    smallest_s: f64,
    largest_s: f64,
    error_order: f64,
    previous_error: f64,
}

impl StepControl {
    /// Safety factor on the step that the error allows.
    const SAFETY: f64 = 0.9;
    /// Largest growth after one step.
    const GROWTH: f64 = 4.0;
    /// Largest cut after one rejection by error.
    const CUT: f64 = 0.2;

    /// Control for an estimate that falls with Δt to the power `error_order`.
    pub fn new(error_order: u32, smallest_s: f64, largest_s: f64) -> Self {
        Self {
            smallest_s,
            largest_s,
            error_order: f64::from(error_order),
            previous_error: 1.0,
        }
    }

    /// Smallest step, s.
    pub fn smallest_s(&self) -> f64 {
        self.smallest_s
    }

    /// `dt_s` rounded down to a step size of the series and into the allowed range.
    pub fn of_series(&self, dt_s: f64) -> f64 {
        if dt_s >= self.largest_s {
            return self.largest_s;
        }
        let k = ((dt_s / self.largest_s).ln() / RATIO.ln() + 1e-9).floor();
        (self.largest_s * RATIO.powf(k)).max(self.smallest_s)
    }

    /// Step after an accepted step of `dt_s` with error `error` (1 = tolerance).
    pub fn after_accept(&mut self, dt_s: f64, error: f64) -> f64 {
        let error = error.max(1e-10);
        // The trend of the error damps the growth after a step that was already getting worse
        // (Gustafsson 1994).
        let trend = (self.previous_error / error).clamp(0.2, 1.0);
        self.previous_error = error;
        let p = self.error_order;
        let factor = Self::SAFETY * error.powf(-1.0 / p) * trend.powf(0.3 / p);
        if factor >= RATIO {
            self.of_series(dt_s * factor.min(Self::GROWTH))
        } else if factor < 1.0 / RATIO {
            self.of_series(dt_s * factor)
        } else {
            dt_s
        }
    }

    /// Step after a rejection for its error.
    pub fn after_reject(&mut self, dt_s: f64, error: f64) -> f64 {
        self.previous_error = 1.0;
        let wanted = Self::SAFETY * error.powf(-1.0 / self.error_order);
        let factor = if wanted.is_finite() {
            wanted.clamp(Self::CUT, 1.0 / RATIO)
        } else {
            Self::CUT
        };
        self.of_series(dt_s * factor)
    }

    /// Step after a stage that did not converge.
    pub fn after_failure(&mut self, dt_s: f64) -> f64 {
        self.previous_error = 1.0;
        self.of_series(0.35 * dt_s)
    }
}
