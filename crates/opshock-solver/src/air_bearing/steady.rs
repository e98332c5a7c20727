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

use super::attitude::Attitude;
use super::carrying::{Path, followed};
use super::film::Film;
use super::newton::{CONVERGED, MOST_ITERATIONS, Newton};
use super::search::{Found, Search};
use nalgebra::Vector3;

pub use super::search::{Equilibrium, Flight};
pub use super::steady_error::{FlightsEnd, SteadyError};

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
    if !film.is_drawn_in() {
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
    let bare = seek(&film.with_share_of_attraction(0.0), load, start, true)?;
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
    let at = |share| (film.with_share_of_attraction(share), load);
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
