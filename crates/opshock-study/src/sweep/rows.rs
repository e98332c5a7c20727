//! Rows of the table of critical shocks, made from the findings of the searches.

use super::input::SweepPoint;
use crate::search::uncertainty::{Answer, SUBDIVISIONS};
use crate::search::{AmplitudeGrid, Coordinates, Findings, Flag, Ramp, Status, Uncertainty};
use crate::store::summary::{Contribution, PointSummary};

/// Row of a point.
///
/// The critical shock lies between the highest survivor and the lowest failure above it: the bracket adds nothing to the
/// interval below the survivor, and its width above. Reported is the middle of the interval. The bracket alone is no error:
/// without an uncertainty interval, or where it has no other contribution, the row has none and reports the middle of the
/// bracket. After adaptive refinement both are those of the refined parameters; brackets and scan remain those of the
/// study's resolution.
pub(super) fn row(
    point: &SweepPoint,
    findings: &Findings,
    uncertainty: Option<(&Answer, u64)>,
    onset_g: Option<f64>,
    grid: &AmplitudeGrid,
) -> PointSummary {
    let amplitude = |grid_point: i32| grid.amplitude_g(grid_point);
    let fine = grid.finer(SUBDIVISIONS);
    let is_found = findings.status == Status::Ok;
    let (survived_g, failed_g) = match (findings.status, uncertainty) {
        (Status::Ok, Some((answer, _))) => (
            Some(fine.amplitude_g(answer.survivor)),
            Some(fine.amplitude_g(answer.failure)),
        ),
        _ => (
            findings.survivor.map(amplitude),
            findings.failure.map(amplitude),
        ),
    };
    let contributions = match (findings.status, uncertainty, survived_g, failed_g) {
        (Status::Ok, Some((answer, _)), Some(survived_g), Some(failed_g)) => {
            contributions(&answer.uncertainty, survived_g, failed_g)
        }
        _ => Vec::new(),
    };
    let sum = |of: fn(&Contribution) -> f64| -> f64 {
        let parts = contributions.iter().map(|(_, part)| of(part));
        parts.sum()
    };
    let interval_g = survived_g
        .filter(|_| !contributions.is_empty())
        .map(|from_g| {
            [
                from_g - sum(|part| part.low_g),
                from_g + sum(|part| part.high_g),
            ]
        });
    let bracket_g = survived_g.zip(failed_g).map(<[f64; 2]>::from);
    let reported_g = interval_g.or(bracket_g).filter(|_| is_found);
    let mut flags = findings.flags.clone();
    let mut levels = String::new();
    if let Some((answer, _)) = uncertainty {
        flags.extend(&answer.uncertainty.flags);
        levels = answer.levels.label();
        // The ramp takes the answer without ramp only below first touch.
        if let (Some(crit_g), Some(onset_g)) = (survived_g, onset_g)
            && flags.contains(&Flag::NoTouch)
            && crit_g > onset_g
        {
            flags.insert(Flag::ContributionMissing);
        }
    }
    if !levels.is_empty() {
        flags.insert(Flag::Refined);
    }
    if point.below_continuum && is_found {
        flags.insert(Flag::BelowContinuum);
    }
    let half_min_height = uncertainty.and_then(|(answer, _)| answer.half_min_height);
    PointSummary {
        ramp: point.coordinates.ramp.to_string(),
        pulse_ms: point.coordinates.pulse_ms,
        sign: point.coordinates.sign,
        axes: point.axes.clone(),
        a_crit_g: reported_g.map(|[low_g, high_g]| f64::midpoint(low_g, high_g)),
        uncertainty_g: interval_g.map(|[low_g, high_g]| 0.5 * (high_g - low_g)),
        half_min_height_g: half_min_height
            .zip(reported_g)
            .map(|(share, [low_g, high_g])| share * f64::midpoint(low_g, high_g)),
        survived_g,
        failed_g,
        contributions,
        levels,
        onset_g,
        runs: findings.runs + uncertainty.map_or(0, |(_, runs)| runs),
        status: findings.status,
        flags: flags.into_iter().collect(),
        brackets_g: findings
            .brackets
            .iter()
            .map(|&(low, high)| [amplitude(low), amplitude(high)])
            .collect(),
        scanned_from_g: findings.scanned_from.map(amplitude),
        largest_gap_pct: findings.largest_gap.map(|grid_points| {
            let octaves = f64::from(grid_points) / f64::from(grid.steps_per_octave);
            100.0 * (octaves.exp2() - 1.0)
        }),
    }
}

/// Coordinates of a row; its axes as they are shown.
pub(super) fn coordinates(row: &PointSummary) -> Coordinates {
    Coordinates {
        ramp: Ramp::from_word(&row.ramp).expect("a ramp model, as it was written and read"),
        pulse_ms: row.pulse_ms,
        sign: row.sign,
        axes: row.axes.iter().map(ToString::to_string).collect(),
        round: 0,
        fail_below_m: 0.0,
        clearance_axis: None,
    }
}

/// The width of the bracket, and the contributions of the resolution as shares of the answer; nothing where they are
/// not known.
fn contributions(
    uncertainty: &Uncertainty,
    survived_g: f64,
    failed_g: f64,
) -> Vec<(String, Contribution)> {
    let others: Vec<_> = uncertainty
        .contributions
        .iter()
        .filter(|contribution| contribution.name != "search")
        .collect();
    if others.is_empty() {
        return Vec::new();
    }
    let search = Contribution {
        low_g: 0.0,
        high_g: failed_g - survived_g,
        factor: 1.0,
    };
    let others = others.into_iter().map(|contribution| {
        let part_g = Contribution {
            low_g: contribution.low * survived_g,
            high_g: contribution.high * survived_g,
            factor: contribution.factor,
        };
        (contribution.name.to_owned(), part_g)
    });
    std::iter::once(("search".to_owned(), search))
        .chain(others)
        .collect()
}
