//! Steady states: the film under a held slider, and the slider flying under a load.
//!
//! ```text
//! R(ψ, q) = 0,   F(ψ, q) = load,   q = (h_c, pitch, roll)
//! ```
//!
//! Newton's method on (ψ, q) with ψ eliminated: with A = dR/dψ and C = dR/dq,
//!
//! ```text
//! K = −dF/dq along R = 0 = F_ψ A⁻¹ C − F_q,    K δq = F − load − F_ψ A⁻¹ R,
//! δψ = −A⁻¹ R − A⁻¹ C δq.
//! ```
//!
//! K is the quasi-static stiffness of the flying slider. A step never takes more than a set share
//! of a cell's ψ or of the clearance. Where that is not enough (a start far away, a pitch of the
//! wrong sign) the slider follows an overdamped motion under load and film force: every stable
//! equilibrium attracts it, and Newton takes over near the end.

use super::Attitude;
use super::film::{Film, FilmLinearisation, FilmScratch};
use crate::linalg::banded::{BandedError, BandedLu};
use crate::slider::clearance::ClearanceMap;
use nalgebra::{Matrix3, Vector3};
use thiserror::Error;

/// Why no steady state was found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SteadyError {
    /// The flux Jacobian could not be factored.
    #[error("the film's Jacobian could not be factored: {0}")]
    Singular(#[from] BandedError),
    /// Newton's method came to an end without converging.
    #[error("no steady state within {iterations} iterations; last attitude {attitude:?}")]
    NotConverged {
        /// Iterations spent.
        iterations: usize,
        /// Last attitude reached.
        attitude: Attitude,
    },
    /// The only equilibria found are unstable.
    #[error("the equilibrium at {attitude:?} is not stable")]
    Unstable {
        /// Its attitude.
        attitude: Attitude,
    },
}

/// Film in equilibrium under a held slider.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldFilm {
    /// ψ of every cell, Pa m.
    pub psi: Vec<f64>,
    /// [F_z, M_pitch, M_roll], N and N m.
    pub force: [f64; 3],
    /// Newton iterations.
    pub n_iterations: usize,
}

/// Slider flying in equilibrium under a load.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Attitude.
    pub attitude: Attitude,
    /// ψ of every cell, Pa m.
    pub psi: Vec<f64>,
    /// Smallest clearance, m.
    pub min_clearance_m: f64,
    /// Force of the part of the surface above ambient pressure, N.
    pub lift_n: f64,
    /// Force of the part below ambient pressure, N; negative.
    pub suction_n: f64,
    /// Centre of pressure in slider coordinates, m.
    pub centre_of_pressure_m: [f64; 2],
    /// Largest pressure, Pa.
    pub p_max_pa: f64,
    /// Smallest pressure, Pa.
    pub p_min_pa: f64,
    /// Quasi-static stiffness −dF/dq in the order (h_c, pitch, roll): N/m, N, N m/rad.
    pub stiffness: [[f64; 3]; 3],
    /// Quasi-static damping −dF/d(dq/dt): N s/m, N s, N m s/rad.
    pub damping: [[f64; 3]; 3],
    /// Linearisations spent on this equilibrium, from the start it was reached from.
    pub n_iterations: usize,
    /// Other equilibria met, stable or not, lower than this one.
    pub others: Vec<Equilibrium>,
}

/// An equilibrium apart from the one flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// Attitude.
    pub attitude: Attitude,
    /// Smallest clearance, m.
    pub min_clearance_m: f64,
    /// Whether all stiffness eigenvalues have positive real parts.
    pub stable: bool,
}

/// Relative step at which Newton's quadratic convergence leaves only rounding.
const CONVERGED: f64 = 1e-9;
/// Most Newton iterations of one attempt.
const MOST_ITERATIONS: usize = 60;
/// Most steps of the overdamped motion.
const MOST_DRIFT_STEPS: usize = 200;
/// Share of a cell's ψ a step must leave.
const PSI_KEPT: f64 = 0.2;

/// Scratch of the Newton iterations.
pub(super) struct Newton<'a> {
    pub(super) film: &'a Film,
    scratch: FilmScratch,
    pub(super) linearisation: FilmLinearisation,
    pub(super) lu: BandedLu,
    /// A⁻¹ [C, R].
    pub(super) columns: Vec<[f64; 4]>,
    zero: Vec<f64>,
    n_factored: usize,
}

