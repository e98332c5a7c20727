//! Uncertainty intervals of points whose search is final, advanced as far as the known runs allow.

use super::interval_order::interval_ranks;
use super::jobs::Job;
use super::searches::{AnsweredProbe, Registry};
use super::stage::{Depth, UncertaintyStage, seen, uncertainty_asked, uncertainty_probe};
use crate::search::{Campaign, Flag, Probe, ProbeResult, Status, Verdict, uncertainty};
use crate::store::RunKey;
use crate::sweep::input::SweepInput;
use opshock_solver::scene::discretisation::Levels;

/// An interval that has begun.
pub(in crate::sweep) struct Begun<'a> {
    /// What it starts from.
    pub(in crate::sweep) input: &'a uncertainty::UncertaintyInput,
    /// Runs that it has used.
    pub(in crate::sweep) log: &'a [uncertainty::Ask],
    /// All is known.
    pub(in crate::sweep) is_done: bool,
}

impl Registry<'_> {
    /// Advances uncertainty intervals as far as the known runs allow: those that wait for the run `finished`, or all,
    /// and those whose search has become final. Returns the runs used for the first time.
    pub(super) fn draw_uncertainty(&mut self, finished: Option<RunKey>) -> Vec<AnsweredProbe> {
        let mut answered = self.advance_uncertainty(finished, &[]);
        loop {
            let round = self.begin_round();
            if round.is_empty() {
                return answered;
            }
            answered.extend(self.advance_uncertainty(None, &round));
        }
    }

    /// The same within a round; `further` are points that may be refined once more than before.
    fn advance_uncertainty(
        &mut self,
        finished: Option<RunKey>,
        further: &[usize],
    ) -> Vec<AnsweredProbe> {
        let mut answered = Vec::new();
        let n_final_chains = self.campaign.n_final_chains();
        let places: Vec<usize> = if !further.is_empty() {
            further.to_vec()
        } else if n_final_chains == self.n_final_chains {
            self.drawing.values().copied().collect()
        } else {
            (0..self.input.points.len()).collect()
        };
        self.n_final_chains = n_final_chains;
        if self.campaign.is_done() && !self.are_intervals_ranked {
            self.are_intervals_ranked = true;
            self.interval_rank = interval_ranks(self.input, &self.campaign, &self.rank);
            let waiting: Vec<usize> = self.drawing.values().copied().collect();
            let ranked = waiting.into_iter();
            self.drawing = ranked
                .map(|point| (self.interval_rank[point], point))
                .collect();
        }
        for point in places {
            match &self.uncertainties[point] {
                UncertaintyStage::Waiting if self.campaign.is_final(point) => {
                    self.uncertainties[point] = self.first_stage(point);
                    self.n_changes += 1;
                }
                UncertaintyStage::Begun {
                    progress: uncertainty::Progress::Done(_),
                    ..
                } if further.contains(&point) => {}
                UncertaintyStage::Begun {
                    progress: uncertainty::Progress::Wants(ask),
                    ..
                } => {
                    let wanted = self.key(point, uncertainty_probe(*ask));
                    if finished.is_some_and(|key| key != wanted) {
                        continue;
                    }
                }
                _ => continue,
            }
            let UncertaintyStage::Begun { input, log, .. } = &self.uncertainties[point] else {
                continue;
            };
            if self.depths[point] == Depth::Bracket {
                continue;
            }
            let fail_below_m = self.input.points[point].coordinates.fail_below_m;
            let lookup = |ask: uncertainty::Ask| {
                let record = self.runs.get(&self.key(point, uncertainty_probe(ask)))?;
                Some(seen(&record.result, fail_below_m))
            };
            let refinements = self.refinements(point);
            let (now, mut progress) = uncertainty::answer(input, refinements, &lookup);
            if let uncertainty::Progress::Done(answer) = &mut progress
                && self.is_refinable(point)
            {
                // It is not the number of refinements that ends here.
                answer.uncertainty.flags.remove(&Flag::RefinementLimit);
            }
            answered.extend(now[log.len()..].iter().map(|&ask| AnsweredProbe {
                point,
                asked: uncertainty_asked(ask),
                key: self.key(point, uncertainty_probe(ask)),
            }));
            if let UncertaintyStage::Begun {
                log,
                progress: before,
                ..
            } = &mut self.uncertainties[point]
            {
                if matches!(progress, uncertainty::Progress::Wants(_)) {
                    self.drawing.insert(self.interval_rank[point], point);
                } else {
                    self.drawing.remove(&self.interval_rank[point]);
                    self.n_changes += 1;
                }
                (*log, *before) = (now, progress);
            }
        }
        answered
    }

    /// Changes whenever a point becomes final.
    pub(in crate::sweep) fn n_changes(&self) -> u64 {
        self.n_changes
    }

    /// Stage of an interval when the point's search has become final.
    pub(super) fn first_stage(&self, point: usize) -> UncertaintyStage {
        let companion = self.campaign.order().relations[point].companion;
        let is_taken = self.campaign.findings(point).flags.contains(&Flag::NoTouch);
        if let Some(companion) = companion.filter(|_| is_taken) {
            return UncertaintyStage::Taken { companion };
        }
        match self.uncertainty_input(point) {
            None => UncertaintyStage::Without,
            Some(input) => {
                // Its first evaluation: its requests are not known yet.
                let (_, progress) = uncertainty::answer(&input, self.refinements(point), &|_| None);
                UncertaintyStage::Begun {
                    input: Box::new(input),
                    log: Vec::new(),
                    progress,
                }
            }
        }
    }

    /// Largest number of adaptive refinements of a point so far.
    pub(in crate::sweep) fn refinements(&self, point: usize) -> u8 {
        self.depths[point].refinements().unwrap_or(0)
    }

    /// A later round may refine the point once more.
    fn is_refinable(&self, point: usize) -> bool {
        let plan = self.input.points[point].uncertainty.as_ref();
        plan.is_some_and(|plan| self.refinements(point) < plan.refinements)
    }

    /// What the interval of a point with a final search starts from; `None` without a bracket of its
    /// own.
    pub(super) fn uncertainty_input(&self, point: usize) -> Option<uncertainty::UncertaintyInput> {
        interval_input(self.input, &self.campaign, point, &|probe| {
            let own = self.runs.get(&self.key(point, probe));
            own.map(|record| record.result.clone())
                .or_else(|| Some(self.same_elsewhere(point, probe)?.result))
        })
    }

    /// A point has its final answer and, where it is to have one, its uncertainty interval.
    pub(in crate::sweep) fn is_final(&self, point: usize) -> bool {
        self.is_decided && self.is_at_depth(point)
    }

    /// The uncertainty of a point is known as far as it is wanted so far.
    pub(super) fn is_at_depth(&self, point: usize) -> bool {
        match &self.uncertainties[point] {
            UncertaintyStage::Waiting => false,
            UncertaintyStage::Without => true,
            UncertaintyStage::Taken { companion } => self.is_at_depth(*companion),
            UncertaintyStage::Begun { progress, .. } => {
                self.depths[point] == Depth::Bracket
                    || matches!(progress, uncertainty::Progress::Done(_))
            }
        }
    }

    /// The uncertainty interval of a point as far as it has got; `None` where it has not begun.
    pub(in crate::sweep) fn interval(&self, point: usize) -> Option<Begun<'_>> {
        match &self.uncertainties[point] {
            UncertaintyStage::Begun { input, log, .. } if self.depths[point] != Depth::Bracket => {
                Some(Begun {
                    input,
                    log,
                    is_done: self.is_at_depth(point),
                })
            }
            _ => None,
        }
    }

    /// The interval of a point is wanted: its own, or that of a point which takes it over.
    pub(super) fn wants_uncertainty(&self, point: usize) -> bool {
        // The answer that decides is that of all points, whoever completes them.
        self.part.allowed[point] && (self.input.decides.is_some() || self.wants(point) || (0..self.uncertainties.len()).any(|other| {
            self.wants(other)
                && matches!(self.uncertainties[other], UncertaintyStage::Taken { companion } if companion == point)
        }))
    }

    pub(super) fn uncertainty_job(&self, fits: &dyn Fn(&Job) -> bool) -> Option<Job> {
        self.drawing.values().find_map(|&point| {
            let UncertaintyStage::Begun {
                progress: uncertainty::Progress::Wants(ask),
                ..
            } = self.uncertainties[point]
            else {
                return None;
            };
            let key = self.key(point, uncertainty_probe(ask));
            let job = Job::Run {
                point,
                asked: uncertainty_asked(ask),
                key,
            };
            let is_free = !self.in_flight.contains(&key) && self.wants_uncertainty(point);
            (is_free && fits(&job)).then_some(job)
        })
    }

    /// Answer of a point with its interval, once it is finished, and the runs it took.
    pub(in crate::sweep) fn finished_uncertainty(
        &self,
        point: usize,
    ) -> Option<(&uncertainty::Answer, u64)> {
        match &self.uncertainties[point] {
            UncertaintyStage::Taken { companion } => {
                Some((self.finished_uncertainty(*companion)?.0, 0))
            }
            UncertaintyStage::Begun {
                log,
                progress: uncertainty::Progress::Done(answer),
                ..
            } => Some((answer, log.len() as u64)),
            _ => None,
        }
    }
}

