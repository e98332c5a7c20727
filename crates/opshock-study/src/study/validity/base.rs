//! A base that vibrates.

use super::Check;

const MODES: &str = "base.modes";
/// Most modes that a base may have.
const MOST: usize = 16;
/// What a vibrating base is not combined with: its tilt would have to turn the rotor.
const APART: [&str; 2] = [
    "hub.axial_stiffness_n_per_m",
    "hub.tilt_stiffness_n_m_per_rad",
];

impl Check<'_, '_> {
    /// A vibrating base carries a clamped disk, is heavier than it, and has no more modes than there is room for.
    pub(super) fn base(&mut self) {
        let n = self.view.entries(MODES);
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
            "disk.inner_radius_mm",
            "disk.outer_radius_mm",
            "disk.thickness_mm",
            "disk.density_kg_per_m3",
        ];
        if self.sound(&disk) {
            let [inner_m, outer_m, thickness_m, density] = disk.map(|path| self.view.si(path));
            let area = std::f64::consts::PI * (outer_m * outer_m - inner_m * inner_m);
            let mass_kg = density * thickness_m * area;
            let shape = |k: usize| self.view.si(&format!("{MODES}[{k}].spindle_per_sqrt_kg"));
            let share: f64 = (0..n).map(|k| shape(k).powi(2) * mass_kg).sum();
            if share >= 1.0 {
                let message = format!(
                    "modes of the base with {:.3} of the disk's mass",
                    1.0 / share
                );
                let fault = self.fault("E189", &[MODES], message);
                fault.allowed = format!(
                    "sum of spindle_per_sqrt_kg squared below {:.1} 1/kg",
                    1.0 / mass_kg
                );
                fault.hint = "are they of unit modal mass, in kg?".to_string();
            }
        }
        let given: Vec<&str> = APART
            .into_iter()
            .filter(|path| self.view.maybe_number(path).is_some())
            .collect();
        if !given.is_empty() {
            let message = "modes of the base beside a hub";
            let fault = self.fault("E189", &[MODES], message);
            fault.allowed = "a disk clamped to the base, or a rigid base".to_string();
            fault.hint = "leave [hub] or base.modes out".to_string();
        }
    }
}
