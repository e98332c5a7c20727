//! Stage equations of the coupled head (one implicit stage of a time step) and their monolithic Newton solution.
//!
//! With v = (x − x_known)/d a stage is, for film ψ and coordinates x,
//!
//! ```text
//! r_f = M (ψ − ψ_known)/d + R(ψ, q)                          A = M/d + R_ψ,  Z = A⁻¹ R_q
//! r_m = M_x (v − v_known)/d + C v + K x + B (N − N₀) − f a − (F − F₀)
//! (S − F_q + F_ψ Z) δx = −r_m − F_ψ A⁻¹ r_f,     δψ = −A⁻¹ r_f − Z δq
//! ```
//!
//! with S the derivative of r_m by x without the film (`stage_matrix`). A, Z, F_ψ and F_q are kept as long as the
//! iteration contracts. S follows the contacts at every iterate, so opening and closing need no factorisation. An
//! iterate that would remove more than 90 % of a cell's gas is shortened, and a shortened iterate is never accepted.
//!
//! Renewing the Jacobian at every iterate below half a nanometre has no benefit: the iteration counts are the same, and
//! a run that touches takes three times as long.

use super::film_passes::{add_storage, correct_film};
use super::mechanics::StageState;
use super::model::{HeadModel, ShockLoad};
use super::stage_scratch::{FIRST_CONTRACTION, MatrixKey, StageFailure, StageScratch, columns_of};
use super::stops::Closed;
use crate::air_bearing::Attitude;
use crate::disk::{DiskMotion, DiskPose};
use crate::fixed_point::FixedPoint;
use crate::integrator::StageSystem;
use crate::lanes::{add_scaled, combine, product, products, sum};

/// Most iterations of one stage.
const MAX_ITERATIONS: usize = 14;
/// Contraction above which the Jacobian is renewed; a renewal costs as much as eleven iterations.
const SLOW: f64 = 0.1;
/// Power of the contraction used for the next stage when the first iterate gave no estimate: an old estimate is
/// weighted less with every stage, until a second iterate measures the contraction again.
const AGEING: f64 = 0.9;
/// Range of d over which factors made for another d are used; slow contraction ends their use sooner.
const REUSE: f64 = 2.0;
/// Stages solved with factors made for another d before they are made for the present one. Where the film is slow, such
/// factors contract by no more than |1 − d/d'|, and the remaining error can accumulate over many steps.
const MOST_BORROWED: u32 = 32;
/// Below this d, s, the increment x − x_known is accumulated separately: the difference has too few digits for a velocity,
/// and an error of x that the tolerance allows is one of the velocity that the step's error estimate does not. Both begin
/// at some 1e-8 s; ordinary runs keep their bits with this limit.
const SHORT_S: f64 = 1e-11;
/// Share of a cell's gas that one iterate may take.
const LARGEST_LOSS: f64 = 0.9;

/// The coupled head as a system of stages, over one step.
pub(super) struct Stages<'a> {
    pub model: &'a HeadModel,
    pub motion: &'a dyn DiskMotion,
    pub load: ShockLoad<'a>,
    pub scratch: &'a mut StageScratch,
    /// Iteration between film and structure, when they are solved in turn.
    pub exchange: Option<&'a mut FixedPoint>,
    /// Clearance to which errors are relative, m.
    pub gap_m: f64,
}

/// Pose and inertia load at one stage.
#[derive(Clone, Copy)]
pub(super) struct Instant {
    pub pose: DiskPose,
    pub a: f64,
    /// Motion of the pivot that is not in `a`, and its rate.
    pub pivot: [f64; 2],
    pub d_s: f64,
}

impl Instant {
    fn is_short(&self) -> bool {
        self.d_s < SHORT_S
    }
}

