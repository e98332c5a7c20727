//! Several heads.

use super::Check;

const HEADS: &str = "heads";

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
                    let fault = crate::study::fault::StudyError::at("E191", place, "head", message);
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
            let fault = crate::study::fault::StudyError::at("E191", place, path, message);
            let fault = self.push(fault.value(place.text()));
            fault.allowed = "one value, or none in [[heads]]".to_string();
        }
    }
}
