//! The searches of a study with every simulation finished so far: answers what the searches ask
//! from what is known, and reads table and runs from them.

use std::collections::{BTreeMap, HashMap, HashSet};

use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2, m_per_s2_from_g};
use opshock_solver::scene::knob::Levels;

use super::input::SweepInput;
use super::rows;
use crate::search::evidence::NodeVerdict;
use crate::search::lookahead::{self, Lookup};
use crate::search::{
    Asked, Campaign, Flag, PointSearch, Probe, ProbeResult, Purpose, Status, Touch, Verdict, bar,
};
use crate::store::summary::{PointSummary, Summary, Totals};
use crate::store::{
    Loaded, PointDigest, PointKeep, Results, RunKey, RunRecord, RunRow, Session, StoredTouch,
    machine,
};

/// Work a thread can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Job {
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

/// A probe that a search was told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Told {
    /// Place in the study.
    pub point: usize,
    /// Probe.
    pub asked: Asked,
    /// Identity of its simulation.
    pub key: RunKey,
}

/// Searches and what is known.
pub(super) struct Ledger<'a> {
    input: &'a SweepInput,
    campaign: Campaign,
    runs: HashMap<RunKey, RunRecord>,
    touches: HashMap<PointDigest, StoredTouch>,
    in_flight: HashSet<RunKey>,
    onsets_in_flight: HashSet<PointDigest>,
    sharing: HashMap<PointDigest, Vec<usize>>,
    /// Places in the study, those with the most work behind them first.
    urgency: Vec<usize>,
    /// Rank of every place in it.
    rank: Vec<usize>,
    /// What searches ask that is not known, by rank: (place, probe, its identity).
    asking: BTreeMap<usize, (usize, Asked, RunKey)>,
    /// Places before it in the campaign's sequence have their first touch.
    n_touched: usize,
    /// Error bars as far as they have got, by place.
    bars: Vec<BarStage>,
    /// Places whose bar waits for a run, by rank.
    drawing: BTreeMap<usize, usize>,
    /// Final chains of the campaign when bars were begun last.
    n_final_chains: usize,
    /// Times that a point became final, or may have.
    n_changes: u64,
    part: Part,
}

/// What a sweep is to find, by place in the study.
struct Part {
    /// Points whose rows it is to complete.
    wanted: Vec<bool>,
    /// Points whose probes it may simulate.
    allowed: Vec<bool>,
}

/// Error bar of a point as far as it has got.
enum BarStage {
    /// The point's search is not final.
    Waiting,
    /// None is wanted, or there is no bracket.
    Without,
    /// The answer, and with it the bar, is that of the same point without ramp.
    Taken {
        /// That point.
        companion: usize,
    },
    /// Begun.
    Begun {
        input: Box<bar::BarInput>,
        log: Vec<bar::Ask>,
        progress: bar::Progress<bar::Answer>,
    },
}

