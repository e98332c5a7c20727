//! Steady states: the film under a held slider, and the slider flying under a load.
//!
//! ```text
//! R(ψ, q) = 0,   F(ψ, q) = load,   q = (h_c, pitch, roll)
//! ```
//!
//! Newton's method on (ψ, q) finds it from any sensible start. Where that is not
//! enough (a start far away, a pitch of the wrong sign) the slider follows an overdamped motion
//! under load and film force: every stable equilibrium attracts it, and Newton takes over near the
//! end. An equilibrium is stable when all eigenvalues of its stiffness have positive real parts.
//!
//! Where that finds no stable equilibrium with a clearance, the flight is followed from lighter loads
//! (`carrying`), films that Newton's method does not settle by pseudo-transient continuation (`relaxation`). It either
//! comes to the load, or ends before, and the slider cannot fly.

use super::Attitude;
use super::carrying::{Path, followed};
use super::film::Film;
use super::newton::{CONVERGED, MOST_ITERATIONS, NEAR, Newton, span};
use crate::linalg::banded::BandedError;
use crate::slider::clearance::ClearanceMap;
use nalgebra::{Matrix3, Vector3};
use std::fmt;
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
    /// Surface forces pull the slider onto the disk, from which the film alone keeps it away.
    #[error(
        "surface forces pull the slider onto the disk, {share:.3} of them is the most under which it \
         flies; without them it flies at {without_m:e} m"
    )]
    PulledIn {
        /// Share of the surface forces to which a flight could be followed, within a thousandth.
        share: f64,
        /// Smallest clearance without surface forces, m.
        without_m: f64,
    },
    /// The film carries less than the load: no stable equilibrium has a clearance.
    #[error(
        "the slider cannot fly under {:.4} mN: its film carries {:.4} mN at most, at a clearance of {:.3} nm; \
         followed from lighter loads, {ends}", 1e3 * load_n, 1e3 * carried_n, 1e9 * clearance_m
    )]
    CannotFly {
        /// The load, N.
        load_n: f64,
        /// The largest load of a stable flight, to about a thousandth of the load, N.
        carried_n: f64,
        /// Smallest clearance of that flight, m.
        clearance_m: f64,
        /// How the flights end there.
        ends: FlightsEnd,
    },
    /// The only equilibria found are unstable.
    #[error("the equilibrium at {attitude:?} is not stable")]
    Unstable {
        /// Its attitude.
        attitude: Attitude,
    },
}

/// How the stable flights under growing loads end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlightsEnd {
    /// At a limit point: no flight next to the last one carries more.
    AtLimitPoint,
    /// At the minimum film height: the next one has less clearance.
    AtMinimumHeight,
}

impl fmt::Display for FlightsEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AtLimitPoint => "its flights end at a limit point of the load",
            Self::AtMinimumHeight => "its flights end at the minimum film height",
        })
    }
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
    /// Linearisations spent on this equilibrium, from the start it was reached from.
    pub n_iterations: usize,
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

