//! A failure below the bracket at one width is looked for at its neighbours.
//!
//! Windows of failure shift with the width about as the bracket does, so the neighbour is scanned
//! over the extent of the window, three times as finely as usual, at the same amplitudes and at the
//! same distance below its own bracket.

use super::evidence::NodeVerdict;
use super::point::PointSearch;

/// Nodes over which the lowest window of failure of a point may extend, if it lies below its first
/// bracket.
pub(super) fn lower_window(source: &PointSearch) -> Option<(i32, i32)> {
    let (low, high) = source.evidence().window_of_failure()?;
    let lower = source.first_failure().is_none_or(|first| low < first);
    lower.then_some((low, high))
}

/// Nodes of `neighbour` at which the window of `source` may show, `spacing` apart.
pub(super) fn targets(
    source: &PointSearch,
    (low, high): (i32, i32),
    neighbour: &PointSearch,
    spacing: i32,
) -> Vec<i32> {
    let shift = match (source.first_failure(), neighbour.first_failure()) {
        (Some(from), Some(to)) => to - from,
        _ => 0,
    };
    let mut nodes: Vec<i32> = Vec::new();
    let mut offset = low;
    while offset <= high {
        for node in [offset + shift, offset] {
            let near = |other: i32| (other - node).abs() < spacing;
            let known = (node - spacing + 1..node + spacing)
                .any(|other| neighbour.evidence().get(other) == Some(NodeVerdict::Survives));
            if !known
                && !nodes.iter().any(|&other| near(other))
                && neighbour.is_open_below_failure(node)
            {
                nodes.push(node);
            }
        }
        offset += spacing;
    }
    nodes
}
