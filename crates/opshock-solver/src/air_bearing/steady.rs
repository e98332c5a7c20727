//! Steady states of the air bearing: the film at a fixed attitude, and the slider flying under a load.
//!
//! ```text
//! R(ψ, q) = 0,   F(ψ, q) = load,   q = (h_c, pitch, roll)
//! ```
//!
//! Newton's method on (ψ, q) finds it from most starts. Where that fails (a start far away, a pitch of the wrong sign),
//! the slider follows an overdamped motion under load and film force. Every stable equilibrium attracts it, and
//! Newton's method takes over near the end. An equilibrium is stable when all eigenvalues of its stiffness have
//! positive real parts.
//!
//! Where neither finds a stable equilibrium with a clearance, the flight is followed from lighter loads (`carrying`).
//! Either the flight reaches the load, or it ends before and the slider cannot fly.

use super::attitude::Attitude;
use super::carrying::{Path, followed};
use super::film::Film;
use super::newton::{CONVERGED, MOST_ITERATIONS, Newton};
use super::search::{Found, Search};
use nalgebra::Vector3;

pub use super::search::{Equilibrium, Flight};
pub use super::steady_error::{FlightsEnd, SteadyError};

/// Relative difference of clearances of which the larger one is another flight.
const HIGHER: f64 = 1e-5;

/// Quasi-static film of a slider at a fixed attitude.
#[derive(Clone, Debug, PartialEq)]
pub struct QuasiStaticFilm {
    /// ψ of every cell, Pa m.
    pub psi: Vec<f64>,
    /// [F_z, M_pitch, M_roll], N and N m.
    pub force: [f64; 3],
    /// Newton iterations.
    pub n_iterations: usize,
}

/// Steady film of a slider at the fixed `attitude`.
///
/// # Errors
///
/// [`SteadyError`] when Newton's method from the ambient state does not converge.
pub fn fixed_attitude(film: &Film, attitude: &Attitude) -> Result<QuasiStaticFilm, SteadyError> {
    let mut newton = Newton::<f64>::new(film);
    let mut psi = vec![0.0; film.n_cells()];
    film.ambient_psi(attitude, &mut psi);
    let (n_iterations, step) = newton.hold(&mut psi, attitude, 4 * MOST_ITERATIONS, CONVERGED)?;
    if step >= CONVERGED {
        return Err(SteadyError::NotConverged {
            iterations: n_iterations,
            attitude: *attitude,
        });
    }
    let force = film.force(&psi, attitude, &mut film.scratch());
    Ok(QuasiStaticFilm {
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
/// Of several stable equilibria the one with the largest clearance is flown ([`lower_equilibria`] looks for those
/// below). An equilibrium without clearance is no flight; with surface forces, neither is one within the range of the
/// minimum film height. Flights followed from lighter loads end at that height.
///
/// # Errors
///
/// [`SteadyError::CannotFly`] when the film does not carry the load; another [`SteadyError`], with the best attitude
/// met, when a stable equilibrium is neither found nor ruled out.
pub fn fly_from(film: &Film, load: [f64; 3], start: &Attitude) -> Result<Flight, SteadyError> {
    Ok(highest(film, load, flown(film, load, start)?))
}

/// The flight to which Newton's method comes from twice the height of `flight`, where its clearance is larger, and so
/// on. A film with defect correction may have further equilibria near the disk, where its correction is large.
fn highest(film: &Film, load: [f64; 3], flight: Flight) -> Flight {
    let mut above = flight.attitude;
    above.centre_height_m *= 2.0;
    match fly_near(film, load, &above) {
        Ok(higher) if higher.min_clearance_m > (1.0 + HIGHER) * flight.min_clearance_m => {
            highest(film, load, higher)
        }
        _ => flight,
    }
}

/// A flight, from `start` or a usual attitude.
fn flown(film: &Film, load: [f64; 3], start: &Attitude) -> Result<Flight, SteadyError> {
    if !film.is_drawn_in() {
        let flown = seek(film, load, start, true);
        return match flown {
            Ok(flight) if flight.min_clearance_m > 0.0 => Ok(flight),
            other => followed(film, load, start).unwrap_or(other),
        };
    }
    let flown = seek(film, load, start, false);
    let is_flight = |flight: &Flight| flight.min_clearance_m >= 2.0 * film.min_height_m();
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

/// The flight under surface forces, followed from `bare` without them as their share grows to 1. Near pull-in, where
/// almost no stiffness is left, Newton's method does not find it from afar.
///
/// # Errors
///
/// [`SteadyError::PulledIn`] with the share at which the flight ends.
fn follow(film: &Film, load: [f64; 3], bare: &Flight) -> Result<Flight, SteadyError> {
    let load = Vector3::from(load);
    let at = |share| (film.with_share_of_attraction(share), load);
    let path = Path::along(&at, (0.0, Found::of(bare)), 2.0 * film.min_height_m());
    if path.share < 1.0 {
        return Err(SteadyError::PulledIn {
            share: path.share,
            without_m: bare.min_clearance_m,
        });
    }
    Search::new(film, load, path.last.attitude).reported(path.last)
}

/// The search for equilibria behind [`fly_from`]; by overdamped motion only on request.
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

/// Equilibria under the same load below a flight, in the range of the minimum film height: stable ones are states in
/// which a slider may remain after a contact.
pub fn lower_equilibria(film: &Film, load: [f64; 3], flight: &Flight) -> Vec<Equilibrium> {
    let mut search = Search::new(film, Vector3::from(load), flight.attitude);
    search.found.push(Found::of(flight));
    let flown = flight.attitude;
    for clearance in [2.0 * film.min_height_m(), 8.0 * film.min_height_m()] {
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
