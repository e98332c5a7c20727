//! What a search knows before it begins, from the same point with a smaller clearance called failure.
//!
//! The motion of both is the same up to the failure. What fails at the smaller clearance fails at the larger one, and a
//! survivor fails there whose smallest clearance lies below it.

use super::evidence::AmplitudeVerdict;
use super::point::{KnownVerdict, PointSearch};
use super::probe::{Purpose, Retry};

impl PointSearch {
    /// The same search beginning with what a smaller clearance called failure has for its grid points: whatever fails there
    /// fails here, and earlier.
    #[must_use]
    pub fn knowing(mut self, known: &[KnownVerdict]) -> PointSearch {
        let range = self.grid_points.low..=self.grid_points.high;
        let own = known.iter().filter(|one| range.contains(&one.index));
        self.known = own.map(|one| one.index).collect();
        for one in known.iter().filter(|one| range.contains(&one.index)) {
            let limit_m = self.bracketing.fail_below_m;
            match one.h_min_m.filter(|&h_min_m| h_min_m >= limit_m) {
                Some(h_min_m) => {
                    let verdict = AmplitudeVerdict::Survives;
                    self.evidence.insert(one.index, verdict);
                    self.evidence.insert_clearance(one.index, h_min_m);
                }
                None => self.evidence.insert(one.index, AmplitudeVerdict::Fails),
            }
        }
        if let Some(failure) = self.evidence.lowest_failure()
            && self
                .evidence
                .highest_survivor_below(Some(failure))
                .is_none()
        {
            self.bracketing.begin_at(failure);
        }
        self.note_bracket();
        self
    }

    /// Grid points whose verdicts were known before it began.
    pub fn known(&self) -> &[i32] {
        &self.known
    }

    /// What its grid points say to a search that calls a larger clearance failure. Those without verdict, survivors without
    /// clearance, and those that took more than a plain run say nothing.
    pub fn known_for_larger(&self) -> Vec<KnownVerdict> {
        let is_plain = |index: i32| {
            let mut of_index = self.log.iter().filter(|asked| asked.probe.index == index);
            of_index.all(|asked| asked.probe.retry == Retry::None)
        };
        let one = |(index, verdict, h_min_m): (i32, AmplitudeVerdict, Option<f64>)| {
            let fails = verdict == AmplitudeVerdict::Fails;
            let says = fails || (verdict == AmplitudeVerdict::Survives && h_min_m.is_some());
            (says && is_plain(index)).then_some(KnownVerdict { index, h_min_m })
        };
        self.evidence.all().filter_map(one).collect()
    }

    /// An end of the bracket that is known from another point: the failure's time and place only a run of this point has.
    pub(super) fn next_own_run(&self) -> Option<(i32, u8, Purpose)> {
        if self.known.is_empty() {
            return None;
        }
        let ends = [self.evidence.lowest_failure(), self.survivor()];
        ends.into_iter().flatten().find_map(|index| {
            let mut asked = self.log.iter().map(|asked| asked.probe);
            let is_own = asked.any(|probe| probe.index == index && probe.window_factor == 1);
            (self.known.contains(&index) && !is_own).then_some((index, 1, Purpose::OwnRun))
        })
    }
}
