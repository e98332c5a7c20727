//! Search of one point: names the next probe (amplitude and way of running it) and takes its verdict.
//!
//! The next probe is a function of the verdicts so far, of the settings and of the start alone. In this order:
//!
//! 1. the retries of a grid point without verdict;
//! 2. exponential search for a bracket, and its halving (`bracketing`);
//! 3. the scan for lower failures (`monotonicity_scan`); a failure found becomes the bracket and is halved in turn, so
//!    that in the end the lowest failure in the evidence has a survivor next to it;
//! 4. failures of neighbouring widths to be looked for here;
//! 5. the highest survivor below the lowest failure, in a doubled window.

use std::collections::{BTreeMap, BTreeSet};

use super::amplitude_grid::AmplitudeRange;
use super::bracketing::{Bracketing, BracketingStep, aimed, bisect, survives_at_top};
use super::evidence::{AmplitudeVerdict, Evidence};
use super::findings::Findings;
use super::monotonicity_scan::Scan;
use super::outcome::{Flag, Status};
use super::probe::{Probe, Purpose, Retry, Verdict};
use super::settings::{MonotonicityScan, SearchSettings};

/// What a point starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Where the answer is expected, G.
    pub hint_g: Option<f64>,
    /// Lowest grid point of this point's own; below it the no-ramp answer survives. `None`: the whole range is this
    /// point's own.
    pub onset_index: Option<i32>,
    /// Place of the width among the widths of the same ramp, sign and axes: shifts the scan.
    pub width_rank: usize,
}

/// A probe that was requested and answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asked {
    /// The probe.
    pub probe: Probe,
    /// Why.
    pub purpose: Purpose,
}

/// Search of one point.
#[derive(Clone, Debug)]
pub struct PointSearch {
    settings: SearchSettings,
    nodes: AmplitudeRange,
    assumed_survivor: Option<i32>,
    bracketing: Bracketing,
    scan: Scan,
    evidence: Evidence,
    windows: BTreeMap<i32, AmplitudeVerdict>,
    retry: Retry,
    targets: Vec<i32>,
    bracketed: bool,
    first_failure: Option<i32>,
    log: Vec<Asked>,
    undecided_runs: u64,
    flags: BTreeSet<Flag>,
}

impl PointSearch {
    /// Search from a start.
    pub fn new(settings: SearchSettings, start: Start) -> PointSearch {
        let SearchSettings { grid, range, .. } = settings;
        let own = start.onset_index.filter(|&node| node > range.low);
        let nodes = AmplitudeRange {
            low: own.unwrap_or(range.low).min(range.high),
            high: range.high,
        };
        let gap = match settings.monotonicity_scan {
            MonotonicityScan::Full => 1,
            MonotonicityScan::Off | MonotonicityScan::Sampled => settings.scan_gap,
        };
        PointSearch {
            settings,
            nodes,
            assumed_survivor: own.map(|node| node - 1),
            bracketing: Bracketing::new(&grid, nodes, start.hint_g),
            scan: Scan {
                gap,
                phase: Scan::phase_of(start.width_rank, gap),
                keep: (own.is_none() && settings.monotonicity_scan == MonotonicityScan::Sampled)
                    .then_some((grid.steps_per_octave / 2, 2)),
                floor: nodes.low,
            },
            evidence: Evidence::default(),
            windows: BTreeMap::new(),
            retry: Retry::None,
            targets: Vec::new(),
            bracketed: false,
            first_failure: None,
            log: Vec::new(),
            undecided_runs: 0,
            flags: BTreeSet::new(),
        }
    }

    /// The same search of a point without ramp, scanned more coarsely (`monotonicity_scan`).
    #[must_use]
    pub fn without_ramp(mut self) -> PointSearch {
        self.scan.keep = self.scan.keep.map(|_| ((self.scan.gap + 1) / 2, 4));
        self
    }

    /// The next probe, `None` when the search has its answer.
    pub fn ask(&self) -> Option<Asked> {
        let (node, window_factor, purpose) = self.next_node()?;
        Some(Asked {
            probe: Probe {
                window_factor,
                retry: self.retry,
                ..Probe::at(node)
            },
            purpose,
        })
    }

    /// Takes the verdict of the probe requested last.
    ///
    /// # Panics
    ///
    /// No probe was requested: the search had its answer.
    pub fn tell(&mut self, verdict: &Verdict) {
        self.report_margin(verdict, None);
    }

