//! What a running sweep expects of the time ahead: renewed as runs finish, reported, and asked whether a run still fits
//! into the budget.

use std::time::{Duration, Instant};

use super::input::SweepInput;
use super::pace::{Kind, Pace};
use super::progress::Estimate;
use super::registry::{Job, Registry};
use super::remainder::remainder;
use crate::search::{Probe, Touch};

/// It is renewed when the known runs have grown by 1 / `SHARE`, or after this time.
const SHARE: usize = 256;
const BETWEEN: Duration = Duration::from_secs(1);
/// Time from one renewal to the next in times of its own duration: idle threads wait for it.
const REST: u32 = 50;

/// Expectation and when it is renewed next.
pub(super) struct Outlook {
    pace: Pace,
    due_at_runs: usize,
    renewed: Instant,
    not_before: Instant,
}

impl Outlook {
    pub(super) fn new() -> Outlook {
        let now = Instant::now();
        Outlook {
            pace: Pace::default(),
            due_at_runs: 0,
            renewed: now,
            not_before: now,
        }
    }

    /// Takes the times of the known runs.
    pub(super) fn learn(&mut self, input: &SweepInput, registry: &Registry<'_>) {
        self.pace = Pace::of(input, registry);
    }

    /// What is left now, where it is due.
    pub(super) fn renew(
        &mut self,
        input: &SweepInput,
        registry: &Registry<'_>,
        threads: usize,
    ) -> Option<Estimate> {
        let n_runs = registry.runs().len();
        let began = Instant::now();
        let is_due = n_runs >= self.due_at_runs || self.renewed.elapsed() >= BETWEEN;
        if !registry.is_done() && (!is_due || began < self.not_before) {
            return None;
        }
        self.learn(input, registry);
        let touch = |point| registry.campaign().touch(point).unwrap_or(Touch::Unknown);
        let touches: Vec<Touch> = (0..input.points.len()).map(touch).collect();
        let left = remainder(input, registry, &touches, &self.pace, threads);
        let is_measured = !self.pace.plain_s().is_empty();
        self.due_at_runs = n_runs + 1 + n_runs / SHARE;
        self.renewed = Instant::now();
        self.not_before = self.renewed + REST * began.elapsed();
        Some(Estimate {
            runs_done: n_runs as u64,
            runs_left: left.runs,
            core_s: is_measured.then_some(left.core_s),
            left_s: is_measured.then_some(left.wall_s),
        })
    }

    /// The job, by what is known of its time, ends within `left`.
    pub(super) fn fits(&self, input: &SweepInput, job: &Job, left: Duration) -> bool {
        match job {
            Job::Onset { .. } => true,
            Job::Run { point, asked, .. } => self.probe_fits(input, *point, &asked.probe, left),
        }
    }

    /// The run of a probe, by what is known of its time, ends within `left`.
    fn probe_fits(&self, input: &SweepInput, point: usize, probe: &Probe, left: Duration) -> bool {
        let kind = Kind::of(input.points[point].coordinates.ramp, probe);
        let seconds = self.pace.seconds(kind);
        seconds.is_none_or(|seconds| seconds <= left.as_secs_f64())
    }
}
