//! Clearance-sensitivity estimate of a change of the critical amplitude: δA = δh / |dh/dA| at one and the same event.
//!
//! The smallest clearance of the survivors measures the distance from failure only if it belongs to the same event: its
//! instant is that at which the lowest failure touches. A survivor of 2 nm whose minimum lies a millisecond later says
//! nothing about the touch that ends survival.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::ask::{Ask, Known, SUBDIVISIONS, Seen};
use super::judge::{self, Estimate};
use super::limits::Limits;
use super::rebracketing::{self, DEEP};
use super::walk::Walk;
use crate::search::evidence::AmplitudeVerdict;

/// Largest time between two instants of one event, s: half a period of the slider on its film and gimbal.
const EVENT_S: f64 = 1.0e-4;
/// Largest distance of the two amplitudes behind a slope, as a share. Larger changes are not estimated by it.
const REACH: f64 = 0.12;
/// Distance below the highest survivor at which its slope is evaluated, a share.
const BELOW: f64 = 0.01;
/// Ratio of the clearances of the highest survivor and the next known one, above which no run is requested there.
const LATE: f64 = 0.2;

/// Event, survivors and slope that changes of clearance are evaluated with.
pub(super) struct Reference {
    /// Instant of the event, s.
    event_s: f64,
    /// The highest survivor of the search and one below it.
    at: [Survivor; 2],
    /// Loss of clearance per relative growth of the amplitude, m: between the two, or next to the highest where less.
    slope_m: f64,
}

fn is_same_event(a_s: f64, b_s: f64) -> bool {
    (a_s - b_s).abs() <= EVENT_S
}

/// A survivor [`BELOW`] `at`, requested where no known one lies far enough below for a slope: of a refined scene only
/// the grid points about its answer are known, and where a touch grows late, those below came close at another instant.
/// None where `at` is hardly closer than these are, since there survival ends abruptly.
fn just_below(walk: &mut Walk<'_>, at: &Known) -> Result<Option<Known>, Ask> {
    let input = walk.input;
    let others = input
        .survivors
        .iter()
        .filter(|known| known.index < at.index);
    let nearest = others.max_by_key(|known| known.index);
    let ends_abruptly = |nearest: &Known| {
        nearest.index <= at.index - SUBDIVISIONS && at.h_min_m > LATE * nearest.h_min_m
    };
    if nearest.is_none_or(ends_abruptly) {
        return Ok(None);
    }
    let index = at.index - input.grid.steps_within(BELOW).max(SUBDIVISIONS);
    let seen = walk.see(Levels::NONE, index)?;
    Ok(clearance(seen, at.t_min_s)
        .filter(|&h_min_m| h_min_m > at.h_min_m)
        .map(|h_min_m| Known {
            index,
            h_min_m,
            t_min_s: at.t_min_s,
        }))
}

/// A survivor at the event.
#[derive(Clone, Copy)]
struct Survivor {
    /// Grid point of its amplitude.
    index: i32,
    /// Its clearance, m.
    own_m: f64,
}

/// Clearance of a survivor at the event.
fn clearance(seen: Seen, event_s: f64) -> Option<f64> {
    let is_there = seen.verdict == AmplitudeVerdict::Survives
        && seen.t_min_s.is_some_and(|t| is_same_event(t, event_s));
    seen.h_min_m.filter(|_| is_there)
}

impl Reference {
    /// The reference; `None` where the smallest clearance is not that of the failure's event.
    pub(super) fn find(walk: &mut Walk<'_>) -> Result<Option<Reference>, Ask> {
        let input = walk.input;
        let Some(at) = input
            .survivors
            .iter()
            .copied()
            .find(|known| known.index == input.survivor)
        else {
            return Ok(None);
        };
        let has_film = input.discretisations.contains(&Discretisation::FilmGrid);
        if (has_film && input.film_halvings < DEEP)
            || !input
                .t_fail_s
                .is_some_and(|t_fail_s| is_same_event(t_fail_s, at.t_min_s))
        {
            return Ok(None);
        }
        let reach = input.grid.steps_within(REACH);
        let below = || {
            input.survivors.iter().filter(|known| {
                known.index < at.index
                    && known.index >= at.index - reach
                    && known.h_min_m > at.h_min_m
                    && is_same_event(known.t_min_s, at.t_min_s)
            })
        };
        // At least one step of the search away, so that rounding and steps of the head have no influence.
        let below = || below().filter(|known| known.index <= at.index - SUBDIVISIONS);
        let asked = match below().next() {
            Some(_) => None,
            None => just_below(walk, &at)?,
        };
        let below = || below().chain(asked.iter());
        let Some(lower) = below().min_by_key(|known| known.index) else {
            return Ok(None);
        };
        let next = below().max_by_key(|known| known.index).unwrap_or(lower);
        let slope_m = |below: &Known| {
            // The slope falls towards the touch: the smaller one gives the larger change of amplitude.
            (below.h_min_m - at.h_min_m) / walk.share(at.index - below.index)
        };
        let slope_m = slope_m(lower).min(slope_m(next));
        if clearance(walk.see(walk.surrogate(), at.index)?, at.t_min_s).is_none() {
            return Ok(None);
        }
        let survivor = |known: &Known| Survivor {
            index: known.index,
            own_m: known.h_min_m,
        };
        Ok((slope_m > 0.0).then_some(Reference {
            event_s: at.t_min_s,
            at: [survivor(&at), survivor(lower)],
            slope_m,
        }))
    }

    /// Clearance at the event of a changed scene.
    fn see(&self, walk: &mut Walk<'_>, levels: Levels, index: i32) -> Result<Option<f64>, Ask> {
        Ok(clearance(walk.see(levels, index)?, self.event_s))
    }

