//! The searches of all points and every known simulation: answers the requests of the searches.

use std::collections::{BTreeMap, HashMap, HashSet};

use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2, m_per_s2_from_g};

use super::stage::{Depth, UncertaintyStage};
use crate::search::{Asked, Campaign, Order, Probe, Touch, Verdict, uncertainty};
use crate::store::{Loaded, PointDigest, RunKey, RunMachine, RunRecord, StoredTouch};
use crate::sweep::input::{SweepInput, SweepPoint};

/// A probe whose verdict a search has taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::sweep) struct AnsweredProbe {
    /// Place in the study.
    pub point: usize,
    /// Probe.
    pub asked: Asked,
    /// Identity of its simulation.
    pub key: RunKey,
}

/// Searches and what is known.
pub(in crate::sweep) struct Registry<'a> {
    pub(super) input: &'a SweepInput,
    pub(super) campaign: Campaign,
    pub(super) runs: HashMap<RunKey, RunRecord>,
    /// When the latest of the runs that it began with had finished, s; minus infinity without any.
    loaded_unix_s: f64,
    pub(super) touches: HashMap<PointDigest, StoredTouch>,
    pub(super) in_flight: HashSet<RunKey>,
    pub(super) onsets_in_flight: HashSet<PointDigest>,
    pub(super) sharing: HashMap<PointDigest, Vec<usize>>,
    /// Places that differ in the clearance called failure alone, by the one with the smallest.
    clearances: HashMap<usize, Vec<usize>>,
    /// Places in the study, those with the most work behind them first.
    pub(super) urgency: Vec<usize>,
    /// Rank of every place in that order.
    pub(super) rank: Vec<usize>,
    /// Requests of searches that are not known, by rank: (place, probe, its identity).
    pub(super) asking: BTreeMap<usize, (usize, Asked, RunKey)>,
    /// Places before it in the campaign's sequence have their first touch.
    pub(super) n_touched: usize,
    /// Uncertainty intervals as far as they have got, by place.
    pub(super) uncertainties: Vec<UncertaintyStage>,
    /// Places whose interval waits for a run, by rank of their interval.
    pub(super) drawing: BTreeMap<usize, usize>,
    /// Rank of every place for its interval: that of the searches until all of them are final.
    pub(super) interval_rank: Vec<usize>,
    pub(super) are_intervals_ranked: bool,
    /// How far the uncertainty of every place is taken.
    pub(super) depths: Vec<Depth>,
    /// No round of decisive points is left.
    pub(super) is_decided: bool,
    /// Final chains of the campaign when intervals were begun last.
    pub(super) n_final_chains: usize,
    /// Times that a point became final, or may have.
    pub(super) n_changes: u64,
    pub(super) part: Part,
}

/// The task of a registry, by place in the study.
pub(super) struct Part {
    /// Points whose rows it is to complete.
    pub(super) wanted: Vec<bool>,
    /// Points whose probes it may simulate.
    pub(super) allowed: Vec<bool>,
}

