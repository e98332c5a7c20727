//! Newton's method for the steady film, alone or together with the slider's attitude.
//!
//! With A = dR/dψ and C = dR/dq, elimination of ψ gives
//!
//! ```text
//! K = −dF/dq along R = 0 = F_ψ A⁻¹ C − F_q,    K δq = F − load − F_ψ A⁻¹ R,
//! δψ = −A⁻¹ R − A⁻¹ C δq.
//! ```
//!
//! K is the quasi-static stiffness of the flying slider. A step is limited to a set share of every cell's ψ and of the
//! clearance.

use super::attitude::Attitude;
use super::film::Film;
use super::linearise::FilmLinearisation;
use super::state::FilmScratch;
use super::steady_error::SteadyError;
use crate::lanes::product;
use crate::linalg::banded::{BandedError, BandedLu, Entry};
use crate::linalg::diagonals::Diagonals;
use nalgebra::{Matrix3, Vector3};

/// Relative step after which, by quadratic convergence, only rounding is left.
pub(super) const CONVERGED: f64 = 1e-9;
/// Relative step after which the iteration on ψ and attitude takes over from that on ψ alone.
pub(super) const NEAR: f64 = 1e-2;
/// Most Newton iterations of one attempt.
pub(super) const MOST_ITERATIONS: usize = 60;
/// Relative step at which [`CONTRACTION`] bounds the error of a quasi-static film (fixed attitude) to a third of it.
const HELD: f64 = 1e-6;
/// Contraction of the iteration with kept factors above which they are renewed.
const CONTRACTION: f64 = 0.3;
/// Relative step after which kept factors belong to another state.
const FARTHEST: f64 = 0.5;
/// Most iterations for a quasi-static film (fixed attitude).
const MOST_HELD: usize = 200;
/// Most steps of the overdamped motion.
const MOST_DRIFT_STEPS: usize = 200;
/// Share of a cell's ψ a step must leave.
const PSI_KEPT: f64 = 0.2;

/// Scratch of the Newton iterations, with factors kept as `E`.
pub(super) struct Newton<'a, E: Entry = f64> {
    pub(super) film: &'a Film,
    pub(super) scratch: FilmScratch,
    pub(super) linearisation: FilmLinearisation,
    pub(super) lu: BandedLu<E>,
    /// A⁻¹ [C, R], column by column.
    pub(super) columns: [Vec<f64>; 4],
    zero: Diagonals,
    pub(super) n_factored: usize,
    /// Whether `lu` holds factors from near the state.
    has_factors: bool,
    /// Whether [`Newton::drift`] ends on the disk.
    pub(super) ends_on_disk: bool,
}

impl<'a, E: Entry> Newton<'a, E> {
    pub(super) fn new(film: &'a Film) -> Self {
        let n = film.n_cells();
        let linearisation = film.linearisation();
        Self {
            film,
            scratch: film.scratch(),
            lu: BandedLu::new(n, linearisation.by_psi.band()),
            linearisation,
            columns: [0; 4].map(|_| vec![0.0; n]),
            zero: Diagonals::zeros(n, Vec::new()),
            n_factored: 0,
            has_factors: false,
            ends_on_disk: false,
        }
    }

    /// Linearises and factors at a state.
    pub(super) fn factor(&mut self, psi: &[f64], attitude: &Attitude) -> Result<(), BandedError> {
        self.n_factored += 1;
        self.film
            .linearise(psi, attitude, &mut self.linearisation, &mut self.scratch);
        self.lu.factor(&self.linearisation.by_psi, 0.0, &self.zero)
    }

    /// Fills `columns`; returns force, K and F_ψ A⁻¹ R.
    pub(super) fn schur(&mut self) -> (Vector3<f64>, Matrix3<f64>, Vector3<f64>) {
        let lin = &self.linearisation;
        let [by_h, by_pitch, by_roll] = &lin.by_attitude;
        let sources = [by_h, by_pitch, by_roll, &lin.residual];
        for (column, source) in self.columns.iter_mut().zip(sources) {
            column.copy_from_slice(source);
            self.lu.solve(column);
        }
        let product = lin
            .force_by_psi
            .each_ref()
            .map(|gradient| self.columns.each_ref().map(|c| product(gradient, c)));
        let stiffness = Matrix3::from_fn(|i, j| product[i][j] - lin.force_by_attitude[i][j]);
        let pending = Vector3::from_fn(|i, _| product[i][3]);
        (Vector3::from(lin.force), stiffness, pending)
    }

