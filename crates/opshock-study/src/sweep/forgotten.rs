//! Runs that a sweep makes anew: those without verdict, where it is asked to retry them.

use std::collections::{HashMap, HashSet};

use crate::search::Verdict;
use crate::store::{RunKey, RunRecord};

/// Forgets runs without verdict, except those of an amplitude that a later retry decided: made again they would end as
/// before, and the retry is known.
pub(super) fn forget_undecided(runs: &mut HashMap<RunKey, RunRecord>) {
    let grid_point = |key: &RunKey| (key.point, key.amplitude_bits, key.window_factor);
    let is_undecided = |run: &RunRecord| matches!(run.result.verdict, Verdict::Undecided { .. });
    let decided: HashSet<_> = runs
        .values()
        .filter(|run| !is_undecided(run))
        .map(|run| grid_point(&run.key))
        .collect();
    runs.retain(|key, run| !is_undecided(run) || decided.contains(&grid_point(key)));
}
