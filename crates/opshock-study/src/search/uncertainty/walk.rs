//! The sequence of runs that an uncertainty interval requests, and the bracket of the scene itself that they leave.

use super::ask::{Ask, Seen, UncertaintyInput};
use crate::search::evidence::AmplitudeVerdict;
use crate::search::probe::Retry;
use opshock_solver::scene::discretisation::{Discretisation, Levels};

/// Largest refinement level of the defect-correction grid. Beyond it sampling takes longer than many shocks.
pub(super) const FINEST_CORRECTION: i8 = 3;

/// Possible halvings of the film from which on coarser films can show its error: a film of fewer cells, and coarser ones
/// with it, may have another flying state than finer ones, or none.
pub(super) const DEEP: i8 = 3;

/// Survivor and failure of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bracket {
    pub low: i32,
    pub high: i32,
}

/// A scene from which changes are measured, with its bracket or a guess of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub levels: Levels,
    pub bracket: Bracket,
}

/// Requests runs in order; the first that is not known ends the walk.
pub(super) struct Walk<'a> {
    pub(super) input: &'a UncertaintyInput,
    pub(super) lookup: &'a dyn Fn(Ask) -> Option<Seen>,
    pub(super) log: &'a mut Vec<Ask>,
}

impl<'a> Walk<'a> {
    pub(super) fn new(
        input: &'a UncertaintyInput,
        lookup: &'a dyn Fn(Ask) -> Option<Seen>,
        log: &'a mut Vec<Ask>,
    ) -> Self {
        Self { input, lookup, log }
    }

    /// A run of the scene changed by `levels`. Without verdict the scene itself is retried as the search retries; a
    /// changed one is not, since the change may be what fails.
    pub(super) fn see(&mut self, levels: Levels, index: i32) -> Result<Seen, Ask> {
        let mut ask = Ask {
            levels: self.input.base.plus(levels),
            index,
            retry: Retry::None,
        };
        loop {
            let seen = (self.lookup)(ask).ok_or(ask)?;
            if !self.log.contains(&ask) {
                self.log.push(ask);
            }
            let is_open = levels.is_none() && seen.verdict == AmplitudeVerdict::Undecided;
            match ask.retry.next().filter(|_| is_open) {
                Some(retry) => ask.retry = retry,
                None => return Ok(seen),
            }
        }
    }

    /// The scene as it is.
    pub(super) fn itself(&self) -> Start {
        Start {
            levels: Levels::NONE,
            bracket: Bracket {
                low: self.input.survivor,
                high: self.input.failure,
            },
        }
    }

    /// A scene with these discretisation parameters refined by so many steps can be made.
    pub(super) fn has_finer(&self, discretisations: &[Discretisation], steps: i8) -> bool {
        let mut own = discretisations.iter();
        own.all(|&discretisation| {
            let level = self.input.base.of(discretisation) + steps;
            match discretisation {
                Discretisation::RampMesh => level <= self.input.mesh_halvings,
                Discretisation::FilmCorrection => level <= FINEST_CORRECTION,
                _ => true,
            }
        })
    }

    /// Ratio of amplitudes `grid_points` grid steps apart, minus one.
    pub(super) fn share(&self, grid_points: i32) -> f64 {
        (f64::from(grid_points) / f64::from(self.input.grid.steps_per_octave)).exp2() - 1.0
    }
}

/// The bracket of the scene itself, narrowed by the runs requested on the way.
pub(super) fn bracket(walk: &Walk<'_>) -> Bracket {
    let input = walk.input;
    let mut inside: Vec<(i32, AmplitudeVerdict)> = walk
        .log
        .iter()
        .filter(|ask| ask.levels == input.base)
        .filter(|ask| (input.survivor..input.failure).contains(&ask.index))
        .filter_map(|&ask| Some((ask.index, (walk.lookup)(ask)?.verdict)))
        .collect();
    inside.sort_by_key(|one| one.0);
    let mut ends = walk.itself().bracket;
    for (index, verdict) in inside {
        match verdict {
            AmplitudeVerdict::Survives => ends.low = index,
            AmplitudeVerdict::Fails => {
                ends.high = index;
                break;
            }
            AmplitudeVerdict::Undecided => {}
        }
    }
    ends
}

/// The scene itself failed below the answer found, at a survivor requested for a slope.
pub(super) fn fails_below(walk: &Walk<'_>) -> bool {
    let input = walk.input;
    walk.log
        .iter()
        .filter(|ask| ask.levels == input.base && ask.index < input.survivor)
        .any(|&ask| (walk.lookup)(ask).is_some_and(|seen| seen.verdict == AmplitudeVerdict::Fails))
}
