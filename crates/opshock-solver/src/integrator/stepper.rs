//! Takes one trial step of an ESDIRK scheme on any system that can solve its implicit stage equation.

use super::extrapolation::{self, KNOWN};
use super::tableau::Tableau;
use crate::lanes::{add_scaled, combine, rate_between};

/// A stiff system y' = f(t, y) that solves its own implicit stages.
pub trait StageSystem {
    /// Why a stage could not be solved.
    type Failure;

    /// Solves y = `known` + d f(`time_s`, y); `y` holds a guess on entry.
    ///
    /// # Errors
    /// When the iteration does not converge; `y` is then worthless.
    fn solve_stage(
        &mut self,
        time_s: f64,
        d_s: f64,
        known: &[f64],
        y: &mut [f64],
    ) -> Result<(), Self::Failure>;

    /// Replaces `error` by (I − d J)⁻¹ `error` with the Jacobian of the last stage solve.
    fn filter(&mut self, d_s: f64, error: &mut [f64]);
}

/// Stage storage of one scheme for systems of one size.
#[derive(Clone, Debug)]
pub struct Stepper {
    tableau: Tableau,
    rates: Vec<Vec<f64>>,
    known: Vec<f64>,
    stage: Vec<f64>,
    error: Vec<f64>,
    /// Rates at the start and at the first implicit stage of the last accepted step.
    last_rates: [Vec<f64>; 2],
    /// Length of the last accepted step; `None` when the step before says nothing about the next.
    last_dt_s: Option<f64>,
}

impl Stepper {
    /// Storage for `n` unknowns.
    pub fn new(tableau: Tableau, n: usize) -> Self {
        Self {
            tableau,
            rates: vec![vec![0.0; n]; tableau.n_stages()],
            known: vec![0.0; n],
            stage: vec![0.0; n],
            error: vec![0.0; n],
            last_rates: [vec![0.0; n], vec![0.0; n]],
            last_dt_s: None,
        }
    }

    /// Takes the trial step of `dt_s` just made as accepted: its rates help guess the next. [`Stepper::rate`] is
    /// invalid afterwards.
    pub fn accept(&mut self, dt_s: f64) {
        for (last, rate) in self.last_rates.iter_mut().zip(&mut self.rates) {
            std::mem::swap(last, rate);
        }
        self.last_dt_s = Some(dt_s);
    }

    /// Forgets the steps before, as at a restart.
    pub fn forget(&mut self) {
        self.last_dt_s = None;
    }

    /// The scheme.
    pub fn tableau(&self) -> &Tableau {
        &self.tableau
    }

    /// Value at the end of the last trial step.
    pub fn value(&self) -> &[f64] {
        &self.stage
    }

    /// Rate at the end of the last trial step.
    pub fn rate(&self) -> &[f64] {
        &self.rates[self.tableau.n_stages() - 1]
    }

    /// Filtered error estimate of the last trial step.
    pub fn error(&self) -> &[f64] {
        &self.error
    }

    /// Tries a step of `dt_s` from `y` with rate `rate` at `time_s`.
    ///
    /// # Errors
    /// The first failure of a stage solve; nothing of the caller's state has changed.
    pub fn step<S: StageSystem>(
        &mut self,
        system: &mut S,
        time_s: f64,
        dt_s: f64,
        y: &[f64],
        rate: &[f64],
    ) -> Result<(), S::Failure> {
        let table = self.tableau;
        let d = table.gamma * dt_s;
        self.rates[0].copy_from_slice(rate);
        for i in 1..table.n_stages() {
            self.known.copy_from_slice(y);
            for (a, rates) in table.a[i].iter().zip(&self.rates) {
                add_scaled(&mut self.known, dt_s * a, rates);
            }
            self.guess(i, dt_s, y);
            system.solve_stage(time_s + table.c[i] * dt_s, d, &self.known, &mut self.stage)?;
            rate_between(&self.known, &self.stage, 1.0 / d, &mut self.rates[i]);
        }
        self.error.fill(0.0);
        for (w, rates) in table.error_weights.iter().zip(&self.rates) {
            add_scaled(&mut self.error, dt_s * w, rates);
        }
        system.filter(d, &mut self.error);
        Ok(())
    }

    /// Guess of stage `i`: y' taken as the parabola through the three latest rates (the line through
    /// two, where there are no more), integrated over the step so far.
    fn guess(&mut self, i: usize, dt_s: f64, y: &[f64]) {
        let c = self.tableau.c;
        let [start, middle] = &self.last_rates;
        let before = self
            .last_dt_s
            .map(|last| [(-last, start), ((c[1] - 1.0) * last, middle)]);
        let present = c.iter().map(|c| c * dt_s).zip(&self.rates).take(i);
        let latest = present.rev().chain(before.into_iter().flatten().rev());

        let (mut times_s, mut rates, mut n) = ([0.0; KNOWN], [&self.rates[0]; KNOWN], 0);
        for (time_s, rate) in latest.take(KNOWN) {
            (times_s[n], rates[n]) = (time_s, rate);
            n += 1;
        }
        let w = extrapolation::integral_weights(times_s, n, c[i] * dt_s);
        combine(y, w, rates.map(Vec::as_slice), &mut self.stage);
    }
}
