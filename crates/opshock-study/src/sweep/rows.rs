//! Rows of the table from what the searches found.

use super::input::SweepPoint;
use crate::search::{Findings, Lattice, Status};
use crate::store::summary::{ErrorPart, PointSummary};

/// Row of a point.
///
/// The answer lies between the highest survivor, which is reported, and the lowest failure above
/// it: the bracket adds nothing below the reported value and its width above.
pub(super) fn row(
    point: &SweepPoint,
    findings: &Findings,
    onset_g: Option<f64>,
    lattice: &Lattice,
) -> PointSummary {
    let amplitude = |node: i32| lattice.amplitude_g(node);
    let (a_crit_g, a_fail_g) = (
        findings.survivor.map(amplitude),
        findings.failure.map(amplitude),
    );
    let bracket = match (findings.status, a_crit_g, a_fail_g) {
        (Status::Ok, Some(a_crit_g), Some(a_fail_g)) => Some(ErrorPart {
            low_g: 0.0,
            high_g: a_fail_g - a_crit_g,
        }),
        _ => None,
    };
    PointSummary {
        ramp: point.coordinates.ramp.clone(),
        pulse_ms: point.coordinates.pulse_ms,
        sign: point.coordinates.sign,
        axes: point.axes.clone(),
        a_crit_g,
        a_fail_g,
        err_low_g: bracket.as_ref().map(|part| part.low_g),
        err_high_g: bracket.as_ref().map(|part| part.high_g),
        err_parts: bracket
            .into_iter()
            .map(|part| ("bracket".to_owned(), part))
            .collect(),
        onset_g,
        runs: findings.runs,
        status: findings.status,
        flags: findings.flags.iter().copied().collect(),
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
