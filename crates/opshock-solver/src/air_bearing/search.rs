//! Searches for the equilibria of a slider under a load, and computes the properties of the one that is flown.

use super::attitude::Attitude;
use super::film::Film;
use super::newton::{MOST_ITERATIONS, NEAR, Newton, span};
use super::steady_error::SteadyError;
use crate::linalg::banded::BandedError;
use nalgebra::{Matrix3, Vector3};

/// Slider flying in equilibrium under a load.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Attitude.
    pub attitude: Attitude,
    /// ψ of every cell, Pa m.
    pub psi: Vec<f64>,
    /// Smallest clearance, m.
    pub min_clearance_m: f64,
    /// Force of the air on the part of the surface above ambient pressure, N.
    pub lift_n: f64,
    /// Force of the part below ambient pressure, N; negative.
    pub suction_n: f64,
    /// Centre of the air's pressure in slider coordinates, m.
    pub centre_of_pressure_m: [f64; 2],
    /// Largest pressure, Pa.
    pub p_max_pa: f64,
    /// Smallest pressure, Pa.
    pub p_min_pa: f64,
    /// Quasi-static stiffness −dF/dq in the order (h_c, pitch, roll): N/m, N, N m/rad.
    pub stiffness: [[f64; 3]; 3],
    /// Quasi-static damping −dF/d(dq/dt): N s/m, N s, N m s/rad.
    pub damping: [[f64; 3]; 3],
    /// Linearisations used for this equilibrium, from the start that led to it.
    pub n_iterations: usize,
}

/// An equilibrium other than the one flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// Attitude.
    pub attitude: Attitude,
    /// Smallest clearance, m.
    pub min_clearance_m: f64,
    /// Whether all stiffness eigenvalues have positive real parts.
    pub stable: bool,
}

/// Equilibria met so far.
pub(super) struct Search<'a> {
    pub(super) newton: Newton<'a>,
    pub(super) load: Vector3<f64>,
    pub(super) found: Vec<Found>,
    last: Attitude,
    /// Error of the last attempt that failed.
    broken: Option<BandedError>,
}

#[derive(Clone)]
pub(super) struct Found {
    pub(super) attitude: Attitude,
    pub(super) psi: Vec<f64>,
    stiffness: Matrix3<f64>,
    pub(super) clearance_m: f64,
    pub(super) stable: bool,
    n_iterations: usize,
}

impl Found {
    pub(super) fn of(flight: &Flight) -> Self {
        Self {
            attitude: flight.attitude,
            psi: flight.psi.clone(),
            stiffness: Matrix3::from(flight.stiffness).transpose(),
            clearance_m: flight.min_clearance_m,
            stable: true,
            n_iterations: flight.n_iterations,
        }
    }

    pub(super) fn equilibrium(&self) -> Equilibrium {
        Equilibrium {
            attitude: self.attitude,
            min_clearance_m: self.clearance_m,
            stable: self.stable,
        }
    }
}

impl<'a> Search<'a> {
    pub(super) fn new(film: &'a Film, load: Vector3<f64>, last: Attitude) -> Self {
        Self {
            newton: Newton::<f64>::new(film),
            load,
            found: Vec::new(),
            last,
            broken: None,
        }
    }

    /// Newton from a start, the film from `psi`; what it converges to joins `found`.
    pub(super) fn attempt(&mut self, start: &Attitude, mut psi: Vec<f64>) {
        let before = self.newton.n_factored;
        let mut attitude = *start;
        let held = self.newton.hold(&mut psi, start, MOST_ITERATIONS, NEAR);
        let settled = held.and_then(|_| self.settle(&mut psi, &mut attitude, before));
        self.broken = settled.err().or(self.broken);
    }

    /// Overdamped motion from a start, then Newton.
    pub(super) fn attempt_by_drift(&mut self, start: &Attitude) {
        let broken = self.drifted(start).err();
        self.broken = broken.or(self.broken);
    }

    fn drifted(&mut self, start: &Attitude) -> Result<(), BandedError> {
        let before = self.newton.n_factored;
        let mut attitude = *start;
        let mut psi = self.newton.film.ambient(start);
        self.newton.hold(&mut psi, start, MOST_ITERATIONS, NEAR)?;
        self.newton.drift(&mut psi, &mut attitude, &self.load)?;
        self.settle(&mut psi, &mut attitude, before)
    }

    /// Newton from a state near an equilibrium, which joins `found`.
    pub(super) fn settle(
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
        let scale = clearance_m.abs().max(film.min_height_m());
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
        // Eigenvalues with a positive definite metric; their signs do not depend on the metric.
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
    pub(super) fn best(&self) -> Option<usize> {
        let stable = self.found.iter().enumerate().filter(|(_, f)| f.stable);
        stable
            .max_by(|a, b| a.1.clearance_m.total_cmp(&b.1.clearance_m))
            .map(|(k, _)| k)
    }

    pub(super) fn finish(mut self) -> Result<Flight, SteadyError> {
        let Some(best) = self.best() else {
            return Err(match self.found.first() {
                Some(found) => SteadyError::Unstable {
                    attitude: found.attitude,
                },
                None => match self.broken {
                    Some(broken) => SteadyError::Singular(broken),
                    None => SteadyError::NotConverged {
                        iterations: self.newton.n_factored,
                        attitude: self.last,
                    },
                },
            });
        };
        let found = self.found.swap_remove(best);
        self.reported(found)
    }

    /// Computes all properties of an equilibrium.
    pub(super) fn reported(mut self, found: Found) -> Result<Flight, SteadyError> {
        let film = self.newton.film;
        self.newton.factor(&found.psi, &found.attitude)?;
        self.newton.schur();
        let damping = self.newton.damping();
        let mut forces = vec![0.0; film.n_cells()];
        film.cell_forces(
            &found.psi,
            &found.attitude,
            &mut forces,
            &mut film.scratch(),
        );
        let mut pressure = vec![0.0; film.n_cells()];
        film.pressure(&found.psi, &found.attitude, &mut pressure);
        let [force, m_pitch, m_roll] =
            film.air_force(&found.psi, &found.attitude, &mut film.scratch());
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
            psi: found.psi,
        })
    }
}

fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}