    /// Gradient by ψ of the clearance that a small force error costs at constant load, r K⁻¹ F, with r the lever arms
    /// of the closest point.
    pub(super) fn clearance_goal(&mut self, attitude: &Attitude) -> Option<Vec<f64>> {
        let (_, stiffness, _) = self.schur();
        let film = self.film;
        let closest = film.min_clearance(&film.leaning(attitude));
        let [l, w] = film.extent_m();
        let arms = Vector3::new(1.0, -(closest.x_m - 0.5 * l), closest.y_m - 0.5 * w);
        let row = stiffness.transpose().try_inverse()? * arms;
        let gradients = &self.linearisation.force_by_psi;
        Some(
            (0..film.n_cells())
                .map(|k| {
                    row[0] * gradients[0][k] + row[1] * gradients[1][k] + row[2] * gradients[2][k]
                })
                .collect(),
        )
    }

    /// −F_ψ A⁻¹ M A⁻¹ C with the storage M, from the columns [`Newton::schur`] left behind.
    pub(super) fn damping(&mut self) -> Matrix3<f64> {
        let mut stored = vec![0.0; self.film.n_cells()];
        for column in &mut self.columns[..3] {
            self.film.storage().multiply(column, &mut stored);
            column.copy_from_slice(&stored);
            self.lu.solve(column);
        }
        let gradients = &self.linearisation.force_by_psi;
        Matrix3::from_fn(|i, j| -product(&gradients[i], &self.columns[j]))
    }

    /// Newton on ψ alone, in place, until a relative step is below `until`; returns iterations and
    /// the last relative step.
    pub(super) fn hold(
        &mut self,
        psi: &mut [f64],
        attitude: &Attitude,
        most: usize,
        until: f64,
    ) -> Result<(usize, f64), BandedError> {
        let mut step = f64::INFINITY;
        let mut delta = vec![0.0; psi.len()];
        for iteration in 1..=most {
            self.factor(psi, attitude)?;
            delta.copy_from_slice(&self.linearisation.residual);
            self.lu.solve(&mut delta);
            step = 0.0;
            for (psi, delta) in psi.iter_mut().zip(&delta) {
                let new = (*psi - delta).max(PSI_KEPT * *psi);
                step = step.max((new - *psi).abs() / *psi);
                *psi = new;
            }
            if step < until {
                return Ok((iteration, step));
            }
        }
        Ok((most, step))
    }

    /// Discards the kept factors.
    pub(super) fn forget(&mut self) {
        self.has_factors = false;
    }

    /// Force and moments of the air on a slider at a fixed attitude. `psi` starts near the equilibrium and ends in it.
    /// Factors are kept as long as the iteration contracts, those at hand first.
    ///
    /// # Errors
    ///
    /// [`SteadyError`] where it does not converge.
    pub(super) fn force_held(
        &mut self,
        psi: &mut [f64],
        attitude: &Attitude,
    ) -> Result<[f64; 3], SteadyError> {
        let mut before = f64::INFINITY;
        let mut delta = vec![0.0; psi.len()];
        for _ in 0..MOST_HELD {
            if self.has_factors {
                self.film
                    .flux_residual(psi, attitude, &mut delta, &mut self.scratch);
            } else {
                self.factor(psi, attitude)?;
                delta.copy_from_slice(&self.linearisation.residual);
            }
            self.lu.solve(&mut delta);
            let mut step = 0.0_f64;
            for (psi, delta) in psi.iter_mut().zip(&delta) {
                let new = (*psi - delta).max(PSI_KEPT * *psi);
                let change = (new - *psi).abs();
                // One division takes longer than everything else in this loop.
                if change > step * *psi {
                    step = change / *psi;
                }
                *psi = new;
            }
            self.has_factors = step < CONTRACTION * before && step < FARTHEST;
            if step < HELD {
                return Ok(self.film.air_force(psi, attitude, &mut self.scratch));
            }
            before = step;
        }
        Err(SteadyError::NotConverged {
            iterations: MOST_HELD,
            attitude: *attitude,
        })
    }

