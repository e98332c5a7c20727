//! Keys and words that format 2 of the study file names otherwise than format 1 did, for the messages about an old file.

use super::fields::*;
use super::words::preset_word;
use crate::search::MonotonicityScan;
use opshock_solver::scene::preset::Preset;

/// Path in format 1, path in format 2.
const KEYS: [(&str, &str); 20] = [
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
    ("search.refine", "search.added_points"),
];

/// Path in format 2, word in format 1, word in format 2.
const WORDS: [(&str, &str, &str); 4] = [
    (RESOLUTION_PRESET.path(), "5%", preset_word(Preset::Coarse)),
    (
        RESOLUTION_PRESET.path(),
        "1%",
        preset_word(Preset::Standard),
    ),
    (RESOLUTION_PRESET.path(), "0.1%", preset_word(Preset::Fine)),
    (
        SEARCH_MONOTONICITY_SCAN.path(),
        "staggered",
        MonotonicityScan::Sampled.as_str(),
    ),
];

/// What format 2 calls the key of format 1 at `path`.
pub(super) fn key_today(path: &str) -> Option<&'static str> {
    let found = KEYS.iter().find(|(old, _)| *old == path);
    found.map(|(_, new)| *new)
}

/// What format 2 calls a word of format 1, at the path of format 2.
pub(super) fn word_today(path: &str, word: &str) -> Option<&'static str> {
    let is_it = |(key, old, _): &&(&str, &str, &str)| *key == path && *old == word;
    WORDS.iter().find(is_it).map(|(_, _, new)| *new)
}
