//! Order in which uncertainty intervals are made: first where two answers along an axis may be the same.

use std::collections::HashMap;

use crate::search::{Campaign, Sign};
use crate::sweep::input::SweepInput;

/// Ranks of the points, for intervals: those whose bracket, widened by the target uncertainty, overlaps that of the next
/// value along an axis (ramp model, width or further axis) come first; otherwise by `rank`.
pub(super) fn interval_ranks(
    input: &SweepInput,
    campaign: &Campaign,
    rank: &[usize],
) -> Vec<usize> {
    let overlaps = overlapping(input, campaign);
    let mut places: Vec<usize> = (0..rank.len()).collect();
    places.sort_by_key(|&point| (!overlaps[point], rank[point]));
    let mut ranks = vec![0; rank.len()];
    for (k, point) in places.into_iter().enumerate() {
        ranks[point] = k;
    }
    ranks
}

/// Whether a point's widened bracket overlaps that of a neighbour along an axis.
fn overlapping(input: &SweepInput, campaign: &Campaign) -> Vec<bool> {
    let ranges: Vec<Option<[i32; 2]>> = input
        .points
        .iter()
        .enumerate()
        .map(|(point, one)| {
            let findings = campaign.findings(point);
            let target = one.uncertainty.as_ref()?.target;
            let width = input.settings.grid.steps_within(target);
            Some([findings.survivor? - width, findings.failure? + width])
        })
        .collect();
    let mut found = vec![false; input.points.len()];
    let n_axes = input.axes.len();
    // Axis 0 is the ramp model, 1 the width.
    for axis in 0..2 + n_axes {
        let mut lines: HashMap<(u8, u64, Sign, Vec<&str>), Vec<usize>> = HashMap::new();
        for (point, one) in input.points.iter().enumerate() {
            let at = &one.coordinates;
            let ramp = if axis == 0 { 0 } else { at.ramp as u8 };
            let width = if axis == 1 { 0 } else { at.pulse_ms.to_bits() };
            let others = at.axes.iter().enumerate();
            let others = others.filter(|(place, _)| place + 2 != axis);
            let others = others.map(|(_, value)| value.as_str()).collect();
            let line = lines.entry((ramp, width, at.sign, others)).or_default();
            line.push(point);
        }
        for mut line in lines.into_values() {
            line.sort_by(|&a, &b| {
                let (a, b) = (&input.points[a].coordinates, &input.points[b].coordinates);
                let widths = a.pulse_ms.total_cmp(&b.pulse_ms);
                a.ramp
                    .cmp(&b.ramp)
                    .then(widths)
                    .then_with(|| a.axes.cmp(&b.axes))
            });
            for pair in line.windows(2) {
                let (Some(a), Some(b)) = (ranges[pair[0]], ranges[pair[1]]) else {
                    continue;
                };
                if a[0] <= b[1] && b[0] <= a[1] {
                    found[pair[0]] = true;
                    found[pair[1]] = true;
                }
            }
        }
    }
    found
}
