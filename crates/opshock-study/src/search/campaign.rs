//! Search of all points of a study: starts each when its predecessors are answered, looks for lower failures found at
//! one pulse width at its neighbours, and reads the rows of the table.
//!
//! A point passes three stages. *Waiting*: a predecessor has no answer or the amplitude of first touch is not known.
//! *Searching*: it requests its own probes. *Settled*: it has its base answer, from which its successors start. When
//! all widths of one ramp, sign and axes (a chain) are settled, lower failures found at one width are given to its
//! neighbours; these rounds go on until none is left to give. Then the chain is final. Each round uses all widths as
//! the round before left them, so the order in which probes come back does not matter.

use std::collections::BTreeSet;

use super::findings::{Findings, Inheritance};
use super::hint::{self, Known};
use super::order::{Coordinates, Order};
use super::outcome::Status;
use super::point::{Asked, KnownVerdict, PointSearch, Start};
use super::probe::Verdict;
use super::settings::SearchSettings;

/// First touch of disk and ramp of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Touch {
    /// No ramp.
    NoRamp,
    /// At this amplitude and above.
    At {
        /// Positive amplitude, G.
        onset_g: f64,
    },
    /// Not known.
    Unknown,
}

impl Touch {
    /// Amplitude of first touch, G, where disk and ramp touch and it is known.
    pub fn onset_g(self) -> Option<f64> {
        match self {
            Touch::At { onset_g } => Some(onset_g),
            Touch::NoRamp | Touch::Unknown => None,
        }
    }
}

/// Answers that a starting amplitude may be made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trust {
    /// Those that no longer change.
    Settled,
    /// Those of a closed bracket, too, below which no lower failure has been found so far.
    Likely,
}

#[derive(Clone, Debug)]
pub(super) enum Stage {
    Waiting,
    Searching(Box<PointSearch>),
    Copied { onset_index: i32 },
}

#[derive(Clone, Debug)]
pub(super) struct PointState {
    touch: Option<Touch>,
    pub(super) stage: Stage,
    pub(super) base: Option<Findings>,
    /// With its base answer: what it says to the same point with larger clearances called failure.
    known: Vec<KnownVerdict>,
}

/// Search of all points of a study.
#[derive(Clone, Debug)]
pub struct Campaign {
    pub(super) settings: SearchSettings,
    pulse_ms: Vec<f64>,
    fail_below_m: Vec<f64>,
    pub(super) order: Order,
    pub(super) successors: Vec<Vec<usize>>,
    pub(super) points: Vec<PointState>,
    pub(super) chain_final: Vec<bool>,
    pub(super) n_final_chains: usize,
    /// (source, low end of its non-monotone interval, neighbour) already given.
    pub(super) given: BTreeSet<(usize, i32, usize)>,
    pub(super) changed: Vec<usize>,
}

impl Campaign {
    /// Campaign over the points of a study, given in any order.
    pub fn new(settings: SearchSettings, coordinates: &[Coordinates]) -> Campaign {
        let order = Order::of(coordinates);
        let mut successors = vec![Vec::new(); coordinates.len()];
        for (point, relations) in order.relations.iter().enumerate() {
            for before in relations.predecessors() {
                successors[before].push(point);
            }
        }
        Campaign {
            settings,
            pulse_ms: coordinates.iter().map(|at| at.pulse_ms).collect(),
            fail_below_m: coordinates.iter().map(|at| at.fail_below_m).collect(),
            successors,
            points: vec![
                PointState {
                    touch: None,
                    stage: Stage::Waiting,
                    base: None,
                    known: Vec::new(),
                };
                coordinates.len()
            ],
            chain_final: vec![false; order.chains.len()],
            n_final_chains: 0,
            order,
            given: BTreeSet::new(),
            changed: Vec::new(),
        }
    }

    /// Order and relations of the points.
    pub fn order(&self) -> &Order {
        &self.order
    }

    /// Settings of the searches.
    pub fn settings(&self) -> &SearchSettings {
        &self.settings
    }

    /// Takes the amplitude of first touch of a point. Every point needs it before it starts.
    pub fn set_touch(&mut self, point: usize, touch: Touch) {
        self.points[point].touch = Some(touch);
        self.start_ready(vec![point]);
    }

    /// Amplitude of first touch as reported.
    pub fn touch(&self, point: usize) -> Option<Touch> {
        self.points[point].touch
    }

    /// The next probe of a point; `None` while it waits and when it requests none.
    pub fn ask(&self, point: usize) -> Option<Asked> {
        match &self.points[point].stage {
            Stage::Searching(search) => search.ask(),
            Stage::Waiting | Stage::Copied { .. } => None,
        }
    }

    /// Takes the verdict of the probe that `point` requests.
    ///
    /// # Panics
    ///
    /// The point requests nothing.
    pub fn tell(&mut self, point: usize, verdict: &Verdict) {
        self.report_margin(point, verdict, None);
    }

