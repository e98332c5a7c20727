//! Intervals of points that differ in the clearance called failure alone: what fails at a smaller one fails at a larger one.
//!
//! Runs of such points are the same up to the failure, so that an interval needs no run of its own where that of a smaller
//! clearance has seen the same change at the same amplitude fail, or come below the point's own clearance: of a failure an
//! interval uses the verdict alone. The answer is the same to the bit. Which runs an interval skips follows from the runs
//! that finished intervals have used, not from the order in which they came; where a run was simulated before that was
//! known, it counts as one that no interval asked for.

use super::searches::Registry;
use super::stage::{UncertaintyStage, uncertainty_probe};
use crate::search::{Retry, Verdict, uncertainty};

impl Registry<'_> {
    /// Points that differ from `point` in a smaller clearance called failure alone.
    fn smaller(&self, point: usize) -> impl Iterator<Item = usize> {
        let clearance_m = |point: usize| self.input.points[point].coordinates.fail_below_m;
        let alike = self
            .clearances
            .get(&self.campaign.order().smallest_clearance(point));
        let alike = alike.into_iter().flatten().copied();
        alike.filter(move |&other| clearance_m(other) < clearance_m(point))
    }

    /// A run of an interval fails by what the interval of a smaller clearance has seen.
    pub(super) fn fails_by_smaller(&self, point: usize, ask: uncertainty::Ask) -> bool {
        if ask.retry != Retry::None {
            return false;
        }
        let clearance_m = self.input.points[point].coordinates.fail_below_m;
        let fails = |verdict: &Verdict, h_min_m: Option<f64>| match verdict {
            Verdict::Fails { .. } => true,
            Verdict::Survives => h_min_m.is_some_and(|h_min_m| h_min_m < clearance_m),
            Verdict::Undecided { .. } => false,
        };
        self.smaller(point).any(|other| {
            let UncertaintyStage::Begun { log, .. } = &self.uncertainties[other] else {
                return false;
            };
            let run = self.runs.get(&self.key(other, uncertainty_probe(ask)));
            log.contains(&ask)
                && run.is_some_and(|run| fails(&run.result.verdict, run.result.h_min_m))
        })
    }

    /// The interval of a smaller clearance has not ended.
    pub(super) fn waits_for_smaller(&self, point: usize) -> bool {
        self.smaller(point).any(|other| !self.is_at_depth(other))
    }
}
