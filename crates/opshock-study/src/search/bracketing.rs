//! From a starting amplitude to a bracket of survivor and failure: exponential search, then halving.
//!
//! The exponential search starts with a 3 % step and doubles it at every further step up to an octave; without a
//! starting amplitude every step is an octave. Its direction is that of the last decided verdict. Grid points without a
//! verdict are stepped over.
//!
//! Where the smallest clearance falls steadily with the amplitude, two survivors show where it
//! vanishes: the exponential search goes there instead of beyond, and the first grid points tested in the bracket lie
//! on both sides of that place. Where the clearance is no guide, this costs two runs at most.

use super::amplitude_grid::{AmplitudeGrid, AmplitudeRange};
use super::evidence::{AmplitudeVerdict, Evidence};

/// First step of an exponential search from a hint, as a share.
const FIRST_STEP: f64 = 0.03;
/// Grid points of a bracket that the clearance may choose; where it needs more, it is no guide.
const AIMED: usize = 3;

/// Exponential search of one point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bracketing {
    start: i32,
    first_step: i32,
    octave: i32,
    ups: u32,
    downs: u32,
    /// Clearance below which the interface has failed, m.
    pub(super) fail_below_m: f64,
}

/// Next step of the exponential search from the evidence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BracketingStep {
    /// Test this grid point.
    Test(i32),
    /// A failure has a survivor below it.
    Bracketed {
        /// Survivor.
        survivor: i32,
        /// Failure.
        failure: i32,
    },
    /// The ends of the range are reached.
    Exhausted,
}

impl Bracketing {
    /// Exponential search over `grid_points` from a hint in G, or from the middle of the range.
    pub(super) fn new(
        grid: &AmplitudeGrid,
        grid_points: AmplitudeRange,
        hint_g: Option<f64>,
        fail_below_m: f64,
    ) -> Bracketing {
        let octave = grid.steps_per_octave;
        let (start, first_step) = match hint_g {
            Some(hint_g) => (grid.nearest(hint_g), grid.steps_within(FIRST_STEP)),
            None => (
                grid_points.low + (grid_points.high - grid_points.low) / 2,
                octave,
            ),
        };
        Bracketing {
            start: start.clamp(grid_points.low, grid_points.high),
            first_step,
            octave,
            ups: 0,
            downs: 0,
            fail_below_m,
        }
    }

    /// Next step. `assumed_survivor` is a grid point below `grid_points` known to survive without a run.
    pub(super) fn step(
        &self,
        evidence: &Evidence,
        grid_points: AmplitudeRange,
        assumed_survivor: Option<i32>,
    ) -> BracketingStep {
        let (Some(bottom), Some(top)) = (evidence.bottom(), evidence.top()) else {
            return BracketingStep::Test(self.start);
        };
        let Some(failure) = evidence.lowest_failure() else {
            let any_survivor = evidence.highest_survivor_below(None).is_some();
            // Nothing decided yet: smaller shocks are easier to compute.
            if !any_survivor && bottom > grid_points.low {
                return BracketingStep::Test(
                    (bottom - self.step_size(self.downs)).max(grid_points.low),
                );
            }
            if top < grid_points.high {
                let step_size = self.step_size(self.ups);
                let step = match evidence.failing_point(None, self.fail_below_m) {
                    Some(place) if top > self.start => {
                        ((place - f64::from(top)).ceil() as i32).clamp(1, step_size)
                    }
                    _ => step_size,
                };
                return BracketingStep::Test((top + step).min(grid_points.high));
            }
            return BracketingStep::Exhausted;
        };
        if let Some(survivor) = evidence.highest_survivor_below(Some(failure)) {
            return BracketingStep::Bracketed { survivor, failure };
        }
        let next = bottom - self.step_size(self.downs);
        match assumed_survivor {
            Some(survivor) if next < grid_points.low => {
                BracketingStep::Bracketed { survivor, failure }
            }
            _ if bottom > grid_points.low => BracketingStep::Test(next.max(grid_points.low)),
            _ => BracketingStep::Exhausted,
        }
    }

    /// Steps down from a grid point that is known to fail.
    pub(super) fn begin_at(&mut self, failure: i32) {
        self.start = failure;
    }

    /// Grid point next to the place in a bracket where the clearance falls to that called failure, after `halvings` grid points tested
    /// in it; `None` when the clearance is no guide (any more) or grid points without verdict lie between.
    pub(super) fn aimed(
        &self,
        evidence: &Evidence,
        survivor: i32,
        failure: i32,
        halvings: usize,
    ) -> Option<i32> {
        if failure - survivor < 3
            || halvings >= AIMED
            || !evidence.undecided_between(survivor, failure).is_empty()
        {
            return None;
        }
        let place = evidence.failing_point(Some(failure), self.fail_below_m)?;
        let last = place.floor();
        if !(f64::from(survivor) <= last && last < f64::from(failure)) {
            return None;
        }
        // The last grid point expected to survive, or if that is known, the one above it.
        Some((last as i32).max(survivor + 1).min(failure - 1))
    }

    /// Notes a step whose verdict is known.
    pub(super) fn count(&mut self, tested: i32) {
        if tested > self.start {
            self.ups += 1;
        } else if tested < self.start {
            self.downs += 1;
        }
    }

    fn step_size(&self, steps: u32) -> i32 {
        // Beyond 2^20 the octave has long been reached.
        (self.first_step << steps.min(20)).min(self.octave.max(self.first_step))
    }
}

/// Next grid point between a survivor and a failure, `None` when nothing testable is left between them.
///
/// Undecided grid points split the bracket; only the two outer pieces can move its ends, the wider first.
pub(super) fn bisect(evidence: &Evidence, survivor: i32, failure: i32) -> Option<i32> {
    let undecided = evidence.undecided_between(survivor, failure);
    let (low_end, high_start) = match (undecided.first(), undecided.last()) {
        (Some(&first), Some(&last)) => (first, last),
        _ => (failure, failure),
    };
    let middle = |low: i32, high: i32| (high - low > 1).then(|| low + (high - low) / 2);
    let lower = middle(survivor, low_end);
    let upper = middle(high_start, failure);
    if low_end - survivor >= failure - high_start {
        lower.or(upper)
    } else {
        upper.or(lower)
    }
}

/// Whether the highest grid point of the range survives.
pub(super) fn survives_at_top(evidence: &Evidence, grid_points: AmplitudeRange) -> bool {
    evidence.get(grid_points.high) == Some(AmplitudeVerdict::Survives)
}