    /// Error of the film's grid from quasi-static films at a fixed attitude, if their estimate from a quarter of the
    /// cells leaves room for the other contributions with the bracket halved once. Else from half and a quarter of the
    /// cells; where that is not little, from quasi-static films or twice the cells. All at the survivor, or below it
    /// where another grid fails there. Where twice the cells fail at both, their own answer is bracketed.
    pub(super) fn film(
        &self,
        walk: &mut Walk<'_>,
        limits: Limits,
    ) -> Result<Option<Estimate>, Ask> {
        const FILM: [Discretisation; 1] = [Discretisation::FilmGrid];
        let slope_m = self.slope_m;
        let mut coarse_only = None;
        // One run of the scene itself halves the bracket.
        let room = limits.room + 0.25 * walk.share(walk.input.failure - walk.input.survivor);
        for at in self.at {
            let Some(quarter_m) = self.see(walk, walk.surrogate(), at.index)? else {
                continue;
            };
            let by_quarter = self.held(walk, at, (2, quarter_m))?;
            if let Some(held) = by_quarter.filter(|held| held.half_length() <= room) {
                return Ok(Some(held));
            }
            let both = (quarter_m - at.own_m) / slope_m;
            let half = judge::coarser(Levels::NONE, &FILM);
            let Some(half_m) = self.see(walk, half, at.index)? else {
                continue;
            };
            let near = (half_m - at.own_m) / slope_m;
            if near.abs().max(both.abs()) > REACH {
                continue;
            }
            let estimate = judge::two_coarser(&FILM, near, both - near);
            // Corrected films may agree although their common defect-correction grid errs; quasi-static films show that
            // error.
            let is_little = |error: &Estimate| error.error() <= limits.little;
            if is_little(&estimate) && by_quarter.as_ref().is_none_or(is_little) {
                return Ok(Some(estimate));
            }
            let held = self.held(walk, at, (1, half_m))?;
            if let Some(held) = held.filter(|held| held.error() <= estimate.error()) {
                return Ok(Some(held));
            }
            let double = judge::finer(Levels::NONE, &FILM);
            let fine = self
                .see(walk, double, at.index)?
                .map(|double_m| (at.own_m - double_m) / slope_m)
                .filter(|fine| fine.abs() <= REACH);
            if let Some(fine) = fine {
                return Ok(Some(judge::with_finer(&FILM, near, fine)));
            }
            coarse_only = coarse_only.or(Some((near, estimate)));
        }
        match coarse_only {
            Some((near, estimate)) => match rebracketing::double(walk)? {
                Some(fine) => Ok(Some(judge::with_finer(&FILM, near, fine))),
                None => Ok(Some(estimate.unconfirmed())),
            },
            None => Ok(None),
        }
    }

    /// Error of the film's grid from quasi-static films at a fixed attitude. Their prediction for the cells halved
    /// `halvings` times at `at`, against the `coarse_m` simulated there, shows how far their estimate is to be trusted.
    fn held(
        &self,
        walk: &mut Walk<'_>,
        at: Survivor,
        (halvings, coarse_m): (i8, f64),
    ) -> Result<Option<Estimate>, Ask> {
        if !walk.input.holds_films {
            return Ok(None);
        }
        let on = |steps: i8| Levels::NONE.changed(Discretisation::QuasiStaticFilm, steps);
        let Some(expected_m) = self.see(walk, on(-halvings), at.index)? else {
            return Ok(None);
        };
        let [upper, _] = self.at;
        let Some(continued_m) = self.see(walk, on(1), upper.index)? else {
            return Ok(None);
        };
        let fine = (upper.own_m - continued_m) / self.slope_m;
        let missed = (coarse_m - expected_m) / self.slope_m;
        let is_near = fine.abs().max(missed.abs()) <= REACH;
        // Films with errors e and r e differ by (r - 1) e.
        let rise = Discretisation::FilmGrid
            .formal_ratio()
            .powi(i32::from(halvings));
        Ok(is_near.then(|| judge::held(fine, missed / (rise - 1.0))))
    }

    /// Error of other discretisation parameters coarsened together by one step on the surrogate, and refined by one
    /// where that is neither little nor within the room: at the survivor, or below it where changed scenes fail there.
    pub(super) fn discretisations(
        &self,
        walk: &mut Walk<'_>,
        discretisations: &[Discretisation],
        limits: Limits,
    ) -> Result<Option<Estimate>, Ask> {
        let (surrogate, slope_m) = (walk.surrogate(), self.slope_m);
        let mut coarse_only = None;
        for at in self.at {
            let coarse = judge::coarser(surrogate, discretisations);
            let Some(coarse_m) = self.see(walk, coarse, at.index)? else {
                continue;
            };
            let Some(surrogate_m) = self.see(walk, surrogate, at.index)? else {
                continue;
            };
            let near = (coarse_m - surrogate_m) / slope_m;
            if near.abs() > REACH {
                continue;
            }
            let estimate = judge::one_step(discretisations, near);
            let is_enough = estimate.error() <= limits.little.max(limits.room);
            // What needed a finer run at the first survivor needs one at the second.
            if coarse_only.is_none() && is_enough || !walk.has_finer(discretisations) {
                return Ok(coarse_only.or(Some(estimate)));
            }
            let finer = judge::finer(surrogate, discretisations);
            let fine = self
                .see(walk, finer, at.index)?
                .map(|finer_m| (surrogate_m - finer_m) / slope_m)
                .filter(|fine| fine.abs() <= REACH);
            if let Some(fine) = fine {
                return Ok(Some(judge::with_finer(discretisations, near, fine)));
            }
            coarse_only = coarse_only.or(Some(estimate));
        }
        Ok(coarse_only)
    }
}