impl<'a> Ledger<'a> {
    /// Ledger with what the store holds.
    pub(super) fn new(input: &'a SweepInput, loaded: Loaded) -> Ledger<'a> {
        let coordinates: Vec<_> = input.points.iter().map(|p| p.coordinates.clone()).collect();
        let campaign = Campaign::new(input.settings, &coordinates);
        let mut sharing: HashMap<PointDigest, Vec<usize>> = HashMap::new();
        for (place, point) in input.points.iter().enumerate() {
            sharing.entry(point.digest).or_default().push(place);
        }
        let urgency = urgency(&campaign);
        let mut rank = vec![0; urgency.len()];
        for (k, &point) in urgency.iter().enumerate() {
            rank[point] = k;
        }
        Ledger {
            input,
            campaign,
            runs: loaded.runs,
            touches: loaded.touches,
            in_flight: HashSet::new(),
            onsets_in_flight: HashSet::new(),
            sharing,
            urgency,
            rank,
            asking: BTreeMap::new(),
            n_touched: 0,
            bars: input.points.iter().map(|_| BarStage::Waiting).collect(),
            drawing: BTreeMap::new(),
            n_final_chains: 0,
            n_changes: 0,
            part: Part {
                wanted: vec![true; input.points.len()],
                allowed: vec![true; input.points.len()],
            },
        }
    }

    /// Completes these points alone, by place in the study.
    pub(super) fn want(&mut self, wanted: Vec<bool>) {
        self.part.wanted = wanted;
    }

    /// Simulates for these points alone from now on, by place in the study.
    pub(super) fn allow(&mut self, allowed: Vec<bool>) {
        self.part.allowed = allowed;
    }

    /// The row of a point is to be completed.
    pub(super) fn wants(&self, point: usize) -> bool {
        self.part.wanted[point]
    }

    /// The searches.
    pub(super) fn campaign(&self) -> &Campaign {
        &self.campaign
    }

    /// Simulations known.
    pub(super) fn runs(&self) -> &HashMap<RunKey, RunRecord> {
        &self.runs
    }

    /// Tells the searches everything they ask that is known; says what was told, in order.
    pub(super) fn absorb_all(&mut self) -> Vec<Told> {
        for place in 0..self.input.points.len() {
            if let Some(&touch) = self.touches.get(&self.input.points[place].digest) {
                self.campaign.set_touch(place, searched(touch));
            }
        }
        self.absorb(Vec::new())
    }

    /// Takes the amplitude of first touch; says what could be told in consequence.
    pub(super) fn touched(&mut self, digest: PointDigest, touch: StoredTouch) -> Vec<Told> {
        self.onsets_in_flight.remove(&digest);
        self.touches.entry(digest).or_insert(touch);
        // Another shard may be in a round of refinement that this one does not know yet.
        for &place in self.sharing.get(&digest).into_iter().flatten() {
            self.campaign
                .set_touch(place, searched(self.touches[&digest]));
        }
        self.absorb(Vec::new())
    }

    /// Takes a finished simulation; says what could be told in consequence.
    pub(super) fn finished(&mut self, record: RunRecord) -> Vec<Told> {
        let key = record.key;
        self.in_flight.remove(&key);
        self.runs.entry(key).or_insert(record);
        match self.sharing.get(&key.point) {
            Some(asking) => self.absorb(asking.clone()),
            // Knobs were turned: an error bar's run.
            None => self.draw_bars(Some(key)),
        }
    }

    /// Lets points ask as long as their answers are known, and the points that start by it.
    fn absorb(&mut self, mut places: Vec<usize>) -> Vec<Told> {
        let mut told = Vec::new();
        places.extend(self.campaign.take_changed());
        while let Some(point) = places.pop() {
            while let Some(asked) = self.campaign.ask(point) {
                let key = self.key(point, asked.probe);
                let Some(record) = self.runs.get(&key) else {
                    self.asking.insert(self.rank[point], (point, asked, key));
                    break;
                };
                self.asking.remove(&self.rank[point]);
                let result = &record.result;
                self.campaign
                    .tell_margin(point, &result.verdict, result.h_min_m);
                told.push(Told { point, asked, key });
                places.extend(self.campaign.take_changed());
            }
        }
        told.extend(self.draw_bars(None));
        told
    }

    /// Takes error bars as far as the runs known allow: those that wait for the run `finished`, or
    /// all, and those whose search has become final. Says which runs were used first now.
    fn draw_bars(&mut self, finished: Option<RunKey>) -> Vec<Told> {
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
    pub(super) fn n_changes(&self) -> u64 {
        self.n_changes
    }

    /// Stage of a bar when the point's search has become final.
    fn first_stage(&self, point: usize) -> BarStage {
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
    fn climbs(&self, point: usize) -> u8 {
        let plan = self.input.points[point].bar.as_ref();
        plan.map_or(0, |plan| plan.climbs)
    }

    /// What the bar of a point with a final search starts from; `None` without a bracket of its
    /// own.
    fn bar_input(&self, point: usize) -> Option<bar::BarInput> {
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
    pub(super) fn is_final(&self, point: usize) -> bool {
        match &self.bars[point] {
            BarStage::Waiting => false,
            BarStage::Without => true,
            BarStage::Taken { companion } => self.is_final(*companion),
            BarStage::Begun { progress, .. } => matches!(progress, bar::Progress::Done(_)),
        }
    }

    /// Runs that the error bar of a point has used, climbs and all, and whether it is done; `None`
    /// where it has not begun.
    pub(super) fn bar_runs(&self, point: usize) -> Option<(usize, bool)> {
        match &self.bars[point] {
            BarStage::Begun { log, .. } => Some((log.len(), self.is_final(point))),
            _ => None,
        }
    }

    /// All points have that are wanted.
    pub(super) fn is_done(&self) -> bool {
        (0..self.input.points.len()).all(|point| !self.wants(point) || self.is_final(point))
    }

    /// The bar of a point is wanted: its own, or that of a point which takes it over.
    fn wants_bar(&self, point: usize) -> bool {
        self.part.allowed[point] && (self.wants(point) || (0..self.bars.len()).any(|other| {
            self.wants(other)
                && matches!(self.bars[other], BarStage::Taken { companion } if companion == point)
        }))
    }

    fn bar_job(&self) -> Option<Job> {
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

    /// The best free job: what a search asks now, else what it will probably ask.
    pub(super) fn next_job(&mut self, speculate: bool) -> Option<Job> {
        let job = self
            .asked_job()
            .or_else(|| self.bar_job())
            .or_else(|| speculate.then(|| self.likely_job()).flatten())?;
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

    fn asked_job(&mut self) -> Option<Job> {
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
        // What is wanted first: another process may be about to answer the rest.
        [true, false].into_iter().find_map(|is_own| {
            let mut asking = self.asking.values();
            let &(point, asked, key) = asking.find(|&&(point, _, key)| {
                self.part.allowed[point]
                    && self.wants(point) == is_own
                    && !self.in_flight.contains(&key)
            })?;
            Some(Job::Run { point, asked, key })
        })
    }

    fn likely_job(&self) -> Option<Job> {
        /// Chance that the companion of a point does not answer for it.
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

    /// Identity of a probe's simulation.
    pub(super) fn key(&self, point: usize, probe: Probe) -> RunKey {
        RunKey {
            point: self.input.points[point].digest.turned(probe.levels),
            amplitude_bits: self.amplitude_m_per_s2(point, probe).to_bits(),
            window_factor: probe.window_factor,
            retry: probe.retry.level(),
        }
    }

    /// Amplitude of a probe without its sign, G.
    pub(super) fn amplitude_g(&self, probe: Probe) -> f64 {
        let lattice = self.input.settings.lattice;
        let lattice = if probe.is_fine {
            lattice.finer(bar::SUBNODES)
        } else {
            lattice
        };
        lattice.amplitude_g(probe.index)
    }

    /// Signed amplitude of a probe.
    pub(super) fn amplitude_m_per_s2(&self, point: usize, probe: Probe) -> f64 {
        let sign = self.input.points[point].coordinates.sign.factor();
        sign * m_per_s2_from_g(self.amplitude_g(probe))
    }

    /// The probe is the first of its point.
    pub(super) fn first_of(&self, point: usize, asked: Asked) -> bool {
        let search = self.campaign.search(point);
        search.and_then(|search| search.log().first()) == Some(&asked)
    }

    /// Row of a point as the evidence has it.
    pub(super) fn row(&self, point: usize) -> PointSummary {
        let onset_g = match self.campaign.touch(point) {
            Some(Touch::At { onset_g }) => Some(onset_g),
            Some(Touch::NoRamp | Touch::Unknown) | None => None,
        };
        let mut findings = self.campaign.findings(point);
        if !self.is_final(point) {
            findings.status = Status::Open;
        }
        rows::row(
            &self.input.points[point],
            &findings,
            self.finished_bar(point),
            onset_g,
            &self.input.settings.lattice,
        )
    }

    /// Lowest failure that the search of a point found, on the study's own knobs, G.
    pub(super) fn failure_g(&self, point: usize) -> Option<f64> {
        let failure = self.campaign.findings(point).failure?;
        Some(self.input.settings.lattice.amplitude_g(failure))
    }

    /// Answer of a point with its bar, once it is finished, and the runs it took.
    fn finished_bar(&self, point: usize) -> Option<(&bar::Answer, u64)> {
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

    /// Table, runs and what is kept beside them.
    pub(super) fn results(&self, session: &Session) -> Results {
        let mut used = HashSet::new();
        let mut runs = Vec::new();
        for (point, _) in self.input.points.iter().enumerate() {
            let Some(search) = self.campaign.search(point) else {
                continue;
            };
            let bar: &[bar::Ask] = match &self.bars[point] {
                BarStage::Begun { log, .. } => log,
                _ => &[],
            };
            let asked = search.log().iter().copied();
            let asked = asked.chain(bar.iter().map(|&ask| bar_asked(ask)));
            for (sequence, asked) in asked.enumerate() {
                let key = self.key(point, asked.probe);
                used.insert(key);
                runs.push(RunRow {
                    point,
                    sequence,
                    purpose: asked.purpose,
                    index: asked.probe.index,
                    levels: asked.probe.levels,
                    amplitude_g: self.amplitude_g(asked.probe),
                    run: self.runs[&key].clone(),
                });
            }
        }
        let mut outside: Vec<RunRecord> = self
            .runs
            .values()
            .filter(|record| !used.contains(&record.key))
            .cloned()
            .collect();
        outside.sort_by_key(|record| record.key);
        let rows: Vec<PointSummary> = (0..self.input.points.len())
            .map(|point| self.row(point))
            .collect();
        let totals = Totals::of(&rows, runs.iter().map(RunRow::counted));
        Results {
            summary: Summary {
                study: self.input.texts.name.clone(),
                digest: self.input.texts.digest.clone(),
                axes: self.input.axes.clone(),
                points: rows,
                totals,
            },
            nodes_per_octave: self.input.settings.lattice.nodes_per_octave,
            start_s: self.input.start_s,
            plan: self.input.plan.clone(),
            points: self
                .input
                .points
                .iter()
                .map(|point| PointKeep {
                    digest: point.digest,
                    touch: self.touches.get(&point.digest).copied(),
                })
                .collect(),
            runs,
            outside,
            session: session.clone(),
            written_unix_s: machine::unix_now_s(),
        }
    }
}

/// A run of an error bar as a probe.
fn bar_probe(ask: bar::Ask) -> Probe {
    Probe {
        is_fine: true,
        levels: ask.levels,
        retry: ask.retry,
        ..Probe::at(ask.index)
    }
}

fn bar_asked(ask: bar::Ask) -> Asked {
    Asked {
        probe: bar_probe(ask),
        purpose: Purpose::ErrorBar,
    }
}

/// A run as an error bar sees it.
fn seen(result: &ProbeResult) -> bar::Seen {
    bar::Seen {
        verdict: match result.verdict {
            Verdict::Survives => NodeVerdict::Survives,
            Verdict::Fails { .. } => NodeVerdict::Fails,
            Verdict::Undecided { .. } => NodeVerdict::Undecided,
        },
        h_min_m: result.h_min_m,
        t_min_s: result.t_min_s,
    }
}

/// First touch as the search counts it, in G.
fn searched(touch: StoredTouch) -> Touch {
    match touch {
        StoredTouch::NoRamp => Touch::NoRamp,
        StoredTouch::At(amplitude_m_per_s2) => Touch::At {
            onset_g: amplitude_m_per_s2 / STANDARD_GRAVITY_M_PER_S2,
        },
        StoredTouch::Unknown => Touch::Unknown,
    }
}

/// Places of the points, the head of the longest chain of successors first.
fn urgency(campaign: &Campaign) -> Vec<usize> {
    let order = campaign.order();
    let mut behind = vec![1_u32; order.relations.len()];
    for &point in order.sequence.iter().rev() {
        for before in order.relations[point].predecessors() {
            behind[before] = behind[before].max(behind[point] + 1);
        }
    }
    let mut places = order.sequence.clone();
    places.sort_by_key(|&point| std::cmp::Reverse(behind[point]));
    places
}
