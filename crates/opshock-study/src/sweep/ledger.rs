//! The searches of a study with every simulation finished so far: answers what the searches ask
//! from what is known, and reads table and runs from them.

use std::collections::{HashMap, HashSet};

use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2, m_per_s2_from_g};

use super::input::SweepInput;
use super::rows;
use crate::search::lookahead::{self, Lookup};
use crate::search::{Asked, Campaign, PointSearch, Probe, Touch};
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
        Ledger {
            input,
            campaign,
            runs: loaded.runs,
            touches: loaded.touches,
            in_flight: HashSet::new(),
            onsets_in_flight: HashSet::new(),
            sharing,
            urgency,
        }
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
        for &place in &self.sharing[&digest] {
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
        let asking = self.sharing[&key.point].clone();
        self.absorb(asking)
    }

    /// Lets points ask as long as their answers are known, and the points that start by it.
    fn absorb(&mut self, mut places: Vec<usize>) -> Vec<Told> {
        let mut told = Vec::new();
        places.extend(self.campaign.take_changed());
        while let Some(point) = places.pop() {
            while let Some(asked) = self.campaign.ask(point) {
                let key = self.key(point, asked.probe);
                let Some(record) = self.runs.get(&key) else {
                    break;
                };
                self.campaign.tell(point, &record.result.verdict);
                told.push(Told { point, asked, key });
                places.extend(self.campaign.take_changed());
            }
        }
        told
    }

    /// The best free job: what a search asks now, else what it will probably ask.
    pub(super) fn next_job(&mut self, speculate: bool) -> Option<Job> {
        let job = self
            .asked_job()
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

    fn asked_job(&self) -> Option<Job> {
        let onset = self
            .campaign
            .order()
            .sequence
            .iter()
            .copied()
            .find(|&place| {
                self.campaign.touch(place).is_none()
                    && !self
                        .onsets_in_flight
                        .contains(&self.input.points[place].digest)
            });
        if let Some(point) = onset {
            return Some(Job::Onset { point });
        }
        self.urgency.iter().find_map(|&point| {
            let asked = self.campaign.ask(point)?;
            let key = self.key(point, asked.probe);
            (!self.in_flight.contains(&key)).then_some(Job::Run { point, asked, key })
        })
    }

    fn likely_job(&self) -> Option<Job> {
        /// Chance that the companion of a point does not answer for it.
        const OWN_ANSWER: f64 = 0.9;
        let mut best: Option<(f64, Job)> = None;
        for &point in &self.urgency {
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
                    Some(record) => Lookup::Known(record.result.verdict.clone()),
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
            point: self.input.points[point].digest,
            amplitude_bits: self.amplitude_m_per_s2(point, probe.index).to_bits(),
            window_factor: probe.window_factor,
            retry: probe.retry.level(),
        }
    }

    /// Signed amplitude of a node.
    pub(super) fn amplitude_m_per_s2(&self, point: usize, node: i32) -> f64 {
        let sign = self.input.points[point].coordinates.sign.factor();
        sign * m_per_s2_from_g(self.input.settings.lattice.amplitude_g(node))
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
        rows::row(
            &self.input.points[point],
            &self.campaign.findings(point),
            onset_g,
            &self.input.settings.lattice,
        )
    }

    /// Table, runs and what is kept beside them.
    pub(super) fn results(&self, session: &Session) -> Results {
        let lattice = &self.input.settings.lattice;
        let mut used = HashSet::new();
        let mut runs = Vec::new();
        for (point, _) in self.input.points.iter().enumerate() {
            let Some(search) = self.campaign.search(point) else {
                continue;
            };
            for (sequence, asked) in search.log().iter().enumerate() {
                let key = self.key(point, asked.probe);
                used.insert(key);
                runs.push(RunRow {
                    point,
                    sequence,
                    purpose: asked.purpose,
                    index: asked.probe.index,
                    amplitude_g: lattice.amplitude_g(asked.probe.index),
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
        let totals = Totals::of(&rows, runs.iter().map(RunRow::result));
        Results {
            summary: Summary {
                study: self.input.texts.name.clone(),
                digest: self.input.digest.clone(),
                axes: self.input.axes.clone(),
                points: rows,
                totals,
            },
            nodes_per_octave: lattice.nodes_per_octave,
            start_s: self.input.start_s,
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