impl<'a> Newton<'a> {
    pub(super) fn new(film: &'a Film) -> Self {
        let n = film.n_cells();
        let linearisation = film.linearisation();
        Self {
            film,
            scratch: film.scratch(),
            lu: BandedLu::new(n, linearisation.by_psi.half_bandwidth()),
            linearisation,
            columns: vec![[0.0; 4]; n],
            zero: vec![0.0; n],
            n_factored: 0,
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
    fn schur(&mut self) -> (Vector3<f64>, Matrix3<f64>, Vector3<f64>) {
        let lin = &self.linearisation;
        for (k, row) in self.columns.iter_mut().enumerate() {
            let [a, b, c] = &lin.by_attitude;
            *row = [a[k], b[k], c[k], lin.residual[k]];
        }
        self.lu.solve_columns(&mut self.columns);
        let mut product = [[0.0; 4]; 3];
        for (row, gradient) in product.iter_mut().zip(&lin.force_by_psi) {
            for (g, column) in gradient.iter().zip(&self.columns) {
                for (sum, c) in row.iter_mut().zip(column) {
                    *sum += g * c;
                }
            }
        }
        let stiffness = Matrix3::from_fn(|i, j| product[i][j] - lin.force_by_attitude[i][j]);
        let pending = Vector3::from_fn(|i, _| product[i][3]);
        (Vector3::from(lin.force), stiffness, pending)
    }

    /// Gradient by ψ of the clearance a small force error costs at constant load: of r K⁻¹ F with r
    /// the arms of the closest point.
    pub(super) fn clearance_goal(&mut self, attitude: &Attitude) -> Option<Vec<f64>> {
        let (_, stiffness, _) = self.schur();
        let film = self.film;
        let closest = film.min_clearance(attitude);
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

    /// −F_ψ A⁻¹ M A⁻¹ C with the capacities M, from the columns [`Newton::schur`] left behind.
    fn damping(&mut self) -> Matrix3<f64> {
        for (row, capacity) in self.columns.iter_mut().zip(self.film.capacity()) {
            row.iter_mut().for_each(|v| *v *= capacity);
        }
        self.lu.solve_columns(&mut self.columns);
        let gradients = &self.linearisation.force_by_psi;
        Matrix3::from_fn(|i, j| {
            -gradients[i]
                .iter()
                .zip(&self.columns)
                .map(|(g, row)| g * row[j])
                .sum::<f64>()
        })
    }

    /// Newton on ψ alone, in place; returns iterations and the last relative step.
    pub(super) fn hold(
        &mut self,
        psi: &mut [f64],
        attitude: &Attitude,
        most: usize,
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
            if step < CONVERGED {
                return Ok((iteration, step));
            }
        }
        Ok((most, step))
    }

    /// Newton on (ψ, q), in place; whether it converged.
    fn fly(
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
    fn drift(
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
            self.hold(psi, attitude, 8)?;
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
                .max(self.film.floor_m());
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
        for (psi, row) in psi.iter_mut().zip(&self.columns) {
            let delta = row[3] + row[0] * change[0] + row[1] * change[1] + row[2] * change[2];
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
        let before = film.min_clearance(attitude).value_m.max(film.floor_m());
        let mut share = 1.0;
        for _ in 0..60 {
            let after = film
                .min_clearance(&moved(attitude, &(change * share)))
                .value_m;
            let tilt = span(film, change) * share;
            if after > 0.4 * before - film.floor_m()
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
fn span(film: &Film, change: &Vector3<f64>) -> f64 {
    let [l, w] = film.extent_m();
    change[0].abs() + 0.5 * l * change[1].abs() + 0.5 * w * change[2].abs()
}

fn relative_change(film: &Film, attitude: &Attitude, change: &Vector3<f64>) -> f64 {
    span(film, change)
        / film
            .min_clearance(attitude)
            .value_m
            .abs()
            .max(film.floor_m())
}

fn moved(attitude: &Attitude, change: &Vector3<f64>) -> Attitude {
    Attitude {
        centre_height_m: attitude.centre_height_m + change[0],
        pitch_rad: attitude.pitch_rad + change[1],
        roll_rad: attitude.roll_rad + change[2],
    }
}

/// Steady film under a slider held at `attitude`.
///
/// # Errors
///
/// [`SteadyError`] when Newton's method from the ambient state does not converge.
pub fn fixed_attitude(film: &Film, attitude: &Attitude) -> Result<HeldFilm, SteadyError> {
    let mut newton = Newton::new(film);
    let mut psi = vec![0.0; film.n_cells()];
    film.ambient_psi(attitude, &mut psi);
    let (n_iterations, step) = newton.hold(&mut psi, attitude, 4 * MOST_ITERATIONS)?;
    if step >= CONVERGED {
        return Err(SteadyError::NotConverged {
            iterations: n_iterations,
            attitude: *attitude,
        });
    }
    let force = film.force(&psi, attitude);
    Ok(HeldFilm {
        psi,
        force,
        n_iterations,
    })
}

/// A slider flying in equilibrium under `load` = [F, M_pitch, M_roll], the force and moments the
/// film has to supply (N, N m), starting from a usual attitude.
///
/// # Errors
///
/// As [`fly_from`].
pub fn fly(film: &Film, load: [f64; 3]) -> Result<Flight, SteadyError> {
    fly_from(film, load, &film.usual_attitude())
}

/// As [`fly`], from `start`, which may be far from the answer.
///
/// Of several stable equilibria the one with the largest clearance is flown; the others are listed.
///
/// # Errors
///
/// [`SteadyError`] when no stable equilibrium is found; it names the best attitude met.
pub fn fly_from(film: &Film, load: [f64; 3], start: &Attitude) -> Result<Flight, SteadyError> {
    let load = Vector3::from(load);
    let mut search = Search {
        newton: Newton::new(film),
        load,
        found: Vec::new(),
        last: *start,
    };
    let usual = film.usual_attitude();
    search.attempt(start)?;
    if *start != usual {
        search.attempt(&usual)?;
    }
    if search.best().is_none() {
        let mut high = usual;
        high.centre_height_m += 1e-7;
        for from in [usual, high, *start] {
            search.attempt_by_drift(&from)?;
            if search.best().is_some() {
                break;
            }
        }
    }
    // Lower equilibria lie where the surface presses on the film's floor.
    if let Some(best) = search.best() {
        let flown = search.found[best].attitude;
        for clearance in [2.0 * film.floor_m(), 8.0 * film.floor_m()] {
            let mut below = flown;
            below.centre_height_m += clearance - film.min_clearance(&flown).value_m;
            search.attempt(&below)?;
        }
    }
    search.finish()
}

/// Clearance of the usual attitude, m.
const USUAL_CLEARANCE_M: f64 = 1e-8;

/// Height of the leading edge over the trailing edge in the usual attitude, m.
const USUAL_RISE_M: f64 = 1e-7;

/// Leading edge up by a usual amount, no roll, the closest point at `USUAL_CLEARANCE_M`.
pub(super) fn usual_attitude(clearance: &ClearanceMap, length_m: f64) -> Attitude {
    let pitch_rad = USUAL_RISE_M / length_m;
    Attitude {
        centre_height_m: USUAL_CLEARANCE_M - clearance.minimum(0.0, pitch_rad, 0.0).value_m,
        pitch_rad,
        roll_rad: 0.0,
    }
}

/// Equilibria met so far.
struct Search<'a> {
    newton: Newton<'a>,
    load: Vector3<f64>,
    found: Vec<Found>,
    last: Attitude,
}

struct Found {
    attitude: Attitude,
    psi: Vec<f64>,
    stiffness: Matrix3<f64>,
    clearance_m: f64,
    stable: bool,
    n_iterations: usize,
}

impl Search<'_> {
    fn film_at(&mut self, attitude: &Attitude) -> Result<Vec<f64>, BandedError> {
        let film = self.newton.film;
        let mut psi = vec![0.0; film.n_cells()];
        film.ambient_psi(attitude, &mut psi);
        self.newton.hold(&mut psi, attitude, MOST_ITERATIONS)?;
        Ok(psi)
    }

    /// Newton from a start; what it converges to joins `found`.
    fn attempt(&mut self, start: &Attitude) -> Result<(), BandedError> {
        let before = self.newton.n_factored;
        let mut attitude = *start;
        let mut psi = self.film_at(start)?;
        self.settle(&mut psi, &mut attitude, before)
    }

    /// Overdamped motion from a start, then Newton.
    fn attempt_by_drift(&mut self, start: &Attitude) -> Result<(), BandedError> {
        let before = self.newton.n_factored;
        let mut attitude = *start;
        let mut psi = self.film_at(start)?;
        self.newton.drift(&mut psi, &mut attitude, &self.load)?;
        self.settle(&mut psi, &mut attitude, before)
    }

    fn settle(
        &mut self,
        psi: &mut [f64],
        attitude: &mut Attitude,
        n_before: usize,
    ) -> Result<(), BandedError> {
        let converged = self.newton.fly(psi, attitude, &self.load)?;
        self.last = *attitude;
        let n_iterations = self.newton.n_factored - n_before;
        let film = self.newton.film;
        let clearance_m = film.min_clearance(attitude).value_m;
        let scale = clearance_m.abs().max(film.floor_m());
        let known = self.found.iter().any(|other| {
            let change = Vector3::new(
                attitude.centre_height_m - other.attitude.centre_height_m,
                attitude.pitch_rad - other.attitude.pitch_rad,
                attitude.roll_rad - other.attitude.roll_rad,
            );
            span(film, &change) < 1e-5 * scale
        });
        if !converged || known {
            return Ok(());
        }
        self.newton.factor(psi, attitude)?;
        let (_, stiffness, _) = self.newton.schur();
        // Eigenvalues with a positive definite metric; signs do not depend on which.
        let stable = stiffness
            .complex_eigenvalues()
            .iter()
            .all(|value| value.re > 0.0);
        self.found.push(Found {
            attitude: *attitude,
            psi: psi.to_vec(),
            stiffness,
            clearance_m,
            stable,
            n_iterations,
        });
        Ok(())
    }

    /// Index of the stable equilibrium with the largest clearance.
    fn best(&self) -> Option<usize> {
        let stable = self.found.iter().enumerate().filter(|(_, f)| f.stable);
        stable
            .max_by(|a, b| a.1.clearance_m.total_cmp(&b.1.clearance_m))
            .map(|(k, _)| k)
    }

    fn finish(mut self) -> Result<Flight, SteadyError> {
        let Some(best) = self.best() else {
            return Err(match self.found.first() {
                Some(found) => SteadyError::Unstable {
                    attitude: found.attitude,
                },
                None => SteadyError::NotConverged {
                    iterations: self.newton.n_factored,
                    attitude: self.last,
                },
            });
        };
        let found = self.found.swap_remove(best);
        let film = self.newton.film;
        self.newton.factor(&found.psi, &found.attitude)?;
        self.newton.schur();
        let damping = self.newton.damping();
        let mut forces = vec![0.0; film.n_cells()];
        film.cell_forces(&found.psi, &found.attitude, &mut forces);
        let mut pressure = vec![0.0; film.n_cells()];
        film.pressure(&found.psi, &found.attitude, &mut pressure);
        let [force, m_pitch, m_roll] = film.force(&found.psi, &found.attitude);
        let [l, w] = film.extent_m();
        Ok(Flight {
            attitude: found.attitude,
            min_clearance_m: found.clearance_m,
            lift_n: forces.iter().filter(|f| **f > 0.0).sum(),
            suction_n: forces.iter().filter(|f| **f < 0.0).sum(),
            centre_of_pressure_m: [0.5 * l - m_pitch / force, 0.5 * w + m_roll / force],
            p_max_pa: pressure.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            p_min_pa: pressure.iter().copied().fold(f64::INFINITY, f64::min),
            stiffness: rows(&found.stiffness),
            damping: rows(&damping),
            n_iterations: found.n_iterations,
            others: self
                .found
                .iter()
                .map(|f| Equilibrium {
                    attitude: f.attitude,
                    min_clearance_m: f.clearance_m,
                    stable: f.stable,
                })
                .collect(),
            psi: found.psi,
        })
    }
}

fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}
