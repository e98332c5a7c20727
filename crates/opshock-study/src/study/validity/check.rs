//! What every rule works on: the settings of one point, and the list that its faults go to.

use crate::study::fault::StudyError;
use crate::study::settings::View;

/// Collects the faults of one point of a study.
pub struct Check<'a, 'f> {
    /// The point's settings.
    pub view: &'f View<'a>,
    /// Where faults go.
    pub faults: &'f mut Vec<StudyError>,
}

impl Check<'_, '_> {
    /// Whether all these keys have usable values.
    pub(super) fn sound(&self, paths: &[&str]) -> bool {
        self.view.are_sound(paths)
    }

    /// A fault at the key, of those a rule looks at, that the user wrote last.
    pub(super) fn fault(
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

    pub(super) fn push(&mut self, fault: StudyError) -> &mut StudyError {
        let at = self.faults.len();
        self.faults.push(fault);
        &mut self.faults[at]
    }
}

/// A number without the digits a conversion added.
pub(super) fn trim(value: f64) -> String {
    let text = format!("{value:.9}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}