    /// As [`Campaign::tell`], with the smallest clearance of the run, m.
    ///
    /// # Panics
    ///
    /// As there.
    pub fn report_margin(&mut self, point: usize, verdict: &Verdict, h_min_m: Option<f64>) {
        let Stage::Searching(search) = &mut self.points[point].stage else {
            panic!("verdict for point {point}, which does not search");
        };
        search.report_margin(verdict, h_min_m);
        if search.ask().is_none() {
            if self.points[point].base.is_none() {
                self.settle(point);
            } else {
                self.close_round(self.order.relations[point].chain);
            }
        }
    }

    /// Points that began to request probes since the last call, except the one whose verdict was reported.
    pub fn take_changed(&mut self) -> Vec<usize> {
        std::mem::take(&mut self.changed)
    }

    /// Search of a point, once it has started.
    pub fn search(&self, point: usize) -> Option<&PointSearch> {
        match &self.points[point].stage {
            Stage::Searching(search) => Some(search),
            Stage::Waiting | Stage::Copied { .. } => None,
        }
    }

    /// The point has its base answer.
    pub fn is_settled(&self, point: usize) -> bool {
        self.points[point].base.is_some()
    }

    /// The point's answer will not change any more.
    pub fn is_final(&self, point: usize) -> bool {
        let relations = &self.order.relations[point];
        self.chain_final[relations.chain]
            && relations
                .companion
                .is_none_or(|companion| self.chain_final[self.order.relations[companion].chain])
    }

    /// Chains whose answers will not change any more.
    pub fn n_final_chains(&self) -> usize {
        self.n_final_chains
    }

    /// All answers are final.
    pub fn is_done(&self) -> bool {
        self.n_final_chains == self.chain_final.len()
    }

    /// Answer of a point as the evidence has it; `Open` until it is final.
    pub fn findings(&self, point: usize) -> Findings {
        let state = &self.points[point];
        let companion = self.order.relations[point].companion;
        let onset_index = self.onset_index(point);
        let mut findings = match (&state.stage, companion, onset_index) {
            (Stage::Searching(search), Some(companion), Some(grid_point)) => search
                .findings()
                .lowered_by(&self.findings(companion), grid_point),
            (Stage::Searching(search), _, _) => search.findings(),
            (Stage::Copied { onset_index }, Some(companion), _) => {
                self.findings(companion).copied_below(*onset_index)
            }
            (Stage::Copied { .. } | Stage::Waiting, _, _) => Findings {
                status: Status::Open,
                survivor: None,
                failure: None,
                brackets: Vec::new(),
                scanned_from: None,
                largest_gap: None,
                flags: BTreeSet::new(),
                runs: 0,
                undecided_runs: 0,
            },
        };
        if state.touch == Some(Touch::Unknown) {
            findings.flags.insert(super::outcome::Flag::OnsetUnknown);
        }
        if !self.is_final(point) {
            findings.status = Status::Open;
        }
        findings
    }

    /// Search that a waiting point would make if its companion's answer, still open, turned out to lie above first
    /// touch, and brackets that are still scanned below remained: what idle cores may compute ahead.
    pub fn likely_search(&self, point: usize) -> Option<PointSearch> {
        let state = &self.points[point];
        if !matches!(state.stage, Stage::Waiting) {
            return None;
        }
        let touch = state.touch?;
        let relations = &self.order.relations[point];
        if relations.smaller_clearance.is_some() {
            return None;
        }
        let hint_g = self.hint_g(point, touch, Trust::Likely)?;
        let onset_index = self.onset_index(point)?;
        if onset_index > self.settings.range.high {
            return None;
        }
        Some(PointSearch::new(
            self.settings,
            Start {
                hint_g,
                onset_index: relations.companion.map(|_| onset_index),
                width_rank: relations.width_rank,
                fail_below_m: self.fail_below_m[point],
            },
        ))
    }

    fn onset_index(&self, point: usize) -> Option<i32> {
        let onset_g = self.points[point].touch?.onset_g()?;
        Some(self.settings.grid.at_or_above(onset_g))
    }

    /// Starts whatever can start, beginning with `ready`.
    fn start_ready(&mut self, mut ready: Vec<usize>) {
        while let Some(point) = ready.pop() {
            if !self.start(point) {
                continue;
            }
            if self.points[point].base.is_some() {
                ready.extend(self.successors[point].iter().copied());
                self.close_round(self.order.relations[point].chain);
            }
        }
    }

