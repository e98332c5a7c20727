//! What a running sweep expects of the time ahead: renewed as runs finish, reported, and asked whether a run still fits
//! into the budget.

use std::time::{Duration, Instant};

use super::input::SweepInput;
use super::pace::Pace;
use super::progress::Estimate;
use super::registry::{Job, Registry};
use super::remainder::{CORE_USE, remainder};
use super::run_time::RunTime;
use crate::search::Touch;

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
        let runs = registry.runs().values();
        let done_s: f64 = runs.map(|run| run.machine.wall_s).sum();
        let done_wall_s = done_s / (CORE_USE * threads as f64);
        let is_measured = !self.pace.plain_s().is_empty();
        self.due_at_runs = n_runs + 1 + n_runs / SHARE;
        self.renewed = Instant::now();
        self.not_before = self.renewed + REST * began.elapsed();
        let count = |is_it: &dyn Fn(usize) -> bool| {
            let all = 0..input.points.len();
            all.filter(|&point| is_it(point)).count() as u64
        };
        Some(Estimate {
            bracketed: count(&|point| registry.campaign().is_final(point)),
            answered: count(&|point| registry.is_final(point)),
            runs_done: n_runs as u64,
            runs_left: left.runs,
            core_s: is_measured.then(|| left.core_s.narrowed(done_s)),
            left_s: is_measured.then(|| left.wall_s.narrowed(done_wall_s)),
        })
    }

    /// The job, by what is known of its time, ends within `left`.
    pub(super) fn fits(&self, input: &SweepInput, job: &Job, left: Duration) -> bool {
        match job {
            Job::Onset { .. } => true,
            Job::Run { point, asked, .. } => {
                let time = RunTime::survivor(&input.points[*point], asked.probe);
                let seconds = self.pace.seconds(time);
                seconds.is_none_or(|seconds| seconds <= left.as_secs_f64())
            }
        }
    }
}
