//! Scenes by name, read from the committed studies.

use opshock_solver::scene::Scene;
use opshock_study::study::{SetArg, Study};

/// Path of a study of the project.
pub fn study_path(name: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../studies")
        .join(name)
        .join("study.toml")
}

/// A study of the project with some keys set, as `("section.key", "value")`.
///
/// # Panics
/// When the study has faults.
pub fn study(name: &str, sets: &[(&str, &str)]) -> Study {
    let sets: Vec<SetArg> = sets
        .iter()
        .map(|(key, value)| {
            format!("{key}={value}")
                .parse()
                .expect("a well-formed setting")
        })
        .collect();
    Study::from_path(&study_path(name), &sets).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The scene of a one-point study made from `name`.
///
/// # Panics
/// When the study has faults.
pub fn scene(name: &str, ramp: &str, pulse_ms: f64, sets: &[(&str, &str)]) -> Scene {
    let mut all = vec![
        ("ramp.models".to_string(), format!("[\"{ramp}\"]")),
        ("pulse.widths_ms".to_string(), format!("[{pulse_ms}]")),
        ("pulse.signs".to_string(), "[\"+\"]".to_string()),
    ];
    all.extend(
        sets.iter()
            .map(|(key, value)| (key.to_string(), value.to_string())),
    );
    let borrowed: Vec<(&str, &str)> = all.iter().map(|(k, v)| (k.as_str(), v.as_str())).collect();
    study(name, &borrowed).points[0].scene.clone()
}

/// The paper's drive with the deformable ramp, pulse of `width_s`, and about `cells` film cells.
///
/// # Panics
/// When the study has faults.
pub fn paper_deformable(width_s: f64, window_s: f64, cells: usize) -> Scene {
    let mut scene = scene("fig13-stiffness", "deformable", 1e3 * width_s, &[]);
    scene.window = opshock_solver::scene::Window::Fixed { length_s: window_s };
    scene.film_resolution.cells = cells;
    scene
}
