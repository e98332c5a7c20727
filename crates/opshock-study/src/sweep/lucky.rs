//! Warnings about failures below an answer that no search requested.

use super::input::SweepInput;
use super::registry::Registry;
use crate::search::Verdict;
use crate::store::summary::{PointSummary, Status};
use crate::store::{PointDigest, Results};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use std::collections::HashMap;

/// Failures below a point's answer that no search requested: computed ahead, or of an earlier form of the study. They
/// do not enter the answer, which would then depend on chance.
pub(super) fn lucky(input: &SweepInput, registry: &Registry<'_>, results: &Results) -> Vec<String> {
    let mut places: HashMap<PointDigest, Vec<usize>> = HashMap::new();
    for (place, point) in input.points.iter().enumerate() {
        places.entry(point.digest).or_default().push(place);
    }
    let mut messages = Vec::new();
    for record in &results.outside {
        let fails = matches!(record.result.verdict, Verdict::Fails { .. });
        if !fails || record.key.window_factor != 1 {
            continue;
        }
        let amplitude = f64::from_bits(record.key.amplitude_bits).abs();
        let amplitude_g = amplitude / STANDARD_GRAVITY_M_PER_S2;
        for &place in places.get(&record.key.point).into_iter().flatten() {
            let row = &results.summary.points[place];
            if is_below_answer(row, registry.failure_g(place), amplitude_g) {
                messages.push(format!(
                    "{} {} ms {}: a run outside the search fails at {amplitude_g:.4} G, below \
                     the answer; a smaller search.scan_gap_pct or search.monotonicity_scan = \"full\" would find \
                     it",
                    row.ramp,
                    row.pulse_ms,
                    row.sign.as_str()
                ));
            }
        }
    }
    messages
}

/// An amplitude lies below the lowest failure that the search found at the study's own resolution (a refined answer
/// does not matter); below the end of the range where it found none.
fn is_below_answer(row: &PointSummary, failure_g: Option<f64>, amplitude_g: f64) -> bool {
    match (row.status, failure_g) {
        (Status::Open, _) => false,
        (_, Some(failure_g)) => amplitude_g < failure_g * (1.0 - 1e-9),
        (_, None) => row.survived_g.is_some(),
    }
}