impl Stages<'_> {
    fn instant(&self, time_s: f64, d_s: f64) -> Instant {
        Instant {
            pose: self.motion.pose(time_s),
            a: self.load.value(time_s),
            pivot: self.motion.pivot(time_s),
            d_s,
        }
    }

    /// Renews Jacobian and factors at (ψ, attitude) for `d_s`.
    pub fn renew(
        &mut self,
        psi: &[f64],
        attitude: &Attitude,
        d_s: f64,
    ) -> Result<(), StageFailure> {
        let s = &mut *self.scratch;
        let film = s.first_order.film(&self.model.film);
        film.linearise(psi, attitude, &mut s.linearisation, &mut s.film);
        s.counters.linearisations += 1;
        self.factor(d_s)
    }

    /// Factors the present Jacobian for `d_s` and eliminates the film onto the slider.
    fn factor(&mut self, d_s: f64) -> Result<(), StageFailure> {
        let s = &mut *self.scratch;
        s.factored_d_s = None;
        s.counters.factorisations += 1;
        let storage = s.first_order.film(&self.model.film).storage();
        if s.lu
            .factor(&s.linearisation.by_psi, 1.0 / d_s, storage)
            .is_err()
        {
            return Err(StageFailure::NotConverged(f64::INFINITY));
        }
        for (z, by) in s.z.iter_mut().zip(&s.linearisation.by_attitude) {
            z.copy_from_slice(by);
            s.lu.solve(z);
        }
        s.counters.solves += 3;
        for f in 0..3 {
            let sum = products(columns_of(&s.z), &s.linearisation.force_by_psi[f]);
            let by_attitude = s.linearisation.force_by_attitude[f];
            s.film_matrix[f] = std::array::from_fn(|q| sum[q] - by_attitude[q]);
        }
        s.factored_d_s = Some(d_s);
        s.n_borrowed = 0;
        s.matrix_key = None;
        s.contraction = FIRST_CONTRACTION;
        Ok(())
    }

    /// Makes factors for `d_s`, unless the present ones suffice.
    pub fn ensure_factors(
        &mut self,
        psi: &[f64],
        attitude: &Attitude,
        d_s: f64,
    ) -> Result<bool, StageFailure> {
        let s = &mut *self.scratch;
        match s.factored_d_s {
            Some(d) if d == d_s => Ok(false),
            Some(d) if s.n_borrowed < MOST_BORROWED && d < d_s * REUSE && d_s < d * REUSE => {
                s.n_borrowed += 1;
                Ok(false)
            }
            Some(_) => self.factor(d_s).map(|()| false),
            None => self.renew(psi, attitude, d_s).map(|()| true),
        }
    }

    /// Film residual r_f at the iterate into the scratch; F − F₀.
    pub fn film_residual(
        &mut self,
        instant: &Instant,
        attitude: &Attitude,
        psi: &[f64],
        psi_known: &[f64],
    ) -> [f64; 3] {
        let s = &mut *self.scratch;
        let film = s.first_order.film(&self.model.film);
        let force = film.flux_residual_and_force(psi, attitude, &mut s.residual, &mut s.film);
        s.counters.residuals += 1;
        let states = [psi, psi_known];
        add_storage(&mut s.residual, film.storage(), states, 1.0 / instant.d_s);
        std::array::from_fn(|f| force[f] - self.model.steady_force[f])
    }

    /// Records the residual of the film's mass balance, relative to the film's present mass: a slider far from the disk
    /// holds many times the mass of steady flight.
    pub fn note_imbalance(&mut self, spurious: f64, psi: &[f64]) {
        let mass = product(self.model.film.capacity(), psi);
        let worst = &mut self.scratch.counters.mass_balance_error;
        *worst = worst.max((spurious / mass).abs());
    }

    /// Replaces `scratch.mechanical` by the solution with S + film's condensed stiffness, which is kept while d,
    /// contacts and film are the same. False when there is none.
    fn solve_mechanics(&mut self, d_s: f64, closed: Closed, with_film: bool) -> bool {
        let s = &mut *self.scratch;
        let key = MatrixKey {
            d_s,
            closed,
            with_film,
        };
        if s.matrix_key != Some(key) {
            s.matrix_key = None;
            let film = if with_film {
                s.film_matrix
            } else {
                [[0.0; 3]; 3]
            };
            let mechanics = &self.model.mechanics;
            if !s.matrix.prepare(mechanics, d_s, closed, &film) {
                return false;
            }
            s.matrix_key = Some(key);
        }
        s.matrix.solve(&mut s.mechanical)
    }

    /// Contacts that are closed at `x` with the velocities in the scratch.
    pub fn closed(&mut self, instant: &Instant, x: &[f64]) -> Closed {
        let (mechanics, s) = (&self.model.mechanics, &mut *self.scratch);
        let [moved, rate] = instant.pivot;
        if instant.pivot == [0.0; 2] {
            return mechanics.closed(x, &s.velocity);
        }
        let [seen, v, _] = &mut s.seen;
        mechanics.over_pivot(moved, x, seen);
        mechanics.over_pivot(rate, &s.velocity, v);
        mechanics.closed(seen, v)
    }

    /// One mechanical correction δx for residual r_m and film term `condensed`, left in
    /// `scratch.mechanical`. Without film when `condensed` is `None`.
    pub fn mechanical_step(
        &mut self,
        state: &MechanicalIterate<'_>,
        condensed: Option<[f64; 3]>,
    ) -> Result<(), StageFailure> {
        let (mechanics, s) = (&self.model.mechanics, &mut *self.scratch);
        let mut stage = StageState {
            d_s: state.instant.d_s,
            a: state.instant.a,
            film: state.film,
            x: state.x,
            v: &s.velocity,
            v_known: state.v_known,
        };
        let pivot = state.instant.pivot;
        if pivot != [0.0; 2] {
            let [x, v, v_known] = &mut s.seen;
            mechanics.over_pivot(pivot[0], stage.x, x);
            mechanics.over_pivot(pivot[1], stage.v, v);
            mechanics.over_pivot(pivot[1], stage.v_known, v_known);
            (stage.x, stage.v, stage.v_known) = (x, v, v_known);
        }
        let closed = mechanics.imbalance(&stage, &mut s.mechanical);
        s.last_closed = closed;
        if let Some(condensed) = condensed {
            for (r, f) in s.mechanical.iter_mut().zip(condensed) {
                *r -= f;
            }
        }
        if self.solve_mechanics(state.instant.d_s, closed, condensed.is_some()) {
            Ok(())
        } else {
            Err(StageFailure::NotFinite("slider and suspension"))
        }
    }

    /// Newton on film and mechanics together.
    fn monolithic(
        &mut self,
        instant: &Instant,
        known: &[f64],
        y: &mut [f64],
    ) -> Result<(), StageFailure> {
        let (n_cells, n) = (self.model.film.n_cells(), self.model.mechanics.len());
        let (psi_known, rest) = known.split_at(n_cells);
        let (x_known, v_known) = rest.split_at(n);
        let (psi, rest) = y.split_at_mut(n_cells);
        let (x, v) = rest.split_at_mut(n);
        let tolerance = self.model.resolution.coupling_tolerance;

        let attitude = self.model.attitude(x, &instant.pose);
        if instant.is_short() {
            let from_known = x.iter().zip(x_known).map(|(x, known)| x - known);
            self.scratch.increment.clear();
            self.scratch.increment.extend(from_known);
        }
        let mut fresh = self.ensure_factors(psi, &attitude, instant.d_s)?;
        let mut previous = f64::INFINITY;
        let mut estimate = f64::INFINITY;
        for iteration in 0..MAX_ITERATIONS {
            let attitude = self.model.attitude(x, &instant.pose);
            self.velocities(instant, x_known, x);
            let film = self.film_residual(instant, &attitude, psi, psi_known);
            let spurious = sum(&self.scratch.residual);
            let condensed = self.scratch.solve_film();
            let iterate = MechanicalIterate {
                instant,
                film,
                x,
                v_known,
            };
            self.mechanical_step(&iterate, Some(condensed))?;

            let (size, cut) = self.apply(instant, psi, x)?;
            if cut {
                self.scratch.discard_factors();
                let attitude = self.model.attitude(x, &instant.pose);
                self.renew(psi, &attitude, instant.d_s)?;
                (fresh, previous) = (true, f64::INFINITY);
                continue;
            }
            let contraction = if previous.is_finite() {
                (size / previous).max(1e-4)
            } else {
                self.scratch.contraction
            };
            self.scratch.contraction = if previous.is_finite() {
                contraction.min(0.9)
            } else {
                contraction.powf(AGEING)
            };
            estimate = if contraction < 1.0 {
                size * contraction / (1.0 - contraction)
            } else {
                size
            };
            if estimate <= tolerance && contraction < 1.0 {
                self.velocities(instant, x_known, x);
                v.copy_from_slice(&self.scratch.velocity);
                self.note_imbalance(spurious * instant.d_s * contraction, psi);
                let counters = &mut self.scratch.counters;
                counters.max_residual = counters.max_residual.max(estimate);
                return Ok(());
            }
            if previous.is_finite() && contraction > SLOW {
                if contraction > 2.0 && fresh && iteration > 3 {
                    break;
                }
                let attitude = self.model.attitude(x, &instant.pose);
                self.renew(psi, &attitude, instant.d_s)?;
                (fresh, previous) = (true, f64::INFINITY);
            } else {
                previous = size;
            }
        }
        Err(StageFailure::NotConverged(estimate))
    }

    /// Velocities (x − x_known)/d of an iterate into the scratch.
    fn velocities(&mut self, instant: &Instant, x_known: &[f64], x: &[f64]) {
        let s = &mut *self.scratch;
        if instant.is_short() {
            for (v, increment) in s.velocity.iter_mut().zip(&s.increment) {
                *v = increment / instant.d_s;
            }
        } else {
            for ((v, x), known) in s.velocity.iter_mut().zip(x).zip(x_known) {
                *v = (x - known) / instant.d_s;
            }
        }
    }

    /// Applies the correction in the scratch (A⁻¹ r_f and δx) to (ψ, x). Returns its size relative to the gap, and
    /// whether it was shortened.
    fn apply(
        &mut self,
        instant: &Instant,
        psi: &mut [f64],
        x: &mut [f64],
    ) -> Result<(f64, bool), StageFailure> {
        let s = &mut *self.scratch;
        let dq = [s.mechanical[0], s.mechanical[1], s.mechanical[2]];
        let (square, loss) = correct_film(&mut s.residual, &s.z, psi, dq);
        let mut gap = self.model.gap_change(&dq) / self.gap_m;
        if instant.is_short() {
            gap *= self.model.velocity_to_gap_s / instant.d_s;
        }
        let size = gap + (square / psi.len() as f64).sqrt();
        if !size.is_finite() {
            return Err(StageFailure::NotFinite("film pressure"));
        }
        let factor = if loss > LARGEST_LOSS {
            LARGEST_LOSS / loss
        } else {
            1.0
        };
        add_scaled(psi, factor, &s.residual);
        for (x, delta) in x.iter_mut().zip(&s.mechanical) {
            *x += factor * delta;
        }
        if instant.is_short() {
            add_scaled(&mut s.increment, factor, &s.mechanical);
        }
        Ok((size, factor < 1.0))
    }
}

