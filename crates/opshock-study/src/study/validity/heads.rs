//! Rules for a drive of several heads.

use super::check::Check;
use crate::study::fault::StudyError;
use crate::study::fields;
use crate::study::imported_suspension;

const HEADS: &str = "heads";
/// Gap that stands for those of both sides.
const CLEARANCE: &str = fields::RAMP_CLEARANCE_UM.path();
/// Gap of each side, which is used where it is given.
const CLEARANCES: [&str; 2] = [
    fields::RAMP_CLEARANCE_TOP_UM.path(),
    fields::RAMP_CLEARANCE_BOTTOM_UM.path(),
];

impl Check<'_, '_> {
    /// Heads have names of their own, the chosen one is among them, and what they have of their own is no axis
    /// of all of them.
    pub(super) fn heads(&mut self) {
        let settings = self.view.settings;
        let named = settings.named_heads();
        let names: Vec<String> = named.iter().map(|(name, _)| format!("{name:?}")).collect();
        for (position, (name, entry)) in named.iter().enumerate() {
            let path = format!("{HEADS}[{entry}].head");
            let is_second = named[..position].iter().any(|(other, _)| other == name);
            let (message, allowed) = match (name.trim().is_empty(), is_second) {
                (true, _) => ("a head without a name", "a word or more"),
                (_, true) => ("two heads of one name", "names that differ"),
                _ => continue,
            };
            let fault = self.fault("E191", &[&path], message);
            fault.allowed = allowed.to_string();
        }
        if let Some(chosen) = settings.chosen_head() {
            let is_known = named.iter().any(|(name, _)| *name == chosen);
            if !is_known && self.sound(&[HEADS]) {
                let place = settings.get("head").map(|setting| &setting.place);
                let message = match named.is_empty() {
                    true => "a head of a study that names none",
                    false => "no head of that name",
                };
                if let Some(place) = place {
                    let fault = StudyError::at("E191", place, "head", message);
                    let fault = self.push(fault.value(place.text()));
                    fault.allowed = match names.is_empty() {
                        true => "a study with [[heads]]".to_string(),
                        false => names.join(", "),
                    };
                }
            }
        }
        let shared: Vec<&str> = settings
            .per_head()
            .filter(|path| settings.get(path).is_some_and(|setting| setting.is_axis))
            .collect();
        for path in shared {
            let Some(place) = settings.get(path).map(|setting| &setting.place) else {
                continue;
            };
            let message = "an axis of the study that a head has a value of its own for";
            let fault = StudyError::at("E191", place, path, message);
            let fault = self.push(fault.value(place.text()));
            fault.allowed = "one value, or none in [[heads]]".to_string();
        }
        for (_, entry) in named {
            self.without_effect_on(&format!("{HEADS}[{entry}]."));
        }
    }

    /// Refuses a head's clearance beside the study's of one side, and geometry beside modes: they would have no effect.
    fn without_effect_on(&mut self, head: &str) {
        let settings = self.view.settings;
        let own = |path: &str| settings.get(&format!("{head}{path}"));
        let mut blamed = Vec::new();
        if let Some(clearance) = own(CLEARANCE) {
            let hides = |side: &&&str| settings.has(side) && own(side).is_none();
            let side = CLEARANCES.iter().find(hides);
            blamed.extend(side.map(|side| {
                let message = format!("a head's gap on both sides, of which {side} is the study's");
                let allowed = "clearance_top_um and clearance_bottom_um of the head";
                (format!("{head}{CLEARANCE}"), clearance, message, allowed)
            }));
        }
        let modes = imported_suspension::MODES;
        if own(modes).is_some() || settings.has(modes) {
            for path in imported_suspension::REPLACED {
                let axis = settings.get(path).filter(|setting| setting.is_axis);
                let (path, setting) = match (own(path), axis) {
                    (Some(own), _) => (format!("{head}{path}"), own),
                    (None, Some(axis)) => (path.to_string(), axis),
                    (None, None) => continue,
                };
                let message = "geometry of a head's suspension that is given by its modes";
                let allowed = "a geometry, or modes or matrices";
                blamed.push((path, setting, message.to_string(), allowed));
            }
        }
        for (path, setting, message, allowed) in blamed {
            let fault = StudyError::at("E191", &setting.place, &path, message);
            let fault = self.push(fault.value(setting.place.text()));
            fault.allowed = allowed.to_string();
        }
    }
}