/// Steady film under a slider held at `attitude`.
///
/// # Errors
///
/// [`SteadyError`] when Newton's method from the ambient state does not converge.
pub fn fixed_attitude(film: &Film, attitude: &Attitude) -> Result<HeldFilm, SteadyError> {
    let mut newton = Newton::<f64>::new(film);
    let mut psi = vec![0.0; film.n_cells()];
    film.ambient_psi(attitude, &mut psi);
    let (n_iterations, step) =
        newton.hold_surely(&mut psi, attitude, 4 * MOST_ITERATIONS, CONVERGED)?;
    if step >= CONVERGED {
        return Err(SteadyError::NotConverged {
            iterations: n_iterations,
            attitude: *attitude,
        });
    }
    let force = film.force(&psi, attitude, &mut film.scratch());
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
/// Of several stable equilibria met on the way the one with the largest clearance is flown
/// ([`lower_equilibria`] looks for those below). Where surface forces act, one within the range of the film's minimum height
/// is no flight, and none is without clearance; flights followed from lighter loads end at the minimum height.
///
/// # Errors
///
/// [`SteadyError::CannotFly`] when the film does not carry the load, [`SteadyError`] when a stable equilibrium is
/// neither found nor ruled out; it names the best attitude met.
pub fn fly_from(film: &Film, load: [f64; 3], start: &Attitude) -> Result<Flight, SteadyError> {
    if film.surface_forces().is_none() {
        let flown = seek(film, load, start, true);
        return match flown {
            Ok(flight) if flight.min_clearance_m > 0.0 => Ok(flight),
            other => followed(film, load, start).unwrap_or(other),
        };
    }
    let flown = seek(film, load, start, false);
    let is_flight = |flight: &Flight| flight.min_clearance_m >= 2.0 * film.floor_m();
    if flown.as_ref().is_ok_and(is_flight) {
        return flown;
    }
    let bare = seek(&film.with_surface_share(0.0), load, start, true)?;
    match is_flight(&bare) {
        true => follow(film, load, &bare),
        false => flown,
    }
}

/// The equilibrium under `load` that Newton's method finds from `start` alone, which is near it.
///
/// # Errors
///
/// [`SteadyError`] when it is not found or not stable.
pub fn fly_near(film: &Film, load: [f64; 3], start: &Attitude) -> Result<Flight, SteadyError> {
    let mut search = Search::new(film, Vector3::from(load), *start);
    search.attempt(start, film.ambient(start));
    search.finish()
}

/// The flight under surface forces, followed from `bare` without them as their share grows to 1. Near
/// pull-in, where the slider has next to no stiffness left, Newton's method from afar misses it.
///
/// # Errors
///
/// [`SteadyError::PulledIn`] with the share at which the flight ends.
fn follow(film: &Film, load: [f64; 3], bare: &Flight) -> Result<Flight, SteadyError> {
    let load = Vector3::from(load);
    let at = |share| (film.with_surface_share(share), load);
    let path = Path::along(&at, (0.0, Found::of(bare)), 2.0 * film.floor_m());
    if path.share < 1.0 {
        return Err(SteadyError::PulledIn {
            share: path.share,
            without_m: bare.min_clearance_m,
        });
    }
    Search::new(film, load, path.last.attitude).told(path.last)
}

/// The search for equilibria behind [`fly_from`]; by overdamped motion only where that is asked for.
fn seek(
    film: &Film,
    load: [f64; 3],
    start: &Attitude,
    may_drift: bool,
) -> Result<Flight, SteadyError> {
    let load = Vector3::from(load);
    let mut search = Search::new(film, load, *start);
    let usual = film.usual_attitude();
    if *start != usual {
        search.attempt(start, film.ambient(start));
    }
    search.attempt(&usual, film.usual_psi().to_vec());
    if search.best().is_none() && may_drift {
        let mut high = usual;
        high.centre_height_m += 1e-7;
        for from in [usual, high, *start] {
            search.attempt_by_drift(&from);
            if search.best().is_some() {
                break;
            }
        }
    }
    search.finish()
}

/// Equilibria under the same load below a flight, where the surface presses on the film's floor: stable
/// ones are states in which a slider may remain after a touch.
pub fn lower_equilibria(film: &Film, load: [f64; 3], flight: &Flight) -> Vec<Equilibrium> {
    let mut search = Search::new(film, Vector3::from(load), flight.attitude);
    search.found.push(Found::of(flight));
    let flown = flight.attitude;
    for clearance in [2.0 * film.floor_m(), 8.0 * film.floor_m()] {
        let mut below = flown;
        below.centre_height_m += clearance - film.min_clearance(&flown).value_m;
        let mut psi = film.ambient(&below);
        let ambient = film.ambient(&flown);
        for (psi, (flown, ambient)) in psi.iter_mut().zip(flight.psi.iter().zip(&ambient)) {
            *psi *= flown / ambient;
        }
        search.attempt(&below, psi);
    }
    search.found[1..].iter().map(Found::equilibrium).collect()
}

/// Clearance of the usual attitude, m.
const USUAL_CLEARANCE_M: f64 = 1e-8;

/// Height of the windward edge over the other in the usual attitude, m.
const USUAL_RISE_M: f64 = 1e-7;

/// Windward edge up by a usual amount, no roll, the closest point at `USUAL_CLEARANCE_M`; `wind`
/// is the disk's velocity along x, of which only the sign counts.
pub(super) fn usual_attitude(clearance: &ClearanceMap, length_m: f64, wind: f64) -> Attitude {
    let pitch_rad = USUAL_RISE_M.copysign(wind) / length_m;
    Attitude {
        centre_height_m: USUAL_CLEARANCE_M - clearance.minimum(0.0, pitch_rad, 0.0).value_m,
        pitch_rad,
        roll_rad: 0.0,
    }
}

/// Equilibria met so far.
pub(super) struct Search<'a> {
    pub(super) newton: Newton<'a>,
    pub(super) load: Vector3<f64>,
    pub(super) found: Vec<Found>,
    last: Attitude,
    /// Why the last attempt that broke down did.
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
    fn of(flight: &Flight) -> Self {
        Self {
            attitude: flight.attitude,
            psi: flight.psi.clone(),
            stiffness: Matrix3::from(flight.stiffness).transpose(),
            clearance_m: flight.min_clearance_m,
            stable: true,
            n_iterations: flight.n_iterations,
        }
    }

    fn equilibrium(&self) -> Equilibrium {
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
    fn attempt(&mut self, start: &Attitude, mut psi: Vec<f64>) {
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
        match self.newton.relaxes {
            true => self
                .newton
                .hold_surely(&mut psi, start, MOST_ITERATIONS, NEAR)?,
            false => self.newton.hold(&mut psi, start, MOST_ITERATIONS, NEAR)?,
        };
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
        self.told(found)
    }

    /// All that is told about an equilibrium.
    pub(super) fn told(mut self, found: Found) -> Result<Flight, SteadyError> {
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
