//! The next job of a thread: a request of a search, else what will probably be requested.

use super::searches::Registry;
use crate::search::lookahead::{self, Lookup};
use crate::search::{Asked, PointSearch, Probe};
use crate::store::RunKey;

/// Work a thread can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::sweep) enum Job {
    /// Amplitude of first touch of a point.
    Onset {
        /// Place in the study.
        point: usize,
    },
    /// A simulation.
    Run {
        /// Place in the study.
        point: usize,
        /// Probe.
        asked: Asked,
        /// Its identity.
        key: RunKey,
    },
}

impl Registry<'_> {
    /// The best free job of those that `fits` admits: a request of a search, else what one will probably request, so that
    /// all brackets come first; then a run of an uncertainty interval.
    pub(in crate::sweep) fn next_job(
        &mut self,
        speculate: bool,
        fits: &dyn Fn(&Job) -> bool,
    ) -> Option<Job> {
        let speculates = speculate && !self.campaign.is_done();
        let asked = self.asked_job(fits);
        let likely = || speculates.then(|| self.likely_job()).flatten();
        let job = asked
            .or_else(|| likely().filter(fits))
            .or_else(|| self.uncertainty_job(fits))?;
        match job {
            Job::Onset { point } => {
                self.onsets_in_flight
                    .insert(self.input.points[point].digest);
            }
            Job::Run { key, .. } => {
                self.in_flight.insert(key);
            }
        }
        Some(job)
    }

    fn asked_job(&mut self, fits: &dyn Fn(&Job) -> bool) -> Option<Job> {
        let sequence = &self.campaign.order().sequence;
        let is_touched = |place: usize| self.campaign.touch(place).is_some();
        let touched = sequence[self.n_touched..].iter();
        self.n_touched += touched.take_while(|&&place| is_touched(place)).count();
        let onset = sequence[self.n_touched..].iter().copied().find(|&place| {
            let digest = &self.input.points[place].digest;
            !is_touched(place) && !self.onsets_in_flight.contains(digest)
        });
        if let Some(point) = onset {
            return Some(Job::Onset { point });
        }
        // Wanted points first: another process may be about to answer the rest.
        [true, false].into_iter().find_map(|is_own| {
            let mut asking = self.asking.values();
            let &(point, asked, key) = asking.find(|&&(point, asked, key)| {
                self.part.allowed[point]
                    && self.wants(point) == is_own
                    && !self.in_flight.contains(&key)
                    && fits(&Job::Run { point, asked, key })
            })?;
            Some(Job::Run { point, asked, key })
        })
    }

    fn likely_job(&self) -> Option<Job> {
        /// Probability that the companion of a point does not answer for it.
        const OWN_ANSWER: f64 = 0.9;
        let mut best: Option<(f64, Job)> = None;
        for &point in self.urgency.iter().filter(|&&point| self.wants(point)) {
            let waiting: Option<PointSearch>;
            let (search, chance) = match self.campaign.search(point) {
                Some(search) => (search, 1.0),
                None => {
                    waiting = self.campaign.likely_search(point);
                    match &waiting {
                        Some(search) => (search, OWN_ANSWER),
                        None => continue,
                    }
                }
            };
            let lookup = |probe: Probe| {
                let key = self.key(point, probe);
                match self.runs.get(&key) {
                    Some(record) => {
                        Lookup::Known(record.result.verdict.clone(), record.result.h_min_m)
                    }
                    None if self.in_flight.contains(&key) => Lookup::Running,
                    None => Lookup::Free,
                }
            };
            if let Some(found) = lookahead::candidates(search, chance, 1, &lookup).first()
                && best.is_none_or(|(likelihood, _)| found.likelihood > likelihood)
            {
                let asked = Asked {
                    probe: found.probe,
                    purpose: found.purpose,
                };
                let job = Job::Run {
                    point,
                    asked,
                    key: self.key(point, found.probe),
                };
                best = Some((found.likelihood, job));
            }
        }
        best.map(|(_, job)| job)
    }
}