/// Iterate of the mechanics within a stage; velocities are in the scratch.
pub(super) struct MechanicalIterate<'a> {
    pub instant: &'a Instant,
    pub film: [f64; 3],
    pub x: &'a [f64],
    pub v_known: &'a [f64],
}

impl StageSystem for Stages<'_> {
    type Failure = StageFailure;

    fn solve_stage(
        &mut self,
        time_s: f64,
        d_s: f64,
        known: &[f64],
        y: &mut [f64],
    ) -> Result<(), StageFailure> {
        let instant = self.instant(time_s, d_s);
        // The guess is arbitrary where the step is long; the film needs gas in every cell.
        let n_cells = self.model.film.n_cells();
        for (psi, known) in y[..n_cells].iter_mut().zip(known) {
            let has_gas = *psi > 0.0;
            if !has_gas {
                *psi = known.abs().max(f64::MIN_POSITIVE);
            }
        }
        match self.exchange.take() {
            None => self.monolithic(&instant, known, y),
            Some(exchange) => {
                let solved = self.solve_partitioned(exchange, &instant, known, y);
                self.exchange = Some(exchange);
                solved
            }
        }
    }

    fn filter(&mut self, d_s: f64, error: &mut [f64]) {
        let (n_cells, n) = (self.model.film.n_cells(), self.model.mechanics.len());
        let (e_psi, rest) = error.split_at_mut(n_cells);
        let (e_x, e_v) = rest.split_at_mut(n);
        let s = &mut *self.scratch;
        let per_d = 1.0 / d_s;
        let film = s.first_order.film(&self.model.film);
        film.storage().multiply(e_psi, &mut s.residual);
        for r in &mut s.residual {
            *r *= per_d;
        }
        let force = s.solve_film();
        let closed = s.last_closed;
        self.model
            .mechanics
            .filter_load(d_s, closed, e_x, e_v, &mut s.mechanical);
        for (r, f) in s.mechanical.iter_mut().zip(force) {
            *r += f;
        }
        if !self.solve_mechanics(d_s, closed, true) {
            error.fill(f64::NAN);
            return;
        }
        let s = &mut *self.scratch;
        let dq = [s.mechanical[0], s.mechanical[1], s.mechanical[2]];
        combine(&s.residual, dq.map(|d| -d), columns_of(&s.z), e_psi);
        for ((e_x, e_v), x) in e_x.iter_mut().zip(e_v).zip(&s.mechanical) {
            *e_v = (x - *e_x) / d_s;
            *e_x = *x;
        }
    }
}
