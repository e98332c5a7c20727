//! Error bars of points whose search is final, drawn as far as the runs known allow.

use super::jobs::Job;
use super::searches::{Ledger, Told};
use super::stage::{BarStage, bar_asked, bar_probe, seen};
use crate::search::{Flag, Status, Verdict, bar};
use crate::store::RunKey;
use opshock_solver::scene::knob::Levels;

impl Ledger<'_> {
    /// Takes error bars as far as the runs known allow: those that wait for the run `finished`, or
    /// all, and those whose search has become final. Says which runs were used first now.
    pub(super) fn draw_bars(&mut self, finished: Option<RunKey>) -> Vec<Told> {
        let mut told = Vec::new();
        let n_final_chains = self.campaign.n_final_chains();
        let places: Vec<usize> = if n_final_chains == self.n_final_chains {
            self.drawing.values().copied().collect()
        } else {
            (0..self.input.points.len()).collect()
        };
        self.n_final_chains = n_final_chains;
        for point in places {
            match &self.bars[point] {
                BarStage::Waiting if self.campaign.is_final(point) => {
                    self.bars[point] = self.first_stage(point);
                    self.n_changes += 1;
                }
                BarStage::Begun {
                    progress: bar::Progress::Wants(ask),
                    ..
                } => {
                    let wanted = self.key(point, bar_probe(*ask));
                    if finished.is_some_and(|key| key != wanted) {
                        continue;
                    }
                }
                _ => continue,
            }
            let BarStage::Begun { input, log, .. } = &self.bars[point] else {
                continue;
            };
            let lookup = |ask: bar::Ask| {
                let record = self.runs.get(&self.key(point, bar_probe(ask)))?;
                Some(seen(&record.result))
            };
            let climbs = self.climbs(point);
            let (now, progress) = bar::answer(input, climbs, &lookup);
            told.extend(now[log.len()..].iter().map(|&ask| Told {
                point,
                asked: bar_asked(ask),
                key: self.key(point, bar_probe(ask)),
            }));
            if let BarStage::Begun {
                log,
                progress: before,
                ..
            } = &mut self.bars[point]
            {
                if matches!(progress, bar::Progress::Wants(_)) {
                    self.drawing.insert(self.rank[point], point);
                } else {
                    self.drawing.remove(&self.rank[point]);
                    self.n_changes += 1;
                }
                (*log, *before) = (now, progress);
            }
        }
        told
    }

    /// Changes whenever a point becomes final.
    pub(in crate::sweep) fn n_changes(&self) -> u64 {
        self.n_changes
    }

    /// Stage of a bar when the point's search has become final.
    pub(super) fn first_stage(&self, point: usize) -> BarStage {
        let companion = self.campaign.order().relations[point].companion;
        let is_taken = self.campaign.findings(point).flags.contains(&Flag::NoTouch);
        if let Some(companion) = companion.filter(|_| is_taken) {
            return BarStage::Taken { companion };
        }
        match self.bar_input(point) {
            None => BarStage::Without,
            Some(input) => {
                // Its first look: nothing is known yet of what it will ask.
                let (_, progress) = bar::answer(&input, self.climbs(point), &|_| None);
                BarStage::Begun {
                    input: Box::new(input),
                    log: Vec::new(),
                    progress,
                }
            }
        }
    }

    /// Times that a point may be turned finer.
    pub(super) fn climbs(&self, point: usize) -> u8 {
        let plan = self.input.points[point].bar.as_ref();
        plan.map_or(0, |plan| plan.climbs)
    }

    /// What the bar of a point with a final search starts from; `None` without a bracket of its
    /// own.
    pub(super) fn bar_input(&self, point: usize) -> Option<bar::BarInput> {
        let plan = self.input.points[point].bar.as_ref()?;
        let findings = self.campaign.findings(point);
        if findings.status != Status::Ok {
            return None;
        }
        let (survivor, failure) = (findings.survivor?, findings.failure?);
        let mut survivors = Vec::new();
        let mut t_fail_s = None;
        for asked in self.campaign.search(point)?.log() {
            if asked.probe.window_factor != 1 {
                continue;
            }
            let index = asked.probe.index * bar::SUBNODES;
            let result = &self.runs[&self.key(point, asked.probe)].result;
            match &result.verdict {
                Verdict::Fails {
                    t_fail_s: time_s, ..
                } if asked.probe.index == failure => {
                    t_fail_s = Some(*time_s);
                }
                Verdict::Survives => {
                    if let (Some(h_min_m), Some(t_min_s)) = (result.h_min_m, result.t_min_s) {
                        survivors.push(bar::Known {
                            index,
                            h_min_m,
                            t_min_s,
                        });
                    }
                }
                Verdict::Fails { .. } | Verdict::Undecided { .. } => {}
            }
        }
        Some(bar::BarInput {
            base: Levels::NONE,
            lattice: self.input.settings.lattice.finer(bar::SUBNODES),
            survivor: survivor * bar::SUBNODES,
            failure: failure * bar::SUBNODES,
            t_fail_s,
            survivors,
            knobs: plan.knobs.clone(),
            film_halvings: plan.film_halvings,
            mesh_halvings: plan.mesh_halvings,
            holds_films: plan.holds_films,
            accuracy: plan.accuracy,
        })
    }

    /// A point has its final answer and its error bar.
    pub(in crate::sweep) fn is_final(&self, point: usize) -> bool {
        match &self.bars[point] {
            BarStage::Waiting => false,
            BarStage::Without => true,
            BarStage::Taken { companion } => self.is_final(*companion),
            BarStage::Begun { progress, .. } => matches!(progress, bar::Progress::Done(_)),
        }
    }

    /// Runs that the error bar of a point has used, climbs and all, and whether it is done; `None`
    /// where it has not begun.
    pub(in crate::sweep) fn bar_runs(&self, point: usize) -> Option<(usize, bool)> {
        match &self.bars[point] {
            BarStage::Begun { log, .. } => Some((log.len(), self.is_final(point))),
            _ => None,
        }
    }

    /// The bar of a point is wanted: its own, or that of a point which takes it over.
    pub(super) fn wants_bar(&self, point: usize) -> bool {
        self.part.allowed[point] && (self.wants(point) || (0..self.bars.len()).any(|other| {
            self.wants(other)
                && matches!(self.bars[other], BarStage::Taken { companion } if companion == point)
        }))
    }

    pub(super) fn bar_job(&self) -> Option<Job> {
        self.drawing.values().find_map(|&point| {
            let BarStage::Begun {
                progress: bar::Progress::Wants(ask),
                ..
            } = self.bars[point]
            else {
                return None;
            };
            let key = self.key(point, bar_probe(ask));
            (!self.in_flight.contains(&key) && self.wants_bar(point)).then_some(Job::Run {
                point,
                asked: bar_asked(ask),
                key,
            })
        })
    }

    /// Answer of a point with its bar, once it is finished, and the runs it took.
    pub(super) fn finished_bar(&self, point: usize) -> Option<(&bar::Answer, u64)> {
        match &self.bars[point] {
            BarStage::Taken { companion } => Some((self.finished_bar(*companion)?.0, 0)),
            BarStage::Begun {
                log,
                progress: bar::Progress::Done(answer),
                ..
            } => Some((answer, log.len() as u64)),
            _ => None,
        }
    }
}