    /// Starts a waiting point whose predecessors are settled; says whether it did.
    fn start(&mut self, point: usize) -> bool {
        let state = &self.points[point];
        let (Stage::Waiting, Some(touch)) = (&state.stage, state.touch) else {
            return false;
        };
        let relations = &self.order.relations[point];
        let companion = match relations.companion {
            None => None,
            Some(companion) => match &self.points[companion].base {
                None => return false,
                settled => settled.as_ref(),
            },
        };
        let known: &[KnownVerdict] = match relations.smaller_clearance {
            None => &[],
            Some(other) if self.points[other].base.is_none() => return false,
            Some(other) => &self.points[other].known,
        };
        let Some(hint_g) = self.hint_g(point, touch, Trust::Settled) else {
            return false;
        };
        let inheritance = match (companion, self.onset_index(point)) {
            (Some(findings), Some(grid_point)) => {
                findings.bequeath(grid_point, self.settings.range.high)
            }
            _ => Inheritance::Nothing,
        };
        let start = |onset_index| Start {
            hint_g,
            onset_index,
            width_rank: relations.width_rank,
            fail_below_m: self.fail_below_m[point],
        };
        let (stage, base) = match (inheritance, companion, self.onset_index(point)) {
            (Inheritance::Whole, Some(findings), Some(onset_index)) => (
                Stage::Copied { onset_index },
                Some(findings.copied_below(onset_index)),
            ),
            (Inheritance::Below { onset_index }, _, _) => {
                let search = PointSearch::new(self.settings, start(Some(onset_index)));
                let search = search.knowing(known);
                (Stage::Searching(Box::new(search)), None)
            }
            _ => {
                let search = PointSearch::new(self.settings, start(None));
                let search = match touch {
                    Touch::NoRamp => search.without_ramp(),
                    Touch::At { .. } | Touch::Unknown => search,
                };
                let search = search.knowing(known);
                (Stage::Searching(Box::new(search)), None)
            }
        };
        self.changed.push(point);
        self.points[point].stage = stage;
        self.points[point].base = base;
        // Nothing is left to ask where all is known.
        if self.points[point].base.is_none() && self.ask(point).is_none() {
            self.keep_answer(point);
        }
        true
    }

    /// Records the base answer of a point that searches.
    fn keep_answer(&mut self, point: usize) {
        let Stage::Searching(search) = &self.points[point].stage else {
            return;
        };
        let mut successors = self.successors[point].iter();
        let has_larger = successors.any(|&other| self.is_smaller(point, other));
        // As it is now: failures found at other widths come later, in whatever order runs are finished.
        let known = has_larger.then(|| search.known_for_larger());
        let base = Some(search.findings());
        let state = &mut self.points[point];
        (state.base, state.known) = (base, known.unwrap_or_default());
    }

    /// Records the base answer of a point and starts its successors.
    fn settle(&mut self, point: usize) {
        self.keep_answer(point);
        let successors = self.successors[point].clone();
        self.start_ready(successors);
        self.close_round(self.order.relations[point].chain);
    }

    /// Starting amplitude: `None` while a point it comes from is open, `Some(None)` when there is
    /// nothing to start from.
    fn hint_g(&self, point: usize, touch: Touch, trust: Trust) -> Option<Option<f64>> {
        let relations = &self.order.relations[point];
        let mut answered = Vec::new();
        for other in relations.answered.into_iter().flatten() {
            let touch = self.points[other].touch?;
            answered.push(self.known(other, touch, self.answer_g(other, trust)?, trust)?);
        }
        let at = self.known(point, touch, None, trust)?;
        Some(hint::expected_g(at, &answered))
    }

    /// A point with its reference, `None` while that is open.
    fn known(
        &self,
        point: usize,
        touch: Touch,
        answer_g: Option<f64>,
        trust: Trust,
    ) -> Option<Known> {
        let reference = match self.order.relations[point].reference {
            None => None,
            Some(other) => {
                let onset_g = self.points[other].touch?.onset_g();
                self.answer_g(other, trust)?
                    .map(|answer_g| (onset_g, answer_g))
            }
        };
        Some(Known {
            pulse_ms: self.pulse_ms[point],
            onset_g: touch.onset_g(),
            answer_g,
            reference,
        })
    }

    /// Amplitude that other points start from; `None` while it is open.
    fn answer_g(&self, point: usize, trust: Trust) -> Option<Option<f64>> {
        let SearchSettings { grid, range, .. } = &self.settings;
        let Some(findings) = &self.points[point].base else {
            let bracketed = self.search(point).filter(|_| trust == Trust::Likely)?;
            let failure = bracketed
                .first_failure()
                .and(bracketed.evidence().lowest_failure())?;
            return Some(Some(grid.amplitude_g(failure)));
        };
        let grid_point = match findings.status {
            Status::Ok => findings.failure,
            Status::AboveRange => Some(range.high),
            Status::BelowRange => Some(range.low),
            Status::Undecided | Status::Open => None,
        };
        Some(grid_point.map(|grid_point| grid.amplitude_g(grid_point)))
    }
}
