//! Where recent survivors ended, for the doubled window to go on from there.
//!
//! A search asks for the highest survivor of a point once more in twice the window. It is one of the last that were
//! run; from its end the second half is all that is left. Whether a state is at hand does not reach the answer: a
//! run from the onset begins anew from its state at the same instant
//! ([`Going`](opshock_solver::simulation::Going)).

use std::collections::VecDeque;

use opshock_solver::simulation::HeadState;

use super::held::Key;

/// Memory of all states kept, bytes: some hundred on 1000 cells.
const MOST_BYTES: usize = 4 << 20;

/// Ends of the latest survivors.
#[derive(Default)]
pub(super) struct Ends {
    /// The oldest first.
    kept: VecDeque<(Key, HeadState)>,
    bytes: usize,
}

impl Ends {
    /// Keeps the end of a survivor, and drops the oldest while all are too large.
    pub(super) fn keep(&mut self, key: Key, state: HeadState) {
        self.take(&key);
        self.bytes += state.bytes();
        self.kept.push_back((key, state));
        while self.bytes > MOST_BYTES
            && let Some((_, oldest)) = self.kept.pop_front()
        {
            self.bytes -= oldest.bytes();
        }
    }

    /// That of a run, when it is kept; it is asked for once.
    pub(super) fn take(&mut self, key: &Key) -> Option<HeadState> {
        let place = self.kept.iter().position(|(known, _)| known == key)?;
        let (_, state) = self.kept.remove(place)?;
        self.bytes -= state.bytes();
        Some(state)
    }
}
