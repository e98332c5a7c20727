//! Search of one point: names the next probe (amplitude and way of running it) and takes its verdict.
//!
//! The next probe is a function of the verdicts so far, those known before it began included, of the settings and of the
//! start alone. In this order:
//!
//! 1. the retries of a grid point without verdict;
//! 2. exponential search for a bracket, and its halving (`bracketing`);
//! 3. the scan for lower failures (`monotonicity_scan`); a failure found becomes the bracket and is halved in turn, so
//!    that in the end the lowest failure in the evidence has a survivor next to it;
//! 4. failures of neighbouring widths to be looked for here;
//! 5. the ends of the bracket, where they are known from elsewhere;
//! 6. the highest survivor below it, in a doubled window.

use std::collections::{BTreeMap, BTreeSet};

use super::amplitude_grid::AmplitudeRange;
use super::bracketing::{Bracketing, BracketingStep, bisect, survives_at_top};
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
    /// Clearance below which the interface has failed, m.
    pub fail_below_m: f64,
}

/// A grid point whose verdict is known from the runs of another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownVerdict {
    /// Grid point.
    pub index: i32,
    /// Smallest clearance of a survivor, m; `None`: it failed.
    pub h_min_m: Option<f64>,
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
    pub(super) grid_points: AmplitudeRange,
    assumed_survivor: Option<i32>,
    pub(super) bracketing: Bracketing,
    scan: Scan,
    pub(super) evidence: Evidence,
    windows: BTreeMap<i32, AmplitudeVerdict>,
    retry: Retry,
    targets: Vec<i32>,
    bracketed: bool,
    first_failure: Option<i32>,
    pub(super) log: Vec<Asked>,
    pub(super) known: Vec<i32>,
    undecided_runs: u64,
    flags: BTreeSet<Flag>,
}

impl PointSearch {
    /// Search from a start.
    pub fn new(settings: SearchSettings, start: Start) -> PointSearch {
        let SearchSettings { grid, range, .. } = settings;
        let own = start
            .onset_index
            .filter(|&grid_point| grid_point > range.low);
        let grid_points = AmplitudeRange {
            low: own.unwrap_or(range.low).min(range.high),
            high: range.high,
        };
        let gap = match settings.monotonicity_scan {
            MonotonicityScan::Full => 1,
            MonotonicityScan::Off | MonotonicityScan::Sampled => settings.scan_gap,
        };
        PointSearch {
            settings,
            grid_points,
            assumed_survivor: own.map(|grid_point| grid_point - 1),
            bracketing: Bracketing::new(&grid, grid_points, start.hint_g, start.fail_below_m),
            scan: Scan {
                gap,
                phase: Scan::phase_of(start.width_rank, gap),
                keep: (own.is_none() && settings.monotonicity_scan == MonotonicityScan::Sampled)
                    .then_some((grid.steps_per_octave / 2, 2)),
                lowest: grid_points.low,
            },
            evidence: Evidence::default(),
            windows: BTreeMap::new(),
            retry: Retry::None,
            targets: Vec::new(),
            bracketed: false,
            first_failure: None,
            log: Vec::new(),
            known: Vec::new(),
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
        let (grid_point, window_factor, purpose) = self.next_grid_point()?;
        Some(Asked {
            probe: Probe {
                window_factor,
                retry: self.retry,
                ..Probe::at(grid_point)
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
                if asked.purpose == Purpose::OwnRun {
                    // The verdict stays what is known.
                    return;
                }
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
        if asked.purpose == Purpose::OwnRun
            && self.evidence.get(asked.probe.index) != Some(amplitude_verdict)
        {
            self.bracketed = false;
        }
        self.evidence.insert(asked.probe.index, amplitude_verdict);
        if let (AmplitudeVerdict::Survives, Some(h_min_m)) = (amplitude_verdict, h_min_m) {
            self.evidence.insert_clearance(asked.probe.index, h_min_m);
        }
        self.note_bracket();
    }

    /// Adds grid points that failed at a neighbouring width; those that cannot lower the answer are passed over later.
    pub fn follow(&mut self, grid_points: &[i32]) {
        self.targets.extend_from_slice(grid_points);
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
    pub fn is_open_below_failure(&self, grid_point: i32) -> bool {
        grid_point >= self.grid_points.low
            && self.evidence.get(grid_point).is_none()
            && self.bracketed
            && self
                .evidence
                .lowest_failure()
                .map_or(grid_point <= self.grid_points.high, |failure| {
                    grid_point < failure
                })
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
        match survivor.and_then(|grid_point| self.windows.get(&grid_point)) {
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
                self.assumed_survivor.map_or_else(
                    || self.evidence.lowest_survivor(),
                    |_| Some(self.grid_points.low),
                )
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
        if self.next_grid_point().is_some() {
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
    pub(super) fn survivor(&self) -> Option<i32> {
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
                .step(&self.evidence, self.grid_points, self.assumed_survivor),
            BracketingStep::Bracketed { .. }
        )
    }

    pub(super) fn note_bracket(&mut self) {
        if self.bracketed {
            return;
        }
        match self
            .bracketing
            .step(&self.evidence, self.grid_points, self.assumed_survivor)
        {
            BracketingStep::Bracketed { survivor, failure } => {
                if bisect(&self.evidence, survivor, failure).is_none() {
                    self.bracketed = true;
                    // What is known may hold a lower failure, which a search from nothing finds after its first bracket.
                    let highest = self.evidence.brackets().last().map(|&(_, failure)| failure);
                    let first = highest.filter(|_| !self.known.is_empty());
                    self.first_failure = Some(first.unwrap_or(failure));
                }
            }
            BracketingStep::Exhausted => {
                self.bracketed = survives_at_top(&self.evidence, self.grid_points)
            }
            BracketingStep::Test(_) => {}
        }
    }

    fn next_grid_point(&self) -> Option<(i32, u8, Purpose)> {
        if self.evidence.n_undecided() > self.settings.max_undecided {
            return None;
        }
        if !self.bracketed {
            return match self.bracketing.step(
                &self.evidence,
                self.grid_points,
                self.assumed_survivor,
            ) {
                BracketingStep::Test(grid_point) => Some((grid_point, 1, Purpose::Bracketing)),
                BracketingStep::Bracketed { survivor, failure } => {
                    let halvings = self.log.iter().filter(|a| a.purpose == Purpose::Bisect);
                    self.bracketing
                        .aimed(&self.evidence, survivor, failure, halvings.count())
                        .or_else(|| bisect(&self.evidence, survivor, failure))
                        .map(|grid_point| (grid_point, 1, Purpose::Bisect))
                }
                BracketingStep::Exhausted => self.next_own_run(),
            };
        }
        self.next_below()
            .or_else(|| self.next_target())
            .or_else(|| self.next_own_run())
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
            let lowest = self.grid_points.low;
            return next
                .or((self.evidence.get(lowest).is_none()).then_some(lowest))
                .map(|grid_point| (grid_point, 1, Purpose::Scan));
        };
        if let Some(failure) = failure
            && let Some(grid_point) = bisect(&self.evidence, survivor, failure)
        {
            return Some((grid_point, 1, Purpose::Bisect));
        }
        scans
            .then(|| self.scan.next(&self.evidence, survivor))
            .flatten()
            .map(|grid_point| (grid_point, 1, Purpose::Scan))
    }

    fn next_target(&self) -> Option<(i32, u8, Purpose)> {
        self.targets
            .iter()
            .find(|&&grid_point| self.is_open_below_failure(grid_point))
            .map(|&grid_point| (grid_point, 1, Purpose::FollowUp))
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
