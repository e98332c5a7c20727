//! Re-bracketing: the critical amplitude of a changed scene is found anew.

use opshock_solver::scene::discretisation::Levels;

use super::ask::Ask;
use super::walk::{Bracket, Walk};
use crate::search::evidence::AmplitudeVerdict;
use crate::search::probe::Retry;

/// Farthest distance at which the answer of a changed scene is looked for, as a share.
pub(super) const FARTHEST: f64 = 1.0;
/// Growth of the step while it is looked for; what is passed over is halved afterwards.
const GROWTH: i32 = 2;
/// A bracket need not be narrower than its distance over this number: a large shift is known well enough.
const DISTANCE_OVER: i32 = 4;

/// Brackets the changed scene's answer beginning at `from`, to `grid_points` grid steps or a part of its distance. `None`
/// without verdicts or farther away than the share `farthest`.
pub(super) fn locate(
    walk: &mut Walk<'_>,
    levels: Levels,
    from: Bracket,
    grid_points: i32,
    farthest: f64,
) -> Result<Option<Bracket>, Ask> {
    let farthest = walk.input.grid.steps_within(farthest);
    let (mut low, mut high) = seen_about(walk, levels, from);
    let mut stride = (from.high - from.low).max(1);
    loop {
        let next = match (low, high) {
            (Some(low), Some(high)) => {
                let distance = (low - from.low).abs().max((high - from.high).abs());
                if high - low <= grid_points.max(distance / DISTANCE_OVER) {
                    return Ok(Some(Bracket { low, high }));
                }
                low + (high - low) / 2
            }
            // The upper end first: a survivor there answers for the lower end too.
            (None, None) => from.high,
            (Some(low), None) if low < from.high => from.high,
            (None, Some(high)) if high > from.low => from.low,
            (Some(low), None) => {
                stride *= GROWTH;
                low + stride / GROWTH
            }
            (None, Some(high)) => {
                stride *= GROWTH;
                high - stride / GROWTH
            }
        };
        if (next - from.low).abs() > farthest {
            return Ok(None);
        }
        match walk.see(levels, next)?.verdict {
            AmplitudeVerdict::Undecided => return Ok(None),
            AmplitudeVerdict::Survives => low = Some(next),
            AmplitudeVerdict::Fails => high = Some(next),
        }
    }
}

/// A survivor and a failure of a changed scene are known.
pub(super) fn is_known(walk: &Walk<'_>, levels: Levels) -> bool {
    let mut both = [AmplitudeVerdict::Survives, AmplitudeVerdict::Fails].into_iter();
    both.all(|verdict| known(walk, levels, verdict).next().is_some())
}

/// Grid points of a changed scene with a verdict.
fn known<'w>(
    walk: &'w Walk<'_>,
    levels: Levels,
    verdict: AmplitudeVerdict,
) -> impl Iterator<Item = i32> + use<'w> {
    let levels = walk.input.base.plus(levels);
    walk.log
        .iter()
        .filter(move |ask| ask.levels == levels && ask.retry == Retry::None)
        .filter(move |&&ask| (walk.lookup)(ask).is_some_and(|seen| seen.verdict == verdict))
        .map(|ask| ask.index)
}

/// Known verdicts of a changed scene at `from` or beyond, where they lead away from there, and next to these.
fn seen_about(walk: &Walk<'_>, levels: Levels, from: Bracket) -> (Option<i32>, Option<i32>) {
    let survivors = || known(walk, levels, AmplitudeVerdict::Survives);
    let failures = || known(walk, levels, AmplitudeVerdict::Fails);
    let low = survivors().filter(|&index| index >= from.low).max();
    let high = failures().filter(|&index| index <= from.high).min();
    match (low, high) {
        (Some(low), Some(high)) if low >= high => (None, None),
        (Some(low), None) => (Some(low), failures().filter(|&index| index > low).min()),
        (None, Some(high)) => (survivors().filter(|&index| index < high).max(), Some(high)),
        found => found,
    }
}

/// Brackets the changed scene's answer beginning at `from`, to `grid_points` grid steps whatever its distance.
pub(super) fn located(
    walk: &mut Walk<'_>,
    levels: Levels,
    from: Bracket,
    grid_points: i32,
) -> Result<Option<Bracket>, Ask> {
    match locate(walk, levels, from, grid_points, FARTHEST)? {
        Some(found) => narrowed(walk, levels, found, grid_points),
        None => Ok(None),
    }
}

/// Halves a bracket down to `grid_points` grid steps. `None` without verdicts.
pub(super) fn narrowed(
    walk: &mut Walk<'_>,
    levels: Levels,
    mut bracket: Bracket,
    grid_points: i32,
) -> Result<Option<Bracket>, Ask> {
    while bracket.high - bracket.low > grid_points {
        let middle = bracket.low + (bracket.high - bracket.low) / 2;
        match walk.see(levels, middle)?.verdict {
            AmplitudeVerdict::Undecided => return Ok(None),
            AmplitudeVerdict::Survives => bracket.low = middle,
            AmplitudeVerdict::Fails => bracket.high = middle,
        }
    }
    Ok(Some(bracket))
}
