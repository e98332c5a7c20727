//! Rows of the table of critical shocks, made from the findings of the searches.

use super::input::SweepPoint;
use crate::search::uncertainty::{Answer, SUBDIVISIONS};
use crate::search::{AmplitudeGrid, Coordinates, Findings, Flag, Ramp, Status, Uncertainty};
use crate::store::summary::{Contribution, PointSummary};

/// Row of a point.
///
/// The answer lies between the highest survivor, which is reported, and the lowest failure above it: the bracket adds
/// nothing below the reported value and its width above. The bracket alone is no error: without an uncertainty
/// interval, or where it has no other contribution, the row has none. After adaptive refinement both are those of the
/// refined parameters; brackets and scan remain those of the study's resolution.
pub(super) fn row(
    point: &SweepPoint,
    findings: &Findings,
    uncertainty: Option<(&Answer, u64)>,
    onset_g: Option<f64>,
    grid: &AmplitudeGrid,
) -> PointSummary {
    let amplitude = |node: i32| grid.amplitude_g(node);
    let fine = grid.finer(SUBDIVISIONS);
    let (a_crit_g, a_fail_g) = match (findings.status, uncertainty) {
        (Status::Ok, Some((answer, _))) => (
            Some(fine.amplitude_g(answer.survivor)),
            Some(fine.amplitude_g(answer.failure)),
        ),
        _ => (
            findings.survivor.map(amplitude),
            findings.failure.map(amplitude),
        ),
    };
    let contributions = match (findings.status, uncertainty, a_crit_g, a_fail_g) {
        (Status::Ok, Some((answer, _)), Some(a_crit_g), Some(a_fail_g)) => {
            contributions(&answer.uncertainty, a_crit_g, a_fail_g)
        }
        _ => Vec::new(),
    };
    let sum = |of: fn(&Contribution) -> f64| {
        (!contributions.is_empty()).then(|| {
            contributions
                .iter()
                .map(|(_, contribution)| of(contribution))
                .sum()
        })
    };
    let mut flags = findings.flags.clone();
    let mut levels = String::new();
    if let Some((answer, _)) = uncertainty {
        flags.extend(&answer.uncertainty.flags);
        levels = answer.levels.label();
        // The ramp takes the answer without ramp only below first touch.
        if let (Some(crit_g), Some(onset_g)) = (a_crit_g, onset_g)
            && flags.contains(&Flag::NoTouch)
            && crit_g > onset_g
        {
            flags.insert(Flag::ContributionMissing);
        }
    }
    if !levels.is_empty() {
        flags.insert(Flag::Refined);
    }
    PointSummary {
        ramp: point.coordinates.ramp.to_string(),
        pulse_ms: point.coordinates.pulse_ms,
        sign: point.coordinates.sign,
        axes: point.axes.clone(),
        a_crit_g,
        a_fail_g,
        err_low_g: sum(|contribution| contribution.low_g),
        err_high_g: sum(|contribution| contribution.high_g),
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
        largest_gap_pct: findings.largest_gap.map(|nodes| {
            let octaves = f64::from(nodes) / f64::from(grid.steps_per_octave);
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
    }
}

/// The width of the bracket, and the contributions of the resolution as shares of the answer; nothing where they are
/// not known.
fn contributions(
    uncertainty: &Uncertainty,
    a_crit_g: f64,
    a_fail_g: f64,
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
        high_g: a_fail_g - a_crit_g,
        factor: 1.0,
    };
    let others = others.into_iter().map(|contribution| {
        let part_g = Contribution {
            low_g: contribution.low * a_crit_g,
            high_g: contribution.high * a_crit_g,
            factor: contribution.factor,
        };
        (contribution.name.to_owned(), part_g)
    });
    std::iter::once(("search".to_owned(), search))
        .chain(others)
        .collect()
}
