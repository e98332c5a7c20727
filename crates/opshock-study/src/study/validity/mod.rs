//! Checks what depends on several keys: geometry, pulse against step, search range, outputs.
//!
//! Each rule names the keys it looks at and is skipped while one of them has no usable value, so
//! that one mistake makes one message.

mod base;
mod check;
mod drive;
mod fields;
mod gap;
mod gap_forces;
mod heads;
mod pulse;
mod rails;
mod seen;
mod stops;
mod study;

use super::fault::StudyError;
use super::settings::View;
pub use check::Check;
use seen::Seen;

impl Check<'_, '_> {
    /// Every rule that does not depend on the point.
    pub fn study(&mut self) {
        self.names();
        self.heads();
        self.outputs();
        self.fields();
        self.search();
        self.without_effect();
    }
}

/// A rule about a point, given the widths of the study in ms.
type PointRule = fn(&mut Check<'_, '_>, &[f64]);

/// Every rule about a point, in the order of a study.
const POINT_RULES: [PointRule; 17] = [
    |check, _| check.disk_and_ramp(),
    |check, _| check.hub(),
    |check, _| check.ramp_geometry(),
    |check, _| check.gas(),
    |check, _| check.surface_forces(),
    |check, _| check.asperity_contact(),
    |check, _| check.damage(),
    |check, _| check.waves(),
    |check, _| check.gap_left(),
    |check, _| check.slider_place(),
    |check, _| check.rails(),
    |check, _| check.suspension(),
    |check, _| check.suspension_modes(),
    |check, _| check.stops(),
    |check, _| check.base(),
    |check, widths_ms| check.pulse(widths_ms),
    |check, _| check.fields_end(),
];

/// The rules about points with what each has looked at.
#[derive(Debug, Default)]
pub struct PointRules([Seen; POINT_RULES.len()]);

impl PointRules {
    /// Looks at one combination of the axes; a rule that has seen all it reads there says nothing.
    pub fn check(&mut self, view: &View<'_>, faults: &mut Vec<StudyError>, widths_ms: &[f64]) {
        for (rule, seen) in POINT_RULES.iter().zip(&mut self.0) {
            seen.look(view, || rule(&mut Check { view, faults }, widths_ms));
        }
    }
}
