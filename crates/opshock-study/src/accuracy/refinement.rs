//! Refinement studies: the settings that each discretisation parameter takes, and the reference of each.

use opshock_solver::ramp::{ArmMode, Arms, RampModel};
use opshock_solver::scene::Scene;
use opshock_solver::scene::discretisation::Discretisation;
use opshock_solver::scene::preset::{Preset, Resolutions, resolutions};
use opshock_solver::suspension::ReducedSuspension;

/// Relative width to which critical shocks are bracketed, except in the refinement study of that width itself.
pub const BRACKET: f64 = 2.0e-3;

/// Search tolerance about which its refinement study is centred.
const SEARCH_TOLERANCE: f64 = 1.0e-2;

/// One setting of a refinement study.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Refinement study it belongs to.
    pub parameter: &'static str,
    /// Value of the discretisation parameter, as the study's key has it.
    pub value: String,
    /// Fineness: the error falls with this number to the power of the discretisation parameter's order.
    pub fineness: f64,
    /// The refinement study's reference.
    pub is_reference: bool,
    /// Relative width to which the critical shock is bracketed.
    pub bracket: f64,
    /// Scene with the discretisation parameter there.
    pub scene: Scene,
}

/// Order with which a refinement study's error falls with its fineness where no contact lies between.
pub fn formal_order(parameter: &str) -> Option<f64> {
    match parameter {
        // Cells of a plane grid: second order in the spacing.
        "film_cells" => Some(1.0),
        "disk_cut_khz" | "structure_step_us" | "coupling_tolerance" => Some(1.0),
        "suspension_modes" => Some(2.0),
        "head_tolerance" => Some(2.0 / 3.0),
        _ => None,
    }
}

/// Quantity of a shock on which a refinement study's observed order is read.
pub fn order_quantity(parameter: &str) -> &'static str {
    match parameter {
        "film_cells" | "film_cells_corrected" => "flying_height",
        "search_tolerance_pct" => "critical_shock",
        "disk_cut_khz" | "disk_harmonics" | "structure_step_us" | "ramp_modes" => "contact_impulse",
        _ => "min_clearance",
    }
}

/// A scene's refinement study of every discretisation parameter, with a reference ten times finer; then joint ones.
///
/// `film_cells` is the grid without correction, `film_cells_corrected` with defect correction, which has no order. All
/// refinement studies but those of the film and the joint ones use a film of a quarter of the cells, reference
/// included: the effect of the other discretisation parameters hardly depends on it.
pub fn refinement_settings(scene: &Scene) -> Vec<Setting> {
    let small = scene.at_levels(
        opshock_solver::scene::discretisation::Levels::NONE.changed(Discretisation::FilmGrid, -2),
    );
    let has_ramp = !small.ramp.model.is_absent();
    let mut all = Vec::new();
    if has_ramp {
        let base = small.disk_resolution.clone();
        for (factor, is_reference) in factors([0.125, 0.25, 0.5, 1.0, 2.0], 10.0) {
            let mut at = small.clone();
            at.disk_resolution.n_harmonics = count(base.n_harmonics, factor);
            let value = at.disk_resolution.n_harmonics.to_string();
            all.push(setting("disk_harmonics", value, factor, is_reference, at));
        }
        for (factor, is_reference) in factors([0.25, 0.5, 1.0, 2.0, 4.0], 16.0) {
            let mut at = small.clone();
            let waves = f64::max(1.0, factor).sqrt();
            at.disk_resolution.cut_hz *= factor;
            at.disk_resolution.n_harmonics = count(base.n_harmonics, waves);
            at.disk_resolution.n_elements = count(base.n_elements, waves);
            let value = (at.disk_resolution.cut_hz / 1e3).to_string();
            all.push(setting("disk_cut_khz", value, factor, is_reference, at));
        }
        for (factor, is_reference) in factors([0.125, 0.25, 0.5, 1.0, 2.0], 10.0) {
            let mut at = small.clone();
            at.structure_resolution.step_s /= factor;
            let value = format!("{:.4}", 1e6 * at.structure_resolution.step_s);
            all.push(setting(
                "structure_step_us",
                value,
                factor,
                is_reference,
                at,
            ));
        }
    }
    if let Some([top, bottom]) = small.ramp.model.arms() {
        // The arm's modes are the model itself: the reference is what the study gives.
        let all_modes = top.len().max(bottom.len());
        for kept in 1..=all_modes {
            let mut at = small.clone();
            let first = |arm: &[ArmMode]| arm.iter().take(kept).copied().collect();
            let kept_modes = Arms {
                top: first(&top),
                bottom: first(&bottom),
            };
            at.ramp.model.contacts = kept_modes.contacts();
            let (value, is_reference) = (kept.to_string(), kept == all_modes);
            all.push(setting("ramp_modes", value, kept as f64, is_reference, at));
        }
    }
    let modes = small.head_resolution.suspension_modes;
    // No beam has ten times as many: the reference has all of them.
    let most = ReducedSuspension::most_bending_modes(&small.suspension).unwrap_or(modes);
    for factor in [0.0625, 0.125, 0.25, 0.5, 1.0] {
        let mut at = small.clone();
        at.head_resolution.suspension_modes = count(modes, factor).min(most);
        let value = at.head_resolution.suspension_modes.to_string();
        all.push(setting("suspension_modes", value, factor, false, at));
    }
    let mut whole = small.clone();
    whole.head_resolution.suspension_modes = most;
    let fineness = most as f64 / modes as f64;
    all.push(setting(
        "suspension_modes",
        most.to_string(),
        fineness,
        true,
        whole,
    ));
    for (factor, is_reference) in factors([0.2, 0.5, 1.0, 2.0, 4.0], 100.0) {
        let mut at = small.clone();
        at.head_resolution.tolerance /= factor;
        // Rounded, so that 0.02 / 0.2 is written as 0.1.
        let value = ((at.head_resolution.tolerance * 1e12).round() / 1e12).to_string();
        all.push(setting("head_tolerance", value, factor, is_reference, at));
    }
    for (factor, is_reference) in factors([0.25, 0.5, 1.0, 4.0, 16.0], 100.0) {
        let mut at = small.clone();
        at.head_resolution.coupling_tolerance /= factor;
        let value = format!("{:e}", at.head_resolution.coupling_tolerance);
        all.push(setting(
            "coupling_tolerance",
            value,
            factor,
            is_reference,
            at,
        ));
    }
    // No order: below twice the minimum film height the film is another one.
    for (factor, is_reference) in factors([0.25, 0.5, 1.0, 2.0, 4.0], 10.0) {
        let mut at = small.clone();
        at.film_resolution.min_height_m /= factor;
        let value = format!("{:.4}", 1e9 * at.film_resolution.min_height_m);
        all.push(setting(
            "min_film_height_nm",
            value,
            factor,
            is_reference,
            at,
        ));
    }
    // No order either: half the bracket is a bound; the answer may lie anywhere in it.
    for (factor, is_reference) in factors([0.25, 0.5, 1.0, 2.0, 4.0], 40.0) {
        let bracket = SEARCH_TOLERANCE / factor;
        all.push(Setting {
            bracket,
            ..setting(
                "search_tolerance_pct",
                (100.0 * bracket).to_string(),
                factor,
                is_reference,
                small.clone(),
            )
        });
    }
    for (factor, is_reference) in factors([0.125, 0.25, 0.5, 1.0, 2.0], 10.0) {
        let mut at = scene.clone();
        at.film_resolution.cells = count(scene.film_resolution.cells, factor);
        at.film_resolution.correction_cells = 0;
        let value = at.film_resolution.cells.to_string();
        all.push(setting("film_cells", value, factor, is_reference, at));
    }
    if scene.film_resolution.correction_cells > 0 {
        all.extend(corrected(scene));
    }
    all.extend(joint(scene));
    all
}

