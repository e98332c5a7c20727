//! Estimate of the runs and the time left, from what finished points of the same kind took.

use std::collections::HashMap;

use super::input::SweepInput;
use super::progress::Estimate;
use super::registry::Registry;
use crate::search::Ramp;

/// Probes of a point before any was finished: bracketing 3, halving 2, scan 3, window 1.
const PRIOR_RUNS: f64 = 9.0;
/// Spread of that number from point to point.
const PRIOR_SPREAD: f64 = 4.0;
/// Runs of an uncertainty interval before any was finished: about three a discretisation parameter.
const PRIOR_UNCERTAINTY_RUNS: f64 = 17.0;
/// Spread of that number; a refinement doubles it.
const PRIOR_UNCERTAINTY_SPREAD: f64 = 8.0;

/// Runs that something took at the points of a class of ramp where it is done.
#[derive(Default)]
struct Taken(HashMap<Ramp, (f64, f64)>);

impl Taken {
    fn add(&mut self, class: Ramp, runs: usize) {
        let sum = self.0.entry(class).or_default();
        sum.0 += runs as f64;
        sum.1 += 1.0;
    }

    /// What is left of it where `done` runs are made: one at least.
    fn left(&self, class: Ramp, prior: f64, done: usize) -> f64 {
        let expected = self.0.get(&class).map_or(prior, |&sum| mean(sum));
        (expected - done as f64).max(1.0)
    }
}

fn mean((sum, count): (f64, f64)) -> f64 {
    if count > 0.0 { sum / count } else { 0.0 }
}

/// Estimate of a sweep's remainder: searches, and uncertainty intervals with their refinements.
pub(super) fn estimate(input: &SweepInput, registry: &Registry<'_>, threads: usize) -> Estimate {
    let campaign = registry.campaign();
    let class = |point: usize| input.points[point].coordinates.ramp;
    let searched = |point: usize| {
        campaign
            .search(point)
            .map_or(0, |search| search.log().len())
    };

    let (mut searches, mut uncertainties) = (Taken::default(), Taken::default());
    let mut class_of_digest = HashMap::new();
    for (point, one) in input.points.iter().enumerate() {
        // Scenes at other refinement levels have digests of their own: they enter the overall pace alone.
        class_of_digest.insert(one.digest, class(point));
        if campaign.is_settled(point) && campaign.search(point).is_some() {
            searches.add(class(point), searched(point));
        }
        if let Some((runs, true)) = registry.uncertainty_runs(point) {
            uncertainties.add(class(point), runs);
        }
    }
    let mut wall_of: HashMap<Ramp, (f64, f64)> = HashMap::new();
    let mut overall = (0.0, 0.0);
    for record in registry.runs().values() {
        let wall_s = record.machine.wall_s;
        overall = (overall.0 + wall_s, overall.1 + 1.0);
        if let Some(&class) = class_of_digest.get(&record.key.point) {
            let sum = wall_of.entry(class).or_default();
            *sum = (sum.0 + wall_s, sum.1 + 1.0);
        }
    }

    let (mut runs_left, mut variance, mut left_s) = (0.0, 0.0, 0.0);
    for (point, one) in input.points.iter().enumerate() {
        if !registry.wants(point) || registry.is_final(point) {
            continue;
        }
        let class = class(point);
        let mut left = 0.0;
        if !campaign.is_settled(point) {
            left += searches.left(class, PRIOR_RUNS, searched(point));
            variance += PRIOR_SPREAD * PRIOR_SPREAD;
        }
        if let Some(plan) = &one.uncertainty {
            let prior = PRIOR_UNCERTAINTY_RUNS * (1.0 + f64::from(plan.refinements.min(1)));
            let done = registry.uncertainty_runs(point).map_or(0, |(runs, _)| runs);
            left += uncertainties.left(class, prior, done);
            variance += PRIOR_UNCERTAINTY_SPREAD * PRIOR_UNCERTAINTY_SPREAD;
        }
        runs_left += left;
        left_s += left * wall_of.get(&class).map_or(mean(overall), |&sum| mean(sum));
    }
    Estimate {
        runs_done: registry.runs().len() as u64,
        runs_left,
        runs_left_sd: f64::sqrt(variance),
        eta_s: (overall.1 > 0.0).then_some(left_s / threads as f64),
    }
}
