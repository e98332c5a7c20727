//! The sequence of runs that an uncertainty interval requests, and the bracket of the scene itself that they leave.

use super::ask::{Ask, Seen, UncertaintyInput};
use crate::search::evidence::AmplitudeVerdict;
use crate::search::probe::Retry;
use opshock_solver::scene::discretisation::{Discretisation, Levels};

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

    /// The film on which the other discretisation parameters are compared.
    pub(super) fn surrogate(&self) -> Levels {
        Levels::NONE.changed(Discretisation::FilmGrid, -self.input.film_halvings.min(2))
    }

    /// A scene with these discretisation parameters refined by one step can be made.
    pub(super) fn has_finer(&self, discretisations: &[Discretisation]) -> bool {
        !discretisations.contains(&Discretisation::RampMesh)
            || self.input.base.of(Discretisation::RampMesh) < self.input.mesh_halvings
    }

    /// Whole grid steps in a share.
    pub(super) fn nodes(&self, share: f64) -> i32 {
        self.input.grid.steps_within(share)
    }

    /// Ratio of amplitudes `nodes` grid steps apart, minus one.
    pub(super) fn share(&self, nodes: i32) -> f64 {
        self.share_of(f64::from(nodes))
    }

    /// The same for a distance between grid points.
    pub(super) fn share_of(&self, nodes: f64) -> f64 {
        (nodes / f64::from(self.input.grid.steps_per_octave)).exp2() - 1.0
    }
}

/// The bracket of the scene itself, narrowed by the runs requested on the way.
pub(super) fn bracket(walk: &Walk<'_>) -> (i32, i32) {
    let input = walk.input;
    let mut inside: Vec<(i32, AmplitudeVerdict)> = walk
        .log
        .iter()
        .filter(|ask| ask.levels == input.base)
        .filter(|ask| (input.survivor..input.failure).contains(&ask.index))
        .filter_map(|&ask| Some((ask.index, (walk.lookup)(ask)?.verdict)))
        .collect();
    inside.sort_by_key(|one| one.0);
    let mut ends = (input.survivor, input.failure);
    for (index, verdict) in inside {
        match verdict {
            AmplitudeVerdict::Survives => ends.0 = index,
            AmplitudeVerdict::Fails => {
                ends.1 = index;
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
