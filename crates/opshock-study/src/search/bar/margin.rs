//! Reading by the margin: δA = δh / |dh/dA| at one and the same event.
//!
//! The smallest clearance of the survivors is a margin of the failure only if it belongs to the
//! same event: its instant is that at which the lowest failure touches. A survivor of 2 nm whose
//! minimum lies a millisecond later says nothing about the touch that ends survival.

use opshock_solver::scene::knob::{Knob, Levels};

use super::judge::{self, Estimate};
use super::{Ask, Known, Limits, Seen, Walk};
use crate::search::evidence::NodeVerdict;

/// Instants this close are one event, s: half a period of the slider on its film and gimbal.
const EVENT_S: f64 = 1.0e-4;
/// Largest distance of the two amplitudes behind a slope, as a share; a difference of clearance
/// worth more is not read by it.
const REACH: f64 = 0.12;

/// What differences are read against.
pub(super) struct Reference {
    /// Highest survivor of the search.
    at: Known,
    /// Amplitude below it, node.
    below: i32,
    /// Clearance there on the proxy and at the survivor, m.
    proxy_m: [f64; 2],
    /// Loss of clearance per relative growth of the amplitude, m: of the scene and of the proxy.
    slope_m: [f64; 2],
}

fn is_same_event(a_s: f64, b_s: f64) -> bool {
    (a_s - b_s).abs() <= EVENT_S
}

/// Clearance of a survivor at the event.
fn clearance(seen: Seen, event_s: f64) -> Option<f64> {
    let is_there = seen.verdict == NodeVerdict::Survives
        && seen.t_min_s.is_some_and(|t| is_same_event(t, event_s));
    seen.h_min_m.filter(|_| is_there)
}

impl Reference {
    /// The reference, `None` where the margin is not that of the failure.
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
        let has_film = input.knobs.contains(&Knob::FilmGrid);
        if (has_film && input.film_halvings < 2)
            || !input
                .t_fail_s
                .is_some_and(|t_fail_s| is_same_event(t_fail_s, at.t_min_s))
        {
            return Ok(None);
        }
        let reach = input.lattice.nodes_within(REACH);
        let lower = input
            .survivors
            .iter()
            .filter(|known| {
                known.index < at.index
                    && known.index >= at.index - reach
                    && known.h_min_m > at.h_min_m
                    && is_same_event(known.t_min_s, at.t_min_s)
            })
            .min_by_key(|known| known.index);
        let Some(lower) = lower else {
            return Ok(None);
        };
        let span = walk.share(at.index - lower.index);
        let proxy = walk.proxy();
        let mut proxy_m = [0.0; 2];
        for (place, index) in [lower.index, at.index].into_iter().enumerate() {
            match clearance(walk.see(proxy, index)?, at.t_min_s) {
                Some(h_m) => proxy_m[place] = h_m,
                None => return Ok(None),
            }
        }
        let slope_m = [lower.h_min_m - at.h_min_m, proxy_m[0] - proxy_m[1]].map(|fall| fall / span);
        Ok((slope_m[1] > 0.0).then_some(Reference {
            at,
            below: lower.index,
            proxy_m,
            slope_m,
        }))
    }

    /// Error of the film's grid from half and a quarter of the cells.
    pub(super) fn film(&self, walk: &mut Walk<'_>) -> Result<Option<Estimate>, Ask> {
        // The flatter of the two slopes: the same error of clearance is more amplitude.
        let slope_m = self.slope_m[0].min(self.slope_m[1]);
        let both = (self.proxy_m[1] - self.at.h_min_m) / slope_m;
        if both.abs() > REACH {
            return Ok(None);
        }
        let half = Levels::NONE.turned(Knob::FilmGrid, -1);
        let Some(half_m) = clearance(walk.see(half, self.at.index)?, self.at.t_min_s) else {
            return Ok(None);
        };
        let near = (half_m - self.at.h_min_m) / slope_m;
        Ok(Some(judge::two_steps(&[Knob::FilmGrid], near, both - near)))
    }

    /// Error of other knobs turned together by one step on the proxy, of one knob by two where that
    /// is not little: at the survivor, or at the amplitude below it where turned scenes fail at the
    /// survivor.
    pub(super) fn knobs(
        &self,
        walk: &mut Walk<'_>,
        knobs: &[Knob],
        limits: Limits,
    ) -> Result<Option<Estimate>, Ask> {
        let once = judge::coarser(walk.proxy(), knobs);
        let accuracy = walk.input.accuracy;
        for (index, proxy_m) in [
            (self.at.index, self.proxy_m[1]),
            (self.below, self.proxy_m[0]),
        ] {
            let Some(first_m) = clearance(walk.see(once, index)?, self.at.t_min_s) else {
                continue;
            };
            let first = (first_m - proxy_m) / self.slope_m[1];
            if first.abs() > REACH {
                continue;
            }
            let estimate = judge::one_step(knobs, first);
            if limits.is_enough(knobs, estimate, accuracy) {
                return Ok(Some(estimate));
            }
            let seen = walk.see(judge::coarser(once, knobs), index)?;
            let second = clearance(seen, self.at.t_min_s)
                .map(|second_m| (second_m - first_m) / self.slope_m[1])
                .filter(|second| second.abs() <= REACH);
            return Ok(Some(match second {
                Some(second) => judge::two_steps(knobs, first, second),
                None => estimate,
            }));
        }
        Ok(None)
    }
}
