//! Result of a point's search, in points of the amplitude grid.

use std::collections::BTreeSet;

use super::outcome::{Flag, Status};

/// Answer of a point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Findings {
    /// How the search ended.
    pub status: Status,
    /// Highest survivor below the lowest failure.
    pub survivor: Option<i32>,
    /// Lowest failure.
    pub failure: Option<i32>,
    /// Every (survivor, next higher failure), ascending.
    pub brackets: Vec<(i32, i32)>,
    /// Lower end of the scan.
    pub scanned_from: Option<i32>,
    /// Largest step between survivors from there up to the survivor, grid steps.
    pub largest_gap: Option<i32>,
    /// What a reader must know.
    pub flags: BTreeSet<Flag>,
    /// Simulations requested.
    pub runs: u64,
    /// Of these without verdict.
    pub undecided_runs: u64,
}

/// What a point takes from the same point without ramp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inheritance {
    /// Everything: the answer lies below first touch, or first touch above the range.
    Whole,
    /// Survival below the grid point of first touch.
    Below {
        /// First grid point that touches.
        onset_index: i32,
    },
    /// Nothing.
    Nothing,
}

impl Findings {
    /// What a point whose disk first touches at `onset_index` takes from these no-ramp findings;
    /// `highest` is the highest grid point of the range.
    pub fn bequeath(&self, onset_index: i32, highest: i32) -> Inheritance {
        match self.status {
            Status::Ok | Status::AboveRange | Status::BelowRange => {
                let answered_below = self.failure.is_some_and(|failure| failure < onset_index);
                if answered_below || onset_index > highest {
                    Inheritance::Whole
                } else {
                    Inheritance::Below { onset_index }
                }
            }
            Status::Undecided | Status::Open => Inheritance::Nothing,
        }
    }

    /// Findings of a point that takes its whole answer from these no-ramp findings.
    pub fn copied_below(&self, onset_index: i32) -> Findings {
        let mut copy = self.clone();
        copy.runs = 0;
        copy.undecided_runs = 0;
        copy.brackets.retain(|&(_, failure)| failure < onset_index);
        if copy.brackets.len() < 2 {
            copy.flags.remove(&Flag::NonMonotone);
        }
        copy.flags.insert(Flag::NoTouch);
        copy
    }

    /// A point's own findings with a failure below first touch that its companion found later.
    pub fn lowered_by(mut self, companion: &Findings, onset_index: i32) -> Findings {
        let Some(failure) = companion.failure.filter(|&failure| failure < onset_index) else {
            return self;
        };
        self.status = companion.status;
        self.survivor = companion.survivor;
        self.failure = Some(failure);
        let below = companion
            .brackets
            .iter()
            .filter(|&&(_, failure)| failure < onset_index);
        self.brackets = below.copied().chain(self.brackets).collect();
        self.scanned_from = companion.scanned_from;
        self.largest_gap = companion.largest_gap;
        self.flags.insert(Flag::NonMonotone);
        self.flags.insert(Flag::NoTouch);
        self
    }
}
