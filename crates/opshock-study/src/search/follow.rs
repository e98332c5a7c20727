//! Looks for a failure that was found below the bracket at one pulse width at the neighbouring widths, too.
//!
//! Non-monotone intervals (failing amplitudes below surviving ones) shift with the width about as the bracket does. So
//! the neighbour is scanned over the extent of the interval, three times as finely as usual, at the same amplitudes and
//! at the same distance below its own bracket.

use super::evidence::AmplitudeVerdict;
use super::point::PointSearch;

/// Grid points over which the lowest non-monotone interval of a point may extend, if it lies below its first bracket.
pub(super) fn lower_window(source: &PointSearch) -> Option<(i32, i32)> {
    let (low, high) = source.evidence().non_monotone_interval()?;
    let lower = source.first_failure().is_none_or(|first| low < first);
    lower.then_some((low, high))
}

/// Grid points of `neighbour` at which the interval of `source` may show, `spacing` apart.
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
    let mut grid_points: Vec<i32> = Vec::new();
    let mut offset = low;
    while offset <= high {
        for grid_point in [offset + shift, offset] {
            let near = |other: i32| (other - grid_point).abs() < spacing;
            let known = (grid_point - spacing + 1..grid_point + spacing)
                .any(|other| neighbour.evidence().get(other) == Some(AmplitudeVerdict::Survives));
            if !known
                && !grid_points.iter().any(|&other| near(other))
                && neighbour.is_open_below_failure(grid_point)
            {
                grid_points.push(grid_point);
            }
        }
        offset += spacing;
    }
    grid_points
}
