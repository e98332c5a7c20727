//! A whole drive, simulated within milliseconds.

use crate::study::{SetArg, Study};
use opshock_solver::scene::Scene;

/// Paper-like drive with the rigid ramp, for half a millisecond on a coarse film.
///
/// # Panics
/// When the example study is not sound.
pub fn small_scene() -> Scene {
    let sets: Vec<SetArg> = [
        "ramp.models=[\"rigid\"]",
        "pulse.widths_ms=[0.5]",
        "pulse.signs=[\"+\"]",
        "pulse.window_ms=0.8",
        "resolution.film_cells=150",
        "resolution.disk_cut_khz=10",
        "resolution.head_tolerance=0.1",
        "ramp.clearance_um=40",
    ]
    .iter()
    .map(|set| SetArg::parse(set).expect("a setting"))
    .collect();
    let study = Study::from_text(&Study::example("hard case"), &sets).expect("a sound study");
    study.points[0].scene.clone()
}