/// Cells of a film with defect correction. The refinement study's reference has four times the cells in its
/// defect-correction grid, so that it does not share the error.
fn corrected(scene: &Scene) -> Vec<Setting> {
    let factors = factors([0.125, 0.25, 0.5, 1.0, 2.0], 10.0);
    let at = |(factor, is_reference)| {
        let mut at = scene.clone();
        at.film_resolution.cells = count(scene.film_resolution.cells, factor);
        if is_reference {
            at.film_resolution.correction_cells *= 4;
        }
        let value = at.film_resolution.cells.to_string();
        setting("film_cells_corrected", value, factor, is_reference, at)
    };
    factors.map(at).collect()
}

/// The named presets, one coarser and two between, against a scene finer than all of them.
fn joint(scene: &Scene) -> Vec<Setting> {
    let with = |resolutions: Resolutions| {
        let mut at = scene.clone();
        at.disk_resolution = resolutions.disk;
        at.structure_resolution = resolutions.structure;
        at.film_resolution = resolutions.film;
        at.head_resolution = resolutions.head;
        at
    };
    let at_cells = |preset: Preset, cells: usize| {
        let mut at = with(resolutions(preset));
        at.film_resolution.cells = cells;
        at
    };
    let mut finest = with(resolutions(Preset::Fine));
    finest.film_resolution.cells = 4 * resolutions(Preset::Standard).film.cells;
    let one = resolutions(Preset::Standard).film.cells;
    let five = resolutions(Preset::Coarse).film.cells;
    vec![
        setting(
            "joint",
            "coarse with a quarter of the cells".into(),
            0.5,
            false,
            at_cells(Preset::Coarse, five / 4),
        ),
        setting(
            "joint",
            "coarse".into(),
            1.0,
            false,
            with(resolutions(Preset::Coarse)),
        ),
        setting(
            "joint",
            "standard with half the cells".into(),
            1.5,
            false,
            at_cells(Preset::Standard, one / 2),
        ),
        setting(
            "joint",
            "standard".into(),
            2.0,
            false,
            with(resolutions(Preset::Standard)),
        ),
        setting(
            "joint",
            "standard with twice the cells".into(),
            4.0,
            false,
            at_cells(Preset::Standard, 2 * one),
        ),
        setting(
            "joint",
            "fine with four times the cells of standard".into(),
            8.0,
            true,
            finest,
        ),
    ]
}

fn setting(
    parameter: &'static str,
    value: String,
    fineness: f64,
    is_reference: bool,
    scene: Scene,
) -> Setting {
    Setting {
        parameter,
        value,
        fineness,
        is_reference,
        bracket: BRACKET,
        scene,
    }
}

fn factors(factors: [f64; 5], reference: f64) -> impl Iterator<Item = (f64, bool)> {
    let factors = factors.into_iter().map(|factor| (factor, false));
    factors.chain([(reference, true)])
}

fn count(base: usize, factor: f64) -> usize {
    ((base as f64 * factor).round() as usize).max(1)
}
