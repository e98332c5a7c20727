//! Rules for a base that vibrates.

use super::check::Check;
use crate::study::field::Field;
use crate::study::fields;
use crate::study::imported_base::{MODES, MOST};

/// What a vibrating base is not combined with: its modes are loaded along the axis only.
const APART: [&str; 4] = [
    fields::PULSE_IN_PLANE_X.path(),
    fields::PULSE_IN_PLANE_Y.path(),
    fields::PULSE_ROTATION_X_PER_M.path(),
    fields::PULSE_ROTATION_Y_PER_M.path(),
];

impl Check<'_, '_> {
    /// A vibrating base takes a straight shock, is heavier than disk and hub, and has no more than the allowed modes.
    pub(super) fn base(&mut self) {
        let n = self.view.get(&fields::BASE_MODES);
        if n == 0 || !self.sound(&[MODES]) {
            return;
        }
        if n > MOST {
            let message = format!("a base of {n} modes");
            let fault = self.fault("E189", &[MODES], message);
            fault.allowed = format!("at most {MOST}");
            fault.hint = "keep the lowest".to_string();
        }
        let disk = [
            fields::DISK_INNER_RADIUS_MM,
            fields::DISK_OUTER_RADIUS_MM,
            fields::DISK_THICKNESS_MM,
            fields::DISK_DENSITY_KG_PER_M3,
        ];
        if self.sound(&disk.each_ref().map(Field::path)) {
            let [inner_m, outer_m, thickness_m, density] =
                disk.each_ref().map(|field| self.view.get(field));
            let area = std::f64::consts::PI * (outer_m * outer_m - inner_m * inner_m);
            let hub_kg = self.view.get(&fields::HUB_MASS_MG).unwrap_or(0.0);
            let mass_kg = density * thickness_m * area + hub_kg;
            let shape = |k| self.view.entry(k, &fields::BASE_MODES_SPINDLE_PER_SQRT_KG);
            let share: f64 = (0..n).map(|k| shape(k).powi(2) * mass_kg).sum();
            if share >= 1.0 {
                let carried = if hub_kg > 0.0 {
                    "disk and hub"
                } else {
                    "the disk"
                };
                let message = format!(
                    "the effective mass of these modes at the spindle is {:.3} g, less than that of {carried} on it, {:.3} g",
                    1e3 * mass_kg / share,
                    1e3 * mass_kg
                );
                let fault = self.fault("E189", &[MODES], message);
                fault.allowed = format!(
                    "sum of spindle_per_sqrt_kg squared below {:.1} 1/kg, now {:.1}",
                    1.0 / mass_kg,
                    share / mass_kg
                );
                fault.hint = format!(
                    "give modes of the base with {carried} on it as a mass, of unit modal mass, in kg"
                );
            }
        }
        let given: Vec<&str> = APART
            .into_iter()
            .filter(|path| {
                self.view
                    .maybe_number(path)
                    .is_some_and(|share| share != 0.0)
            })
            .collect();
        if !given.is_empty() {
            let message = "modes of the base under an oblique shock";
            let fault = self.fault("E189", &[MODES], message);
            fault.allowed = "a straight shock, or a rigid base".to_string();
            fault.hint = format!("leave {} or base.modes out", given.join(", "));
        }
    }
}