    /// Newton on (ψ, q), in place; whether it converged.
    pub(super) fn fly(
        &mut self,
        psi: &mut [f64],
        attitude: &mut Attitude,
        load: &Vector3<f64>,
    ) -> Result<bool, BandedError> {
        for _ in 0..MOST_ITERATIONS {
            self.factor(psi, attitude)?;
            let (force, stiffness, pending) = self.schur();
            let Some(inverse) = stiffness.try_inverse() else {
                return Ok(false);
            };
            let full = inverse * (force - load - pending);
            if !full.iter().all(|v| v.is_finite()) {
                return Ok(false);
            }
            if self.advance(psi, attitude, &full) < CONVERGED {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Overdamped motion under load and film force, in place, until Newton's method may take over.
    ///
    /// An implicit Euler step of D dq/dt = F − load with D of the size of the stiffness of a rigid
    /// plate on springs; the film follows quasi-statically. D falls with the unbalanced force.
    pub(super) fn drift(
        &mut self,
        psi: &mut [f64],
        attitude: &mut Attitude,
        load: &Vector3<f64>,
    ) -> Result<(), BandedError> {
        let [l, w] = self.film.extent_m();
        let unit = Vector3::new(1.0, 0.25 * l * l, 0.25 * w * w);
        let levers = Vector3::new(1.0, 0.5 * l, 0.5 * w);
        let scale = load.component_div(&levers).norm().max(1e-6);
        for _ in 0..MOST_DRIFT_STEPS {
            // A slider that far inside the disk does not return.
            let depth = -self.film.min_clearance(attitude).value_m / self.film.min_height_m();
            if depth > if self.ends_on_disk { 1.0 } else { 10.0 } {
                return Ok(());
            }
            self.hold(psi, attitude, 8, CONVERGED)?;
            self.factor(psi, attitude)?;
            let (force, stiffness, pending) = self.schur();
            let unbalanced = force - load - pending;
            let share = unbalanced.component_div(&levers).norm() / scale;
            if share < 1e-3 {
                return Ok(());
            }
            let clearance = self
                .film
                .min_clearance(attitude)
                .value_m
                .max(self.film.min_height_m());
            let drag = share * scale / clearance;
            let step = (stiffness + Matrix3::from_diagonal(&(unit * drag)))
                .try_inverse()
                .map_or(unbalanced.component_div(&(unit * drag)), |m| m * unbalanced);
            self.advance(psi, attitude, &step);
        }
        Ok(())
    }

    /// Takes the admissible share of a change of attitude, the film along with it; the largest
    /// relative change left or made.
    fn advance(&self, psi: &mut [f64], attitude: &mut Attitude, full: &Vector3<f64>) -> f64 {
        let share = self.admissible_share(attitude, full);
        let change = full * share;
        let mut step = (1.0 - share).max(relative_change(self.film, attitude, &change));
        let [by_h, by_pitch, by_roll, own] = &self.columns;
        for (k, psi) in psi.iter_mut().enumerate() {
            let by_attitude =
                by_h[k] * change[0] + by_pitch[k] * change[1] + by_roll[k] * change[2];
            let delta = own[k] + by_attitude;
            let new = (*psi - delta).max(PSI_KEPT * *psi);
            step = step.max((new - *psi).abs() / *psi);
            *psi = new;
        }
        *attitude = moved(attitude, &change);
        step
    }

    /// Largest share of a change of attitude that neither takes most of the clearance nor triples
    /// it.
    fn admissible_share(&self, attitude: &Attitude, change: &Vector3<f64>) -> f64 {
        let film = self.film;
        let before = film
            .min_clearance(attitude)
            .value_m
            .max(film.min_height_m());
        let mut share = 1.0;
        for _ in 0..60 {
            let after = film
                .min_clearance(&moved(attitude, &(change * share)))
                .value_m;
            let tilt = span(film, change) * share;
            if after > 0.4 * before - film.min_height_m()
                && after < 3.0 * before
                && tilt < 3.0 * before + 2e-8
            {
                break;
            }
            share *= 0.7;
        }
        share
    }
}

/// Largest change of height over the slider, m.
pub(super) fn span(film: &Film, change: &Vector3<f64>) -> f64 {
    let [l, w] = film.extent_m();
    change[0].abs() + 0.5 * l * change[1].abs() + 0.5 * w * change[2].abs()
}

fn relative_change(film: &Film, attitude: &Attitude, change: &Vector3<f64>) -> f64 {
    span(film, change)
        / film
            .min_clearance(attitude)
            .value_m
            .abs()
            .max(film.min_height_m())
}

fn moved(attitude: &Attitude, change: &Vector3<f64>) -> Attitude {
    Attitude {
        centre_height_m: attitude.centre_height_m + change[0],
        pitch_rad: attitude.pitch_rad + change[1],
        roll_rad: attitude.roll_rad + change[2],
    }
}
