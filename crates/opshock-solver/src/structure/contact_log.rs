//! Summarises the contact impulses of an arm as contact episodes and running means of the force.

use super::record::{ArmContact, Episode};

/// Episodes closer together than this are one, s.
const MERGE_S: f64 = 30e-6;
/// Length of the running mean, s.
const MEAN_S: f64 = 20e-6;

/// Impulses on one arm, in order of time.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactLog {
    pub time_s: Vec<f64>,
    pub impulse_n_s: Vec<f64>,
}

impl ContactLog {
    pub fn clear(&mut self) {
        self.time_s.clear();
        self.impulse_n_s.clear();
    }

    pub fn push(&mut self, time_s: f64, impulse_n_s: f64) {
        self.time_s.push(time_s);
        self.impulse_n_s.push(impulse_n_s);
    }

    /// Episodes, totals and peaks.
    pub fn summary(&self, step_s: f64) -> ArmContact {
        let mut episodes: Vec<Episode> = Vec::new();
        let mut first = 0;
        for i in 0..self.time_s.len() {
            let ends = self
                .time_s
                .get(i + 1)
                .is_none_or(|next| next - self.time_s[i] > MERGE_S);
            if ends {
                episodes.push(Episode {
                    on_s: self.time_s[first],
                    off_s: self.time_s[i],
                    impulse_n_s: total(&self.impulse_n_s[first..=i]),
                    peak_20us_n: self.peak(first, i, step_s),
                });
                first = i + 1;
            }
        }
        ArmContact {
            first_touch_s: self.time_s.first().copied(),
            impulse_n_s: total(&self.impulse_n_s),
            episodes,
        }
    }

    /// Largest mean over windows that begin at an impulse; a window holds the impulses in
    /// [start, start + length), of which a steady contact has exactly length/step.
    fn peak(&self, first: usize, last: usize, step_s: f64) -> f64 {
        let (mut end, mut sum, mut largest) = (first, 0.0, 0.0_f64);
        for start in first..=last {
            while end <= last && self.time_s[end] - self.time_s[start] < MEAN_S - 1e-3 * step_s {
                sum += self.impulse_n_s[end];
                end += 1;
            }
            largest = largest.max(sum / MEAN_S);
            sum -= self.impulse_n_s[start];
        }
        largest
    }

    /// Running mean centred on the nodes k × step.
    pub fn running_mean(&self, step_s: f64, n_nodes: usize) -> Vec<f64> {
        let (mut start, mut end, mut sum) = (0, 0, 0.0);
        let half = 0.5 * MEAN_S - 1e-3 * step_s;
        (0..n_nodes)
            .map(|k| {
                let t = k as f64 * step_s;
                while end < self.time_s.len() && self.time_s[end] <= t + half {
                    sum += self.impulse_n_s[end];
                    end += 1;
                }
                while start < end && self.time_s[start] < t - half - 2e-3 * step_s {
                    sum -= self.impulse_n_s[start];
                    start += 1;
                }
                if start == end {
                    // Empty window: no remainder of cancelled sums.
                    sum = 0.0;
                }
                sum / MEAN_S
            })
            .collect()
    }
}

/// Sum from +0: the sum of no impulse is 0, not −0.
fn total(impulses: &[f64]) -> f64 {
    impulses.iter().fold(0.0, |a, b| a + b)
}