/// What the interval of a point with a final search starts from, by the results of its probes as far as they have one;
/// `None` without a bracket of its own.
pub(in crate::sweep) fn interval_input(
    input: &SweepInput,
    campaign: &Campaign,
    point: usize,
    result: &dyn Fn(Probe) -> Option<ProbeResult>,
) -> Option<uncertainty::UncertaintyInput> {
    let plan = input.points[point].uncertainty.as_ref()?;
    let findings = campaign.findings(point);
    if findings.status != Status::Ok {
        return None;
    }
    let (survivor, failure) = (findings.survivor?, findings.failure?);
    let mut survivors = Vec::new();
    let mut t_fail_s = None;
    let fail_below_m = input.points[point].coordinates.fail_below_m;
    let search = campaign.search(point)?;
    let known = search.known().iter().map(|&index| Probe::at(index));
    let own = search.log().iter().map(|asked| asked.probe);
    for probe in known.chain(own.filter(|probe| probe.window_factor == 1)) {
        let index = probe.index * uncertainty::SUBDIVISIONS;
        // Of a failure known from elsewhere there is no run of this point.
        let Some(result) = result(probe) else {
            continue;
        };
        match &result.verdict {
            Verdict::Fails {
                t_fail_s: time_s, ..
            } if probe.index == failure => {
                t_fail_s = Some(*time_s);
            }
            Verdict::Survives => {
                if let (Some(h_min_m), Some(t_min_s)) = (result.h_min_m, result.t_min_s) {
                    survivors.push(uncertainty::Known {
                        index,
                        h_min_m: h_min_m - fail_below_m,
                        t_min_s,
                    });
                }
            }
            Verdict::Fails { .. } | Verdict::Undecided { .. } => {}
        }
    }
    Some(uncertainty::UncertaintyInput {
        base: Levels::NONE,
        grid: input.settings.grid.finer(uncertainty::SUBDIVISIONS),
        survivor: survivor * uncertainty::SUBDIVISIONS,
        failure: failure * uncertainty::SUBDIVISIONS,
        t_fail_s,
        survivors,
        discretisations: plan.discretisations.clone(),
        film_halvings: plan.film_halvings,
        mesh_halvings: plan.mesh_halvings,
        hard_contact: plan.hard_contact,
        below_continuum: input.points[point].below_continuum,
        target: plan.target,
    })
}
