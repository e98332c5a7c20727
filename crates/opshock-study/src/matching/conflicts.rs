//! Finds the smallest groups of observations that no parameter set satisfies together.

use super::file::MatchProblem;
use super::observation::Known;
use super::sample::Sample;
use super::searched::Searched;
use crate::draws::Share;
use serde::Serialize;

/// Largest size of a group that is examined.
const LARGEST_GROUP: usize = 4;

/// Observations that no set satisfies together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Conflict {
    /// Their names; without any one of them, some set satisfies the others.
    pub observations: Vec<String>,
    /// Sets, of all waves, for which all of them are known.
    pub tried: u64,
    /// Independent draws among these, none of which satisfies all.
    pub share: Share,
    /// Searches for a set that satisfies them; 0 where none was requested.
    pub searches: u64,
    /// Sets that these searches tried.
    pub searched: u64,
}

/// Smallest groups of observations that no set satisfies together, by their places; the smallest first.
pub(super) fn groups(problem: &MatchProblem, found: &Searched) -> Vec<(Vec<usize>, Conflict)> {
    let ranged: Vec<usize> = (0..problem.observations.len())
        .filter(|k| problem.observations[*k].range.is_some())
        .collect();
    let samples = &found.samples;
    let words = samples.len().div_ceil(64);
    let bits = |is: &dyn Fn(&Sample, usize) -> bool, k: usize| {
        let mut set = vec![0_u64; words];
        for (place, sample) in samples.iter().enumerate() {
            if is(sample, k) {
                set[place / 64] |= 1 << (place % 64);
            }
        }
        set
    };
    let holds = |sample: &Sample, k: usize| {
        problem.observations[k].holds(sample.numbers[k].0) == Some(true)
    };
    let known = |sample: &Sample, k: usize| sample.numbers[k].0 != Known::NotAsked;
    let holding: Vec<Vec<u64>> = ranged.iter().map(|k| bits(&holds, *k)).collect();
    let asked: Vec<Vec<u64>> = ranged.iter().map(|k| bits(&known, *k)).collect();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut level: Vec<(Vec<usize>, Vec<u64>)> = vec![(Vec::new(), vec![u64::MAX; words])];
    for size in 1..=LARGEST_GROUP {
        let mut next = Vec::new();
        for (group, set) in &level {
            let first = group.last().map_or(0, |last| last + 1);
            for (k, true_with) in holding.iter().enumerate().skip(first) {
                let mut larger = group.clone();
                larger.push(k);
                if groups
                    .iter()
                    .any(|small| small.iter().all(|one| larger.contains(one)))
                {
                    continue;
                }
                let both: Vec<u64> = set.iter().zip(true_with).map(|(a, b)| a & b).collect();
                match both.iter().any(|word| *word != 0) {
                    false => groups.push(larger),
                    // The largest groups, which would take most of the memory, are not extended.
                    true if size < LARGEST_GROUP => next.push((larger, both)),
                    true => {}
                }
            }
        }
        level = next;
    }
    let conflicts = groups.into_iter().map(|group| {
        let tried = (0..words).map(|w| {
            let all = group.iter().fold(u64::MAX, |all, k| all & asked[*k][w]);
            (w, all)
        });
        let mut counts = [0_u64; 2];
        for (w, all) in tried {
            counts[0] += u64::from(all.count_ones());
            let first = 64 * w;
            let draws = found.draws.saturating_sub(first).min(64);
            let mask = if draws == 64 {
                u64::MAX
            } else {
                (1_u64 << draws) - 1
            };
            counts[1] += u64::from((all & mask).count_ones());
        }
        let places: Vec<usize> = group.iter().map(|k| ranged[*k]).collect();
        let searched = found.contradicted.iter().find(|one| one.group == places);
        let conflict = Conflict {
            observations: places
                .iter()
                .map(|place| problem.observations[*place].name.clone())
                .collect(),
            tried: counts[0],
            share: Share::of(0, counts[1]),
            searches: searched.map_or(0, |one| one.searches),
            searched: searched.map_or(0, |one| one.tried),
        };
        (places, conflict)
    });
    conflicts.filter(|(_, one)| one.tried > 0).collect()
}
