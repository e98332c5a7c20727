//! Runs that a bar looks up, in order, and the bracket that they leave of the scene itself.

use super::ask::{Ask, BarInput, Seen};
use crate::search::evidence::NodeVerdict;
use crate::search::probe::Retry;
use opshock_solver::scene::knob::{Knob, Levels};

/// Looks runs up in order; the first that is not known ends the walk.
pub(super) struct Walk<'a> {
    pub(super) input: &'a BarInput,
    pub(super) lookup: &'a dyn Fn(Ask) -> Option<Seen>,
    pub(super) log: &'a mut Vec<Ask>,
}

impl<'a> Walk<'a> {
    pub(super) fn new(
        input: &'a BarInput,
        lookup: &'a dyn Fn(Ask) -> Option<Seen>,
        log: &'a mut Vec<Ask>,
    ) -> Self {
        Self { input, lookup, log }
    }

    /// A run of the scene turned by `levels`. Without verdict the scene itself is tried again down
    /// the ladder of the search; a turned one is not, since its knobs may be what fails.
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
            let is_open = levels.is_none() && seen.verdict == NodeVerdict::Undecided;
            match ask.retry.next().filter(|_| is_open) {
                Some(retry) => ask.retry = retry,
                None => return Ok(seen),
            }
        }
    }

    /// The film on which the other knobs are compared.
    pub(super) fn proxy(&self) -> Levels {
        Levels::NONE.turned(Knob::FilmGrid, -self.input.film_halvings.min(2))
    }

    /// A scene with these knobs a step finer can be made.
    pub(super) fn has_finer(&self, knobs: &[Knob]) -> bool {
        !knobs.contains(&Knob::RampMesh)
            || self.input.base.of(Knob::RampMesh) < self.input.mesh_halvings
    }

    /// Whole nodes in a share.
    pub(super) fn nodes(&self, share: f64) -> i32 {
        self.input.lattice.nodes_within(share)
    }

    /// Ratio of amplitudes `nodes` apart, minus one.
    pub(super) fn share(&self, nodes: i32) -> f64 {
        self.share_of(f64::from(nodes))
    }

    /// The same of a distance between nodes.
    pub(super) fn share_of(&self, nodes: f64) -> f64 {
        (nodes / f64::from(self.input.lattice.nodes_per_octave)).exp2() - 1.0
    }
}

/// The bracket of the scene itself, narrowed by what was met of it on the way.
pub(super) fn bracket(walk: &Walk<'_>) -> (i32, i32) {
    let input = walk.input;
    let mut inside: Vec<(i32, NodeVerdict)> = walk
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
            NodeVerdict::Survives => ends.0 = index,
            NodeVerdict::Fails => {
                ends.1 = index;
                break;
            }
            NodeVerdict::Undecided => {}
        }
    }
    ends
}

/// The scene itself failed, where a slope was asked for, below the answer that was found.
pub(super) fn fails_below(walk: &Walk<'_>) -> bool {
    let input = walk.input;
    walk.log
        .iter()
        .filter(|ask| ask.levels == input.base && ask.index < input.survivor)
        .any(|&ask| (walk.lookup)(ask).is_some_and(|seen| seen.verdict == NodeVerdict::Fails))
}
