//! Scan for failures at amplitudes below the critical one.
//!
//! With a ramp, survival need not be monotone: the instants of contact move with the amplitude, so that a shock may fail
//! at 350 G and survive at 400 G. After the search has bracketed the critical amplitude A between a survivor and a
//! failure, this scan simulates lower amplitudes too. A failure that it finds becomes the new upper end, and the
//! search brackets anew below it. Amplitudes are points of a logarithmic grid ([`super::amplitude_grid`]).
//!
//! With `search.monotonicity_scan = "full"` every point of the grid is simulated; with `"off"` none, unless no survivor is
//! known below the lowest failure. The rest of this text is about `"sampled"`.
//!
//! Below the amplitude at which the disk first touches the ramp the scene without a ramp has the same answer. Where
//! that amplitude and that answer are known, the scan ends there, and its steps are those of `search.scan_gap_pct`
//! ([`Scan::gap`]). Elsewhere it goes on to the lower end of the study's range: with these steps from A to A/√2, and below
//! that with steps that double each time. Without a ramp, where no such failures are expected, the first step is
//! `gap` and each one below is four times the one before. The column `largest_gap_pct` of the results gives the largest
//! step, in per cent of the amplitude.
//!
//! As long as the steps are those of the gap, neighbouring pulse widths do not scan the same amplitudes: one is shifted
//! against the other by 0.618 of the gap. Failures in a range of amplitudes at several widths are thus met by finer steps
//! than at one. Amplitudes that the search has simulated already are not simulated again.

use super::evidence::{AmplitudeVerdict, Evidence};

/// A step is complete that is missed by rounding alone.
const ROUNDING: f64 = 1e-9;
/// No range holds more grid points than this.
const WIDEST: i32 = 1 << 28;

/// Scan of one point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scan {
    /// Largest step, grid steps.
    pub gap: i32,
    /// Residue of the scanned grid points modulo the gap.
    pub phase: i32,
    /// Grid steps over which the gap is kept when nothing bounds the scan from below, and the factor by which every
    /// step below grows; `None` keeps the gap everywhere.
    pub keep: Option<(i32, i32)>,
    /// Lowest grid point that may be tested.
    pub lowest: i32,
}

impl Scan {
    /// Residue of a width's grid points: multiples of the golden ratio fall as far apart as can be.
    pub(super) fn phase_of(width_rank: usize, gap: i32) -> i32 {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let share = ((width_rank + 1) as f64 * GOLDEN).fract();
        (share * f64::from(gap)) as i32
    }

    /// Next grid point to test going down from `top` (a survivor, or a failure without survivor below).
    pub(super) fn next(&self, evidence: &Evidence, top: i32) -> Option<i32> {
        // In a scan of every grid point, all that is done is found at once.
        let mut at = match self.gap {
            1 => evidence.unbroken_below(top, self.lowest),
            _ => top,
        };
        loop {
            let gap = self.gap_at(top - at);
            // The grid point below the lower limit is answered without a run. An undecided one bridges nothing: below
            // one that ends the scan the limit itself is tested.
            if at - gap < self.lowest {
                let is_sound = evidence.get(at) != Some(AmplitudeVerdict::Undecided) || at == top;
                let is_left = at > self.lowest && evidence.get(self.lowest).is_none();
                return (!is_sound && is_left).then_some(self.lowest);
            }
            match highest_use(evidence, at - gap, at) {
                Some(known) => at = known,
                None => return Some(self.grid_point_below(at, gap)),
            }
        }
    }

    fn gap_at(&self, depth: i32) -> i32 {
        match self.keep {
            // The steps below `keep` are a geometric series; the depth gives the next one.
            Some((keep, growth)) if depth >= keep => {
                let first = f64::from(self.gap * growth);
                let grown = f64::from(depth - keep) * f64::from(growth - 1) / first + 1.0;
                let steps = grown.log(f64::from(growth)) + ROUNDING;
                let share = f64::from(growth).powi(steps as i32);
                (first * share).min(f64::from(WIDEST)) as i32
            }
            _ => self.gap,
        }
    }

    /// The scanned grid point within `gap` below `at`.
    fn grid_point_below(&self, at: i32, gap: i32) -> i32 {
        if gap == self.gap {
            at - 1 - (at - 1 - self.phase).rem_euclid(self.gap)
        } else {
            at - gap
        }
    }
}

/// Lowest known survivor in `low..at`; an undecided grid point only when there is no survivor.
fn highest_use(evidence: &Evidence, low: i32, at: i32) -> Option<i32> {
    let known = |verdict| evidence.lowest_with(verdict, low..at);
    known(AmplitudeVerdict::Survives).or_else(|| known(AmplitudeVerdict::Undecided))
}
