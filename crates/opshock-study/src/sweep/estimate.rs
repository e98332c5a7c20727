//! How much is left, from what finished points of the same kind took.

use std::collections::HashMap;

use super::input::SweepInput;
use super::ledger::Ledger;
use super::progress::Estimate;
use crate::search::RampClass;

/// Probes of a point before any was finished: hunt 3, halving 2, scan 3, window 1.
const PRIOR_RUNS: f64 = 9.0;
/// Spread of that number from point to point.
const PRIOR_SPREAD: f64 = 4.0;

/// What is left of a sweep.
pub(super) fn estimate(input: &SweepInput, ledger: &Ledger<'_>, threads: usize) -> Estimate {
    let campaign = ledger.campaign();
    let class = |point: usize| input.points[point].coordinates.ramp_class;

    let mut runs_of: HashMap<RampClass, Vec<f64>> = HashMap::new();
    let mut class_of_digest = HashMap::new();
    for point in 0..input.points.len() {
        class_of_digest.insert(input.points[point].digest, class(point));
        if campaign.is_settled(point)
            && let Some(search) = campaign.search(point)
        {
            runs_of
                .entry(class(point))
                .or_default()
                .push(search.log().len() as f64);
        }
    }
    let mut wall_of: HashMap<RampClass, (f64, f64)> = HashMap::new();
    for record in ledger.runs().values() {
        if let Some(&class) = class_of_digest.get(&record.key.point) {
            let sum = wall_of.entry(class).or_default();
            sum.0 += record.machine.wall_s;
            sum.1 += 1.0;
        }
    }
    let overall = wall_of
        .values()
        .fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));

    let (mut runs_left, mut variance, mut left_s) = (0.0, 0.0, 0.0);
    for point in 0..input.points.len() {
        if campaign.is_settled(point) {
            continue;
        }
        let class = class(point);
        let expected = runs_of.get(&class).map_or(PRIOR_RUNS, |runs| {
            runs.iter().sum::<f64>() / runs.len() as f64
        });
        let done = campaign
            .search(point)
            .map_or(0.0, |search| search.log().len() as f64);
        let left = (expected - done).max(1.0);
        let mean = |(sum, count): (f64, f64)| if count > 0.0 { sum / count } else { 0.0 };
        runs_left += left;
        variance += PRIOR_SPREAD * PRIOR_SPREAD;
        left_s += left * wall_of.get(&class).map_or(mean(overall), |&sum| mean(sum));
    }
    Estimate {
        runs_done: ledger.runs().len() as u64,
        runs_left,
        runs_left_sd: f64::sqrt(variance),
        eta_s: (overall.1 > 0.0).then_some(left_s / threads as f64),
    }
}