    /// As [`PointSearch::tell`], with the smallest clearance of the run, m: it may choose which grid point of a bracket
    /// is tested next, and never decides one.
    ///
    /// # Panics
    ///
    /// As there.
    pub fn report_margin(&mut self, verdict: &Verdict, h_min_m: Option<f64>) {
        let asked = self.ask().expect("a verdict without a probe");
        self.log.push(asked);
        let amplitude_verdict = match verdict {
            Verdict::Survives => AmplitudeVerdict::Survives,
            Verdict::Fails { .. } => AmplitudeVerdict::Fails,
            Verdict::Undecided { cause, .. } => {
                self.undecided_runs += 1;
                self.flags.insert(Flag::from(*cause));
                if let Some(next) = asked.probe.retry.next() {
                    self.retry = next;
                    return;
                }
                AmplitudeVerdict::Undecided
            }
        };
        if asked.probe.retry != Retry::None && amplitude_verdict != AmplitudeVerdict::Undecided {
            self.flags.insert(Flag::Retry);
        }
        self.retry = Retry::None;
        if asked.purpose == Purpose::Window {
            self.windows.insert(asked.probe.index, amplitude_verdict);
            return;
        }
        if asked.purpose == Purpose::Bracketing {
            self.bracketing.count(asked.probe.index);
        }
        self.evidence.insert(asked.probe.index, amplitude_verdict);
        if let (AmplitudeVerdict::Survives, Some(h_min_m)) = (amplitude_verdict, h_min_m) {
            self.evidence.insert_margin(asked.probe.index, h_min_m);
        }
        self.note_bracket();
    }

    /// Adds grid points that failed at a neighbouring width; those that cannot lower the answer are passed over later.
    pub fn follow(&mut self, nodes: &[i32]) {
        self.targets.extend_from_slice(nodes);
    }

    /// Evidence so far.
    pub fn evidence(&self) -> &Evidence {
        &self.evidence
    }

    /// Probes answered, in order.
    pub fn log(&self) -> &[Asked] {
        &self.log
    }

    /// Failure at the first closed bracket, before any lower failure was found.
    pub fn first_failure(&self) -> Option<i32> {
        self.first_failure
    }

    /// Whether a grid point would be this point's own to test and could lower its answer.
    pub fn is_open_below_failure(&self, node: i32) -> bool {
        node >= self.nodes.low
            && self.evidence.get(node).is_none()
            && self.bracketed
            && self
                .evidence
                .lowest_failure()
                .map_or(node <= self.nodes.high, |failure| node < failure)
    }

    /// The answer as the evidence has it now.
    pub fn findings(&self) -> Findings {
        let failure = self.evidence.lowest_failure();
        let survivor = self.survivor();
        let mut flags = self.flags.clone();
        if self.evidence.is_non_monotone() {
            flags.insert(Flag::NonMonotone);
        }
        if self.evidence.n_undecided() > 0 {
            flags.insert(Flag::UndecidedAmplitude);
        }
        match survivor.and_then(|node| self.windows.get(&node)) {
            Some(AmplitudeVerdict::Fails) => {
                flags.insert(Flag::Window);
            }
            Some(AmplitudeVerdict::Undecided) => {
                flags.insert(Flag::WindowUndecided);
            }
            Some(AmplitudeVerdict::Survives) | None => {}
        }
        let mut brackets = self.evidence.brackets();
        if let (Some(failure), Some(assumed)) = (failure, self.assumed_survivor)
            && survivor == Some(assumed)
        {
            brackets.insert(0, (assumed, failure));
        }
        let scanned_from = (self.settings.monotonicity_scan != MonotonicityScan::Off
            && self.bracketed)
            .then(|| {
                self.assumed_survivor
                    .map_or_else(|| self.evidence.lowest_survivor(), |_| Some(self.nodes.low))
            })
            .flatten()
            .filter(|&low| survivor.is_some_and(|survivor| low <= survivor + 1));
        Findings {
            status: self.status(survivor, failure),
            survivor,
            failure,
            brackets,
            scanned_from,
            largest_gap: match (scanned_from, survivor) {
                (Some(low), Some(high)) if low <= high => {
                    Some(self.evidence.largest_gap(low, high))
                }
                _ => None,
            },
            flags,
            runs: self.log.len() as u64,
            undecided_runs: self.undecided_runs,
        }
    }

