//! Evidence about a point: amplitudes with their verdicts.

use std::collections::BTreeMap;

/// Verdict of a grid point after all its retries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AmplitudeVerdict {
    /// Survives.
    Survives,
    /// Fails.
    Fails,
    /// No verdict, whatever was tried.
    Undecided,
}

/// Grid points tested, by index. Every verdict is kept; survival need not be monotone.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Evidence {
    grid_points: BTreeMap<i32, AmplitudeVerdict>,
    /// Of these the lowest that fails, and the number without verdict: needed at every probe.
    lowest_failure: Option<i32>,
    n_undecided: usize,
    /// Smallest clearances of survivors, bits of metres.
    clearances: BTreeMap<i32, u64>,
}

impl Evidence {
    /// Records a grid point.
    pub fn insert(&mut self, index: i32, verdict: AmplitudeVerdict) {
        let before = self.grid_points.insert(index, verdict);
        self.n_undecided += usize::from(verdict == AmplitudeVerdict::Undecided);
        self.n_undecided -= usize::from(before == Some(AmplitudeVerdict::Undecided));
        let is_lower = self.lowest_failure.is_none_or(|lowest| index < lowest);
        if verdict == AmplitudeVerdict::Fails && is_lower {
            self.lowest_failure = Some(index);
        } else if self.lowest_failure == Some(index) && verdict != AmplitudeVerdict::Fails {
            let fails =
                |(_, verdict): &(&i32, &AmplitudeVerdict)| **verdict == AmplitudeVerdict::Fails;
            self.lowest_failure = self.grid_points.iter().find(fails).map(|(&index, _)| index);
        }
    }

    /// Records the smallest clearance, m, of a grid point that survives.
    pub fn insert_clearance(&mut self, index: i32, h_min_m: f64) {
        self.clearances.insert(index, h_min_m.to_bits());
    }

