//! Rows of the table from what the searches found.

use super::input::SweepPoint;
use crate::search::bar::{Answer, SUBNODES};
use crate::search::{Bar, Coordinates, Findings, Flag, Lattice, RampClass, Status};
use crate::store::summary::{ErrorPart, PointSummary};

/// Row of a point.
///
/// The answer lies between the highest survivor, which is reported, and the lowest failure above
/// it: the bracket adds nothing below the reported value and its width above. The bracket alone is no error: without
/// an error bar, or where no other part of it could be found, the row has none. Where the bar climbed,
/// both are those of the finer knobs; brackets and scan stay those of the study's own.
pub(super) fn row(
    point: &SweepPoint,
    findings: &Findings,
    bar: Option<(&Answer, u64)>,
    onset_g: Option<f64>,
    lattice: &Lattice,
) -> PointSummary {
    let amplitude = |node: i32| lattice.amplitude_g(node);
    let fine = lattice.finer(SUBNODES);
    let (a_crit_g, a_fail_g) = match (findings.status, bar) {
        (Status::Ok, Some((answer, _))) => (
            Some(fine.amplitude_g(answer.survivor)),
            Some(fine.amplitude_g(answer.failure)),
        ),
        _ => (
            findings.survivor.map(amplitude),
            findings.failure.map(amplitude),
        ),
    };
    let err_parts = match (findings.status, bar, a_crit_g, a_fail_g) {
        (Status::Ok, Some((answer, _)), Some(a_crit_g), Some(a_fail_g)) => {
            parts(&answer.bar, a_crit_g, a_fail_g)
        }
        _ => Vec::new(),
    };
    let sum = |of: fn(&ErrorPart) -> f64| {
        (!err_parts.is_empty()).then(|| err_parts.iter().map(|(_, part)| of(part)).sum())
    };
    let mut flags = findings.flags.clone();
    let mut levels = String::new();
    if let Some((answer, _)) = bar {
        flags.extend(&answer.bar.flags);
        levels = answer.levels.label();
        // The ramp takes the answer without ramp only below first touch.
        if let (Some(crit_g), Some(onset_g)) = (a_crit_g, onset_g)
            && flags.contains(&Flag::NoTouch)
            && crit_g > onset_g
        {
            flags.insert(Flag::BarPartial);
        }
    }
    if !levels.is_empty() {
        flags.insert(Flag::Climbed);
    }
    PointSummary {
        ramp: point.coordinates.ramp.clone(),
        pulse_ms: point.coordinates.pulse_ms,
        sign: point.coordinates.sign,
        axes: point.axes.clone(),
        a_crit_g,
        a_fail_g,
        err_low_g: sum(|part| part.low_g),
        err_high_g: sum(|part| part.high_g),
        err_parts,
        levels,
        onset_g,
        runs: findings.runs + bar.map_or(0, |(_, runs)| runs),
        status: findings.status,
        flags: flags.into_iter().collect(),
        brackets_g: findings
            .brackets
            .iter()
            .map(|&(low, high)| [amplitude(low), amplitude(high)])
            .collect(),
        certified_from_g: findings.certified_from.map(amplitude),
        largest_gap_pct: findings.largest_gap.map(|nodes| {
            let octaves = f64::from(nodes) / f64::from(lattice.nodes_per_octave);
            100.0 * (octaves.exp2() - 1.0)
        }),
    }
}

/// Coordinates of a row; its axes as they are shown.
pub(super) fn coordinates(row: &PointSummary) -> Coordinates {
    Coordinates {
        ramp_class: match row.ramp.as_str() {
            "none" => RampClass::None,
            "rigid" => RampClass::Rigid,
            _ => RampClass::Deformable,
        },
        ramp: row.ramp.clone(),
        pulse_ms: row.pulse_ms,
        sign: row.sign,
        axes: row.axes.iter().map(ToString::to_string).collect(),
        round: 0,
    }
}

/// The bracket to its last digit, and what the resolution adds as shares of the answer; nothing where
/// that is not known.
fn parts(bar: &Bar, a_crit_g: f64, a_fail_g: f64) -> Vec<(String, ErrorPart)> {
    let others: Vec<_> = bar
        .parts
        .iter()
        .filter(|part| part.name != "search")
        .collect();
    if others.is_empty() {
        return Vec::new();
    }
    let search = ErrorPart {
        low_g: 0.0,
        high_g: a_fail_g - a_crit_g,
        factor: 1.0,
    };
    let others = others.into_iter().map(|part| {
        let part_g = ErrorPart {
            low_g: part.low * a_crit_g,
            high_g: part.high * a_crit_g,
            factor: part.factor,
        };
        (part.name.to_owned(), part_g)
    });
    std::iter::once(("search".to_owned(), search))
        .chain(others)
        .collect()
}
