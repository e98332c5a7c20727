//! Keys that format 2 of the study file names otherwise than format 1 did, for the message about an old file.

use super::fields::*;

/// Path in format 1, path in format 2.
const RENAMED: [(&str, &str); 24] = [
    ("solver.accuracy", RESOLUTION_PRESET.path()),
    ("solver.disk_cut_khz", RESOLUTION_DISK_CUT_KHZ.path()),
    ("solver.disk_harmonics", RESOLUTION_DISK_HARMONICS.path()),
    ("solver.disk_elements", RESOLUTION_DISK_ELEMENTS.path()),
    (
        "solver.static_correction",
        RESOLUTION_STATIC_CORRECTION.path(),
    ),
    (
        "solver.structure_step_us",
        RESOLUTION_STRUCTURE_STEP_US.path(),
    ),
    ("solver.head_tolerance", RESOLUTION_HEAD_TOLERANCE.path()),
    ("solver.approach_share", RESOLUTION_APPROACH_SHARE.path()),
    ("solver.film_cells", RESOLUTION_FILM_CELLS.path()),
    (
        "solver.film_reference_cells",
        RESOLUTION_FILM_CORRECTION_CELLS.path(),
    ),
    ("solver.film_floor_nm", RESOLUTION_MIN_FILM_HEIGHT_NM.path()),
    (
        "solver.coupling_tolerance",
        RESOLUTION_COUPLING_TOLERANCE.path(),
    ),
    (
        "solver.suspension_modes",
        RESOLUTION_SUSPENSION_MODES.path(),
    ),
    ("solver.not_refined", RESOLUTION_NOT_REFINED.path()),
    ("solver.fail_below_nm", FAILURE_CLEARANCE_NM.path()),
    ("search.climbs", SEARCH_MAX_REFINEMENTS.path()),
    ("search.error_bars", SEARCH_UNCERTAINTY.path()),
    ("search.certify", SEARCH_MONOTONICITY_SCAN.path()),
    ("search.max_gap_pct", SEARCH_SCAN_GAP_PCT.path()),
    (
        "search.refine.tolerance_pct",
        SEARCH_ADDED_POINTS_TOLERANCE_PCT.path(),
    ),
    (
        "search.refine.crossing_pct",
        SEARCH_ADDED_POINTS_CROSSING_PCT.path(),
    ),
    (
        "search.refine.closest_pct",
        SEARCH_ADDED_POINTS_CLOSEST_PCT.path(),
    ),
    (
        "search.refine.most_points",
        SEARCH_ADDED_POINTS_MAX_POINTS.path(),
    ),
    ("search.refine", "search.added_points"),
];

/// What format 2 calls the key of format 1 at `path`.
pub(super) fn today(path: &str) -> Option<&'static str> {
    let found = RENAMED.iter().find(|(old, _)| *old == path);
    found.map(|(_, new)| *new)
}
