//! Finds the load that a film carries, by following steady flight from light loads to heavier ones.
//!
//! ```text
//! R(ψ, q) = 0,   F(ψ, q) = s load,   s from 0 to 1
//! ```
//!
//! Under a light load the slider flies high, where the film is easy to find. From there the flight is continued in the
//! share s of the load; steps in s are halved where no flight is found. The flights end in one of two ways. At a limit
//! point the stiffness matrix K becomes singular (Keller 1977, in Rabinowitz, *Applications of Bifurcation Theory*,
//! 359). Or the clearance reaches the minimum film height, below which no flight is defined. Beyond a limit point the
//! slider follows the overdamped motion of [`super::steady`] under a slightly larger load. If it comes to rest above
//! the minimum height, flights are followed on from there; if not, the last flight carries the largest load.

use super::attitude::Attitude;
use super::film::Film;
use super::search::{Flight, Found, Search};
use super::steady_error::{FlightsEnd, SteadyError};
use nalgebra::Vector3;

/// First and smallest step in the share that grows.
const SHARE_STEPS: [f64; 2] = [0.25, 1.0 / 1024.0];

/// Shares of a load under which a first flight is sought. The last ones are for films with stable flights under heavy
/// loads alone: under light ones, such a slider pitches until it touches.
const LIGHT: [f64; 9] = [
    0.5,
    0.25,
    0.125,
    1.0 / 32.0,
    1.0 / 128.0,
    1.0 / 512.0,
    0.65,
    0.8,
    0.9,
];

/// Most branches that the overdamped motion leads to.
const MOST_BRANCHES: usize = 4;

/// Stable flights followed along a share of something.
pub(super) struct Path {
    /// Share that was reached; 1 at the end.
    pub(super) share: f64,
    /// The flight there.
    pub(super) last: Found,
    /// How flights end, where 1 was not reached.
    pub(super) ends: FlightsEnd,
}

impl Path {
    /// From the `start` at a share towards 1, film and load given by `at`; flights have at least `clearance_m`.
    pub(super) fn along(
        at: &impl Fn(f64) -> (Film, Vector3<f64>),
        start: (f64, Found),
        clearance_m: f64,
    ) -> Self {
        let (share, last) = start;
        let mut path = Self {
            share,
            last,
            ends: FlightsEnd::AtLimitPoint,
        };
        let [mut step, smallest] = SHARE_STEPS;
        while path.share < 1.0 {
            let share = f64::min(path.share + step, 1.0);
            let (film, load) = at(share);
            let mut search = Search::new(&film, load, path.last.attitude);
            let (mut attitude, mut psi) = (path.last.attitude, path.last.psi.clone());
            let before = search.newton.n_factored;
            // A solver breakdown is a flight not found.
            let _ = search.settle(&mut psi, &mut attitude, before);
            match search.found.pop() {
                Some(found) if found.stable && found.clearance_m >= clearance_m => {
                    path.last = found;
                    path.share = share;
                    continue;
                }
                Some(found) if found.stable => path.ends = FlightsEnd::AtMinimumHeight,
                _ => path.ends = FlightsEnd::AtLimitPoint,
            }
            if step <= smallest {
                break;
            }
            step *= 0.5;
        }
        path
    }
}

/// The flight under `load` followed from lighter ones, or that there is none; `None` where no light one is found.
pub(super) fn followed(
    film: &Film,
    load: [f64; 3],
    start: &Attitude,
) -> Option<Result<Flight, SteadyError>> {
    let load = Vector3::from(load);
    let (share, found) = LIGHT
        .into_iter()
        .find_map(|share| Some((share, let_down(film, load * share, &starts(film, start))?)))?;
    let at = |share: f64| (film.clone(), load * share);
    let mut path = Path::along(&at, (share, found), film.min_height_m());
    for _ in 1..MOST_BRANCHES {
        if path.share == 1.0 {
            break;
        }
        let share = f64::min(path.share + 2.0 * SHARE_STEPS[1], 1.0);
        match let_down(film, load * share, &[path.last.attitude]) {
            Some(found) => path = Path::along(&at, (share, found), film.min_height_m()),
            None => break,
        }
    }
    if path.share == 1.0 {
        return Some(Search::new(film, load, path.last.attitude).reported(path.last));
    }
    Some(Err(SteadyError::CannotFly {
        load_n: load[0],
        carried_n: path.share * load[0],
        clearance_m: path.last.clearance_m,
        ends: path.ends,
    }))
}

/// Attitudes from which a light slider is let go.
fn starts(film: &Film, start: &Attitude) -> [Attitude; 3] {
    let usual = film.usual_attitude();
    let mut high = usual;
    high.centre_height_m += 1e-7;
    [usual, high, *start]
}

/// Where a slider comes to rest above the minimum film height, let go at one of `starts` under `load`.
fn let_down(film: &Film, load: Vector3<f64>, starts: &[Attitude]) -> Option<Found> {
    starts.iter().find_map(|start| {
        let mut search = Search::new(film, load, *start);
        search.newton.ends_on_disk = true;
        search.attempt_by_drift(start);
        let found = search.found.pop()?;
        (found.stable && found.clearance_m >= film.min_height_m()).then_some(found)
    })
}