impl<'a> Registry<'a> {
    /// Registry with what the store holds.
    pub(in crate::sweep) fn new(input: &'a SweepInput, loaded: Loaded) -> Registry<'a> {
        let coordinates: Vec<_> = input.points.iter().map(|p| p.coordinates.clone()).collect();
        let campaign = Campaign::new(input.settings, &coordinates);
        let mut sharing: HashMap<PointDigest, Vec<usize>> = HashMap::new();
        for (place, point) in input.points.iter().enumerate() {
            sharing.entry(point.digest).or_default().push(place);
        }
        let urgency = urgency(&campaign);
        let clearances = clearances(campaign.order());
        let depth = |point: &SweepPoint| match input.decides {
            Some(_) => Depth::Bracket,
            None => Depth::Refined(
                point
                    .uncertainty
                    .as_ref()
                    .map_or(0, |plan| plan.refinements),
            ),
        };
        let mut rank = vec![0; urgency.len()];
        for (k, &point) in urgency.iter().enumerate() {
            rank[point] = k;
        }
        let finished = loaded.runs.values().map(|run| run.machine.finished_unix_s);
        Registry {
            input,
            campaign,
            loaded_unix_s: finished.fold(f64::NEG_INFINITY, f64::max),
            runs: loaded.runs,
            touches: loaded.touches,
            in_flight: HashSet::new(),
            onsets_in_flight: HashSet::new(),
            sharing,
            clearances,
            urgency,
            rank: rank.clone(),
            asking: BTreeMap::new(),
            n_touched: 0,
            uncertainties: input
                .points
                .iter()
                .map(|_| UncertaintyStage::Waiting)
                .collect(),
            drawing: BTreeMap::new(),
            interval_rank: rank,
            are_intervals_ranked: false,
            depths: input.points.iter().map(depth).collect(),
            is_decided: input.decides.is_none(),
            n_final_chains: 0,
            n_changes: 0,
            part: Part {
                wanted: vec![true; input.points.len()],
                allowed: vec![true; input.points.len()],
            },
        }
    }

    /// Completes these points alone, by place in the study.
    pub(in crate::sweep) fn want(&mut self, wanted: Vec<bool>) {
        self.part.wanted = wanted;
    }

    /// Simulates for these points alone from now on, by place in the study.
    pub(in crate::sweep) fn allow(&mut self, allowed: Vec<bool>) {
        self.part.allowed = allowed;
    }

    /// The row of a point is to be completed.
    pub(in crate::sweep) fn wants(&self, point: usize) -> bool {
        self.part.wanted[point]
    }

    /// The searches.
    pub(in crate::sweep) fn campaign(&self) -> &Campaign {
        &self.campaign
    }

    /// The first place in the study of the content of a point.
    pub(in crate::sweep) fn first_of_content(&self, point: usize) -> usize {
        self.sharing[&self.input.points[point].digest][0]
    }

    /// Whether a run that finished then is of this process, and not one that it began with.
    pub(in crate::sweep) fn is_of_this_process(&self, finished_unix_s: f64) -> bool {
        finished_unix_s > self.loaded_unix_s
    }

    /// Simulations known.
    pub(in crate::sweep) fn runs(&self) -> &HashMap<RunKey, RunRecord> {
        &self.runs
    }

    /// Reports to the searches every known answer that they request; returns these in order.
    pub(in crate::sweep) fn absorb_all(&mut self) -> Vec<AnsweredProbe> {
        for place in 0..self.input.points.len() {
            if let Some(&touch) = self.touches.get(&self.input.points[place].digest) {
                self.campaign.set_touch(place, searched(touch));
            }
        }
        self.absorb(Vec::new())
    }

    /// Takes the amplitude of first touch; returns the probes answered in consequence.
    pub(in crate::sweep) fn touched(
        &mut self,
        digest: PointDigest,
        touch: StoredTouch,
    ) -> Vec<AnsweredProbe> {
        self.onsets_in_flight.remove(&digest);
        self.touches.entry(digest).or_insert(touch);
        // Another shard may have added widths that this one does not know yet.
        for &place in self.sharing.get(&digest).into_iter().flatten() {
            self.campaign
                .set_touch(place, searched(self.touches[&digest]));
        }
        self.absorb(Vec::new())
    }

    /// Takes a finished simulation; returns the probes answered in consequence.
    pub(in crate::sweep) fn finished(&mut self, record: RunRecord) -> Vec<AnsweredProbe> {
        let key = record.key;
        self.in_flight.remove(&key);
        self.runs.entry(key).or_insert(record);
        match self.sharing.get(&key.point) {
            Some(asking) => self.absorb(asking.clone()),
            // With changed levels: a run of an uncertainty interval.
            None => self.draw_uncertainty(Some(key)),
        }
    }

    /// Advances points, and those that start by it, as long as their answers are known.
    fn absorb(&mut self, mut places: Vec<usize>) -> Vec<AnsweredProbe> {
        let mut answered = Vec::new();
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
                    .report_margin(point, &result.verdict, result.h_min_m);
                answered.push(AnsweredProbe { point, asked, key });
                places.extend(self.campaign.take_changed());
            }
        }
        answered.extend(self.draw_uncertainty(None));
        answered
    }

    /// All wanted points are complete.
    pub(in crate::sweep) fn is_done(&self) -> bool {
        (0..self.input.points.len()).all(|point| !self.wants(point) || self.is_final(point))
    }

    /// Identity of a probe's simulation.
    pub(in crate::sweep) fn key(&self, point: usize, probe: Probe) -> RunKey {
        RunKey {
            point: self.input.points[point].digest.changed(probe.levels),
            amplitude_bits: self.amplitude_m_per_s2(point, probe).to_bits(),
            window_factor: probe.window_factor,
            retry: probe.retry.place(),
        }
    }

    /// A simulation of the same point with another clearance called failure in which the slider comes below neither: a run of
    /// this point is the same to the bit.
    pub(in crate::sweep) fn same_elsewhere(&self, point: usize, probe: Probe) -> Option<RunRecord> {
        let fail_below_m = self.input.points[point].coordinates.fail_below_m;
        let smallest = self.campaign.order().smallest_clearance(point);
        self.clearances.get(&smallest)?.iter().find_map(|&other| {
            let record = self.runs.get(&self.key(other, probe))?;
            let survives = record.result.verdict == Verdict::Survives
                && record.result.h_min_m? >= fail_below_m;
            survives.then(|| RunRecord {
                key: self.key(point, probe),
                result: record.result.clone(),
                machine: RunMachine {
                    wall_s: 0.0,
                    ..record.machine
                },
            })
        })
    }

    /// Amplitude of a probe without its sign, G.
    pub(in crate::sweep) fn amplitude_g(&self, probe: Probe) -> f64 {
        let grid = self.input.settings.grid;
        let grid = if probe.is_fine {
            grid.finer(uncertainty::SUBDIVISIONS)
        } else {
            grid
        };
        grid.amplitude_g(probe.index)
    }

    /// Signed amplitude of a probe.
    pub(in crate::sweep) fn amplitude_m_per_s2(&self, point: usize, probe: Probe) -> f64 {
        let sign = self.input.points[point].coordinates.sign.factor();
        sign * m_per_s2_from_g(self.amplitude_g(probe))
    }

    /// The probe is the first of its point.
    pub(in crate::sweep) fn first_of(&self, point: usize, asked: Asked) -> bool {
        let search = self.campaign.search(point);
        search.and_then(|search| search.log().first()) == Some(&asked)
    }
}

/// First touch in the terms of the search, in G.
fn searched(touch: StoredTouch) -> Touch {
    match touch {
        StoredTouch::NoRamp => Touch::NoRamp,
        StoredTouch::At(amplitude_m_per_s2) => Touch::At {
            onset_g: amplitude_m_per_s2 / STANDARD_GRAVITY_M_PER_S2,
        },
        StoredTouch::Unknown => Touch::Unknown,
    }
}

/// Points that differ in the clearance called failure alone, by the one with the smallest.
fn clearances(order: &Order) -> HashMap<usize, Vec<usize>> {
    let mut alike: HashMap<usize, Vec<usize>> = HashMap::new();
    for point in 0..order.relations.len() {
        alike
            .entry(order.smallest_clearance(point))
            .or_default()
            .push(point);
    }
    alike.retain(|_, points| points.len() > 1);
    alike
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