    fn status(&self, survivor: Option<i32>, failure: Option<i32>) -> Status {
        if self.next_node().is_some() {
            return Status::Open;
        }
        match (survivor, failure) {
            (Some(_), Some(_)) => Status::Ok,
            (Some(_), None) if self.bracketed => Status::AboveRange,
            (None, Some(failure)) if failure == self.settings.range.low => Status::BelowRange,
            _ => Status::Undecided,
        }
    }

    /// Highest survivor below the lowest failure, the grid point below first touch included.
    fn survivor(&self) -> Option<i32> {
        let failure = self.evidence.lowest_failure();
        self.evidence
            .highest_survivor_below(failure)
            .or(self.assumed_survivor.filter(|_| self.is_floor_reached()))
    }

    /// Nothing of this point's own is left to test between first touch and its lowest failure.
    fn is_floor_reached(&self) -> bool {
        let Some(failure) = self.evidence.lowest_failure() else {
            return false;
        };
        if self.bracketed && self.settings.monotonicity_scan != MonotonicityScan::Off {
            return self.scan.next(&self.evidence, failure).is_none();
        }
        matches!(
            self.bracketing
                .step(&self.evidence, self.nodes, self.assumed_survivor),
            BracketingStep::Bracketed { .. }
        )
    }

    fn note_bracket(&mut self) {
        if self.bracketed {
            return;
        }
        match self
            .bracketing
            .step(&self.evidence, self.nodes, self.assumed_survivor)
        {
            BracketingStep::Bracketed { survivor, failure } => {
                if bisect(&self.evidence, survivor, failure).is_none() {
                    self.bracketed = true;
                    self.first_failure = Some(failure);
                }
            }
            BracketingStep::Exhausted => {
                self.bracketed = survives_at_top(&self.evidence, self.nodes)
            }
            BracketingStep::Test(_) => {}
        }
    }

    fn next_node(&self) -> Option<(i32, u8, Purpose)> {
        if self.evidence.n_undecided() > self.settings.max_undecided {
            return None;
        }
        if !self.bracketed {
            return match self
                .bracketing
                .step(&self.evidence, self.nodes, self.assumed_survivor)
            {
                BracketingStep::Test(node) => Some((node, 1, Purpose::Bracketing)),
                BracketingStep::Bracketed { survivor, failure } => {
                    let halvings = self.log.iter().filter(|a| a.purpose == Purpose::Bisect);
                    aimed(&self.evidence, survivor, failure, halvings.count())
                        .or_else(|| bisect(&self.evidence, survivor, failure))
                        .map(|node| (node, 1, Purpose::Bisect))
                }
                BracketingStep::Exhausted => None,
            };
        }
        self.next_below()
            .or_else(|| self.next_target())
            .or_else(|| self.next_window())
    }

    /// Lower failures, once there is a bracket.
    fn next_below(&self) -> Option<(i32, u8, Purpose)> {
        let failure = self.evidence.lowest_failure();
        let own_survivor = self.evidence.highest_survivor_below(failure);
        let scans = self.settings.monotonicity_scan != MonotonicityScan::Off;
        let Some(survivor) = own_survivor.or(self.survivor()) else {
            // A failure without a survivor below it: go on down to the end of the range.
            let failure = failure?;
            let next = self.scan.next(&self.evidence, failure);
            let lowest = self.nodes.low;
            return next
                .or((self.evidence.get(lowest).is_none()).then_some(lowest))
                .map(|node| (node, 1, Purpose::Scan));
        };
        if let Some(failure) = failure
            && let Some(node) = bisect(&self.evidence, survivor, failure)
        {
            return Some((node, 1, Purpose::Bisect));
        }
        scans
            .then(|| self.scan.next(&self.evidence, survivor))
            .flatten()
            .map(|node| (node, 1, Purpose::Scan))
    }

    fn next_target(&self) -> Option<(i32, u8, Purpose)> {
        self.targets
            .iter()
            .find(|&&node| self.is_open_below_failure(node))
            .map(|&node| (node, 1, Purpose::FollowUp))
    }

    fn next_window(&self) -> Option<(i32, u8, Purpose)> {
        let survivor = self.survivor()?;
        (self.settings.window_check && !self.windows.contains_key(&survivor)).then_some((
            survivor,
            2,
            Purpose::Window,
        ))
    }
}