    /// All grid points tested, ascending, with the smallest clearances of survivors, m.
    pub fn all(&self) -> impl Iterator<Item = (i32, AmplitudeVerdict, Option<f64>)> + '_ {
        let clearance = |index| self.clearances.get(index).copied().map(f64::from_bits);
        let all = self.grid_points.iter();
        all.map(move |(index, &verdict)| (*index, verdict, clearance(index)))
    }

    /// Where the clearance of the two highest survivors below `limit` (exclusive) would fall to `fail_below_m` on a straight
    /// line, in grid steps; `None` when it does not fall, or one of the two has none.
    pub fn failing_point(&self, limit: Option<i32>, fail_below_m: f64) -> Option<f64> {
        let high = self.highest_survivor_below(limit)?;
        let low = self.highest_survivor_below(Some(high))?;
        let clearance = |index| self.clearances.get(&index).copied().map(f64::from_bits);
        let (h_low, h_high) = (clearance(low)?, clearance(high)?);
        let slope = (h_low - h_high) / f64::from(high - low);
        let left = h_high - fail_below_m;
        (slope > 0.0 && left >= 0.0).then(|| f64::from(high) + left / slope)
    }

    /// Verdict of a grid point, if tested.
    pub fn get(&self, index: i32) -> Option<AmplitudeVerdict> {
        self.grid_points.get(&index).copied()
    }

    /// Nothing was tested.
    pub fn is_empty(&self) -> bool {
        self.grid_points.is_empty()
    }

    /// Highest tested grid point, decided or not.
    pub fn top(&self) -> Option<i32> {
        self.grid_points.keys().next_back().copied()
    }

    /// Lowest tested grid point, decided or not.
    pub fn bottom(&self) -> Option<i32> {
        self.grid_points.keys().next().copied()
    }

    /// Lowest failing grid point.
    pub fn lowest_failure(&self) -> Option<i32> {
        self.lowest_failure
    }

    /// Lowest grid point of `grid_points` with a verdict.
    pub fn lowest_with(
        &self,
        verdict: AmplitudeVerdict,
        grid_points: std::ops::Range<i32>,
    ) -> Option<i32> {
        let known = self.grid_points.range(grid_points);
        let mut with = known.filter(|(_, known)| **known == verdict);
        with.next().map(|(&index, _)| index)
    }

    /// Lowest grid point, not below `lowest`, down to which every one below `top` is known and none fails.
    pub fn unbroken_below(&self, top: i32, lowest: i32) -> i32 {
        let mut at = top;
        for (&index, verdict) in self.grid_points.range(lowest.min(top)..top).rev() {
            if index != at - 1 || *verdict == AmplitudeVerdict::Fails {
                break;
            }
            at = index;
        }
        at
    }

    /// Highest survivor below `limit` (exclusive), of all grid points when there is no limit.
    pub fn highest_survivor_below(&self, limit: Option<i32>) -> Option<i32> {
        let below = match limit {
            Some(limit) => self.grid_points.range(..limit),
            None => self.grid_points.range(..),
        };
        below
            .rev()
            .find(|(_, verdict)| **verdict == AmplitudeVerdict::Survives)
            .map(|(index, _)| *index)
    }

    /// Undecided grid points strictly between two grid points, ascending.
    pub fn undecided_between(&self, low: i32, high: i32) -> Vec<i32> {
        if low + 1 >= high {
            return Vec::new();
        }
        self.grid_points
            .range(low + 1..high)
            .filter(|(_, verdict)| **verdict == AmplitudeVerdict::Undecided)
            .map(|(index, _)| *index)
            .collect()
    }

    /// Number of undecided grid points.
    pub fn n_undecided(&self) -> usize {
        self.n_undecided
    }

    /// Every (survivor, next higher decided grid point that fails), ascending.
    pub fn brackets(&self) -> Vec<(i32, i32)> {
        let mut brackets = Vec::new();
        let mut survivor = None;
        for (&index, verdict) in &self.grid_points {
            match verdict {
                AmplitudeVerdict::Survives => survivor = Some(index),
                AmplitudeVerdict::Fails => {
                    if let Some(low) = survivor.take() {
                        brackets.push((low, index));
                    }
                }
                AmplitudeVerdict::Undecided => {}
            }
        }
        brackets
    }

    /// A survivor lies above a failure.
    pub fn is_non_monotone(&self) -> bool {
        match (self.lowest_failure(), self.highest_survivor_below(None)) {
            (Some(failure), Some(survivor)) => survivor > failure,
            _ => false,
        }
    }

    /// The lowest failure and the last grid point before the next higher survivor: where the lowest non-monotone
    /// interval lies.
    pub fn non_monotone_interval(&self) -> Option<(i32, i32)> {
        let low = self.lowest_failure()?;
        let top = self.top()?;
        let above = self
            .grid_points
            .range(low..)
            .find(|(_, verdict)| **verdict == AmplitudeVerdict::Survives)
            .map_or(top, |(index, _)| index - 1);
        Some((low, above))
    }

    /// Largest step between neighbouring survivors from `low` up to `high`, grid steps.
    ///
    /// `low` is a survivor here, tested or not.
    pub fn largest_gap(&self, low: i32, high: i32) -> i32 {
        let mut last = low;
        let mut largest = 0;
        for (&index, verdict) in self.grid_points.range(low..=high) {
            if *verdict == AmplitudeVerdict::Survives {
                largest = largest.max(index - last);
                last = index;
            }
        }
        largest.max(high - last)
    }

    /// Lowest survivor.
    pub fn lowest_survivor(&self) -> Option<i32> {
        self.grid_points
            .iter()
            .find(|(_, verdict)| **verdict == AmplitudeVerdict::Survives)
            .map(|(index, _)| *index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_that_replaces_another_counts_once() {
        let mut evidence = Evidence::default();
        for (index, verdict) in [
            (7, AmplitudeVerdict::Fails),
            (3, AmplitudeVerdict::Undecided),
            (5, AmplitudeVerdict::Fails),
        ] {
            evidence.insert(index, verdict);
        }
        assert_eq!(
            (evidence.lowest_failure(), evidence.n_undecided()),
            (Some(5), 1)
        );
        evidence.insert(3, AmplitudeVerdict::Survives);
        evidence.insert(5, AmplitudeVerdict::Survives);
        assert_eq!(
            (evidence.lowest_failure(), evidence.n_undecided()),
            (Some(7), 0)
        );
        assert_eq!(
            evidence.lowest_with(AmplitudeVerdict::Survives, 4..9),
            Some(5)
        );
        assert_eq!(evidence.lowest_with(AmplitudeVerdict::Fails, 0..7), None);
        evidence.insert(6, AmplitudeVerdict::Undecided);
        let below = |top, lowest| evidence.unbroken_below(top, lowest);
        assert_eq!(
            [below(7, 0), below(7, 6), below(8, 0), below(4, 9)],
            [5, 6, 8, 4]
        );
    }
}
