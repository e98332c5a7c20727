//! Limits the number of values on an axis and of points in a study.

use crate::study::fault::StudyError;
use crate::study::source::Place;

/// Most values of one axis, and most points of a study.
pub const MAX_POINTS: usize = 100_000;

/// The refusal of a study with too many points, with what it would cost.
pub fn too_many_points(place: &Place, path: &str, count: f64) -> StudyError {
    // About 15 simulations of 0.3 s and 300 bytes in the journal each.
    let hours = count * 15.0 * 0.3 / 3600.0;
    let gigabytes = count * 15.0 * 300.0 / 1e9;
    StudyError::at(
        "E155",
        place,
        path,
        format!(
            "{count:.0} points are too many: about {hours:.0} core hours and {gigabytes:.1} GB"
        ),
    )
    .value(place.text())
    .allowed(format!("at most {MAX_POINTS} points"))
    .hint("split the study, or take coarser axes")
}
