//! Clearance-sensitivity estimate of a change of the critical amplitude: δA = δh / |dh/dA| at one and the same event.
//!
//! The smallest clearance of the survivors measures the distance from failure only if it belongs to the same event: its
//! instant is that at which the lowest failure touches. A survivor of 2 nm whose minimum lies a millisecond later says
//! nothing about the touch that ends survival.

use opshock_solver::scene::discretisation::{Discretisation, Levels};

use super::ask::{Ask, Known, SUBDIVISIONS, Seen};
use super::walk::{DEEP, Walk};
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
        let survivor = |known: &Known| Survivor {
            index: known.index,
            own_m: known.h_min_m,
        };
        // By this slope the touch lies near, where the lowest failure is.
        Ok((at.h_min_m < REACH * slope_m).then_some(Reference {
            event_s: at.t_min_s,
            at: [survivor(&at), survivor(lower)],
            slope_m,
        }))
    }

    /// Change of the answer from the scene at `from` to that at `to`, as a share: at the survivor, or below it where one of
    /// them fails there. `None` where both do not survive the event, or the change is too large.
    pub(super) fn change(
        &self,
        walk: &mut Walk<'_>,
        from: Levels,
        to: Levels,
    ) -> Result<Option<f64>, Ask> {
        for at in self.at {
            let Some(to_m) = clearance(walk.see(to, at.index)?, self.event_s) else {
                continue;
            };
            let from_m = match from.is_none() {
                true => Some(at.own_m),
                false => clearance(walk.see(from, at.index)?, self.event_s),
            };
            let change = from_m.map(|from_m| (to_m - from_m) / self.slope_m);
            if let Some(change) = change.filter(|change| change.abs() <= REACH) {
                return Ok(Some(change));
            }
        }
        Ok(None)
    }
}
