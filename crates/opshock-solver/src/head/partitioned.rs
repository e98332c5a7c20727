//! Partitioned coupling: film and structure are solved in turn within a stage, exchanging attitude for force.
//!
//! H(q): the film is solved at the attitude q; its force moves slider and suspension, whose attitude is H(q). If the
//! exchange converges, it converges to the monolithic solution. The plain iteration does so only while d² k/m of the
//! film is below one. A stage that does not converge shortens the step.

use super::resolution::Coupling;
use super::stage::{Instant, MechanicalIterate, Stages};
use super::stage_scratch::StageFailure;
use crate::fixed_point::{Ending, FixedPoint, Method};
use crate::lanes::sum;

/// Most exchanges of one stage.
const MAX_EXCHANGES: usize = 40;
/// Most Newton iterations of the film at one attitude.
const MAX_FILM_ITERATIONS: usize = 12;
/// Most iterations of the mechanics at one film force for each contact: one per change of its state.
const MAX_CONTACT_ITERATIONS: usize = 8;
/// Differences kept by Anderson's iteration: all that three components can use.
const ANDERSON_DEPTH: usize = 3;

impl Coupling {
    /// The iteration of a partitioned coupling.
    pub(super) fn method(self) -> Option<Method> {
        match self {
            Self::Monolithic => None,
            Self::FixedPoint => Some(Method::Plain),
            Self::Aitken => Some(Method::Aitken),
            Self::Anderson => Some(Method::Anderson {
                depth: ANDERSON_DEPTH,
            }),
        }
    }
}

impl Stages<'_> {
    /// Iterates film against structure until the attitude no longer changes.
    pub(super) fn solve_partitioned(
        &mut self,
        exchange: &mut FixedPoint,
        instant: &Instant,
        known: &[f64],
        y: &mut [f64],
    ) -> Result<(), StageFailure> {
        let (n_cells, n) = (self.model.film.n_cells(), self.model.mechanics.len());
        let (psi_known, rest) = known.split_at(n_cells);
        let (x_known, v_known) = rest.split_at(n);
        let (psi, rest) = y.split_at_mut(n_cells);
        let (x, v) = rest.split_at_mut(n);

        let coupling_tolerance = self.model.resolution.coupling_tolerance;
        let tolerance = self
            .model
            .arms
            .map(|arm| coupling_tolerance * self.gap_m / arm);
        let mut q = [x[0], x[1], x[2]];
        let mut failure = None;
        let ending = exchange.solve(&mut q, &tolerance, MAX_EXCHANGES, |q, image| {
            x[..3].copy_from_slice(q);
            let solved = self
                .film_at(instant, x, psi, psi_known)
                .and_then(|film| self.mechanics_under(instant, film, x, x_known, v_known));
            match solved {
                Ok(()) => {
                    image.copy_from_slice(&x[..3]);
                    true
                }
                Err(error) => {
                    failure = Some(error);
                    false
                }
            }
        });
        match ending {
            Ending::Converged { residual, .. } => {
                for ((v, x), known) in v.iter_mut().zip(&*x).zip(x_known) {
                    *v = (x - known) / instant.d_s;
                }
                let counters = &mut self.scratch.counters;
                counters.max_residual = counters.max_residual.max(residual * coupling_tolerance);
                Ok(())
            }
            Ending::NotConverged { residual, .. } => {
                Err(StageFailure::NotConverged(residual * coupling_tolerance))
            }
            Ending::Broken { .. } => Err(failure.unwrap_or(StageFailure::NotFinite("attitude"))),
        }
    }

    /// Solves the film's stage at the attitude of `x`; F − F₀.
    fn film_at(
        &mut self,
        instant: &Instant,
        x: &[f64],
        psi: &mut [f64],
        psi_known: &[f64],
    ) -> Result<[f64; 3], StageFailure> {
        let attitude = self.model.attitude(x, &instant.pose);
        let tolerance = 0.1 * self.model.resolution.coupling_tolerance;
        self.ensure_factors(psi, &attitude, instant.d_s)?;
        let mut previous = f64::INFINITY;
        let mut size = f64::INFINITY;
        for _ in 0..MAX_FILM_ITERATIONS {
            self.film_residual(instant, &attitude, psi, psi_known);
            let spurious = sum(&self.scratch.residual);
            self.scratch.solve_film();
            let (mut square, mut loss) = (0.0, 0.0_f64);
            for (delta, psi) in self.scratch.residual.iter().zip(&*psi) {
                let relative = delta / psi;
                square += relative * relative;
                loss = loss.max(relative);
            }
            size = (square / psi.len() as f64).sqrt();
            if !size.is_finite() {
                return Err(StageFailure::NotFinite("film pressure"));
            }
            let factor = if loss > 0.9 { 0.9 / loss } else { 1.0 };
            for (psi, delta) in psi.iter_mut().zip(&self.scratch.residual) {
                *psi -= factor * delta;
            }
            if factor == 1.0 && size <= tolerance {
                self.note_imbalance(spurious * instant.d_s * size, psi);
                let s = &mut *self.scratch;
                let film = s.first_order.film(&self.model.film);
                let force = film.force(psi, &attitude, &mut s.film);
                return Ok(std::array::from_fn(|f| {
                    force[f] - self.model.steady_force[f]
                }));
            }
            if factor < 1.0 || size > 0.35 * previous {
                self.renew(psi, &attitude, instant.d_s)?;
            }
            previous = size;
        }
        Err(StageFailure::NotConverged(size))
    }

    /// Moves slider and suspension under a given film force. Linear except for the contacts.
    fn mechanics_under(
        &mut self,
        instant: &Instant,
        film: [f64; 3],
        x: &mut [f64],
        x_known: &[f64],
        v_known: &[f64],
    ) -> Result<(), StageFailure> {
        let mut closed = None;
        let n_contacts = 1 + self.model.mechanics.n_stops();
        for _ in 0..n_contacts * MAX_CONTACT_ITERATIONS {
            for ((v, x), known) in self.scratch.velocity.iter_mut().zip(&*x).zip(x_known) {
                *v = (x - known) / instant.d_s;
            }
            let now = self.closed(instant, x);
            if closed == Some(now) {
                return Ok(());
            }
            closed = Some(now);
            self.mechanical_step(
                &MechanicalIterate {
                    instant,
                    film,
                    x,
                    v_known,
                },
                None,
            )?;
            for (x, delta) in x.iter_mut().zip(&self.scratch.mechanical) {
                *x += delta;
            }
        }
        Err(StageFailure::NotConverged(f64::INFINITY))
    }
}
