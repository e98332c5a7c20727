//! What depends on several keys: geometry, pulse against step, search range, outputs.
//!
//! Each rule names the keys it looks at and is skipped while one of them has no usable value, so
//! that one mistake makes one message.

mod drive;
mod fields;
mod pulse;
mod rails;
mod study;

use super::fault::StudyError;
use super::keys;
use super::settings::View;

/// Collects the faults of one point of a study.
pub struct Check<'a, 'f> {
    /// The point's settings.
    pub view: &'f View<'a>,
    /// Where faults go.
    pub faults: &'f mut Vec<StudyError>,
}

impl Check<'_, '_> {
    /// Every rule that does not depend on the point.
    pub fn study(&mut self) {
        self.names();
        self.outputs();
        self.fields();
        self.search();
        self.without_effect();
    }

    /// Every rule about a point.
    pub fn point(&mut self, widths_ms: &[f64]) {
        self.disk_and_ramp();
        self.ramp_geometry();
        self.gas();
        self.slider_place();
        self.rails();
        self.suspension();
        self.pulse(widths_ms);
        self.fields_end();
    }

    fn sound(&self, paths: &[&str]) -> bool {
        self.view.settings.are_sound(paths)
    }

    /// A fault at the key, of those a rule looks at, that the user wrote last.
    fn fault(
        &mut self,
        code: &'static str,
        paths: &[&str],
        message: impl Into<String>,
    ) -> &mut StudyError {
        let blamed = paths
            .iter()
            .filter_map(|path| self.view.place(path).map(|place| (*path, place)))
            .rev()
            .max_by_key(|(_, place)| place.origin);
        let fault = match blamed {
            Some((path, place)) => StudyError::at(code, place, path, message).value(place.text()),
            None => StudyError::in_file(code, "study", message),
        };
        self.push(fault)
    }

    fn push(&mut self, fault: StudyError) -> &mut StudyError {
        let at = self.faults.len();
        self.faults.push(fault);
        &mut self.faults[at]
    }
}

/// Whether an output needs film, slider and suspension.
pub fn needs_head(output: &str) -> bool {
    !keys::STRUCTURE_OUTPUTS.contains(&output)
}

/// A number without the digits a conversion added.
fn trim(value: f64) -> String {
    let text = format!("{value:.9}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}
