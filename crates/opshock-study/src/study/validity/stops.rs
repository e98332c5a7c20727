//! Rules for limiters and lift tab of the suspension.

use super::check::Check;
use crate::study::fields;
use crate::study::imported_suspension;

/// Keys of the limiters besides the gap that makes them.
const OF_LIMITERS: [&str; 5] = [
    fields::SUSPENSION_LIMITERS_GAP_OUTER_UM.path(),
    fields::SUSPENSION_LIMITERS_ALONG_MM.path(),
    fields::SUSPENSION_LIMITERS_ACROSS_MM.path(),
    fields::SUSPENSION_LIMITERS_STIFFNESS_N_PER_M.path(),
    fields::SUSPENSION_LIMITERS_DAMPING_RATIO.path(),
];
/// Keys of the lift tab besides its gap.
const OF_LIFT_TAB: [&str; 2] = [
    fields::SUSPENSION_LIFT_TAB_STIFFNESS_N_PER_M.path(),
    fields::SUSPENSION_LIFT_TAB_DAMPING_RATIO.path(),
];
const LIMITER_GAP: &str = fields::SUSPENSION_LIMITERS_GAP_UM.path();
const LIFT_TAB_GAP: &str = fields::SUSPENSION_LIFT_TAB_GAP_UM.path();

impl Check<'_, '_> {
    /// A stop has a gap, and a lift tab a geometry that says how far it rises.
    pub(super) fn stops(&mut self) {
        for (what, gap, rest) in [
            ("limiters", LIMITER_GAP, OF_LIMITERS.as_slice()),
            ("a lift tab", LIFT_TAB_GAP, OF_LIFT_TAB.as_slice()),
        ] {
            let has = |path: &&&str| self.view.datum(path).is_some();
            let given: Vec<&str> = rest.iter().filter(has).copied().collect();
            if !given.is_empty() && self.view.datum(gap).is_none() {
                let message = format!("{what} without gap_um");
                let fault = self.fault("E112", &given, message);
                fault.allowed = "gap_um beside the rest".to_string();
                fault.hint = "add it, or leave the rest out".to_string();
            }
        }
        let modes = imported_suspension::MODES;
        if self.sound(&[LIFT_TAB_GAP, modes])
            && self.view.datum(LIFT_TAB_GAP).is_some()
            && self.view.get(&fields::SUSPENSION_MODES) > 0
        {
            let message = "a lift tab on a suspension given by its modes, which say nothing of it";
            let fault = self.fault("E139", &[LIFT_TAB_GAP], message);
            fault.allowed = "a suspension by its geometry".to_string();
            fault.hint = "leave lift_tab out".to_string();
        }
    }
}
