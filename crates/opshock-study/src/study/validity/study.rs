//! Rules that hold for a study as a whole: names, outputs, search, keys without effect.

use super::{Check, needs_head};
use crate::study::settings::Datum;
use crate::study::source::Origin;
use crate::study::words::{self, Effects};
use crate::study::{imported_suspension, keys};

impl Check<'_, '_> {
    pub(super) fn names(&mut self) {
        if !self.sound(&["name"]) {
            return;
        }
        let name = self.view.word("name");
        let wrong = if name.trim().is_empty() {
            Some("must not be empty")
        } else if name
            .chars()
            .any(|letter| letter == '/' || letter.is_control())
        {
            Some("must not hold / or control characters")
        } else if name.chars().count() > 200 {
            Some("must not be longer than 200 characters")
        } else {
            None
        };
        if let Some(message) = wrong {
            let fault = self.fault("E159", &["name"], message);
            fault.allowed =
                "text of 1 to 200 characters without / and control characters".to_string();
        }
    }

    pub(super) fn outputs(&mut self) {
        if !self.sound(&["outputs"]) {
            return;
        }
        let outputs = self.view.words("outputs");
        if outputs.is_empty() {
            let fault = self.fault("E158", &["outputs"], "no output is asked for");
            fault.allowed = keys::find("outputs")
                .map(|key| key.kind.allowed())
                .unwrap_or_default();
        }
        if let Some(twice) = repeated(outputs) {
            let fault = self.fault("E159", &["outputs"], format!("asks for {twice} twice"));
            fault.allowed = "each output once".to_string();
        }
        if !self.sound(&["solver.leave_out", "solver.effects"]) {
            return;
        }
        let left_out = self.view.words("solver.leave_out");
        let left_out = left_out.iter().any(|effect| effect == "air_bearing");
        let asks = outputs.iter().find(|output| needs_head(output));
        if let (Some(output), true) = (asks, left_out) {
            let fault = self.fault(
                "E158",
                &["solver.leave_out"],
                format!("{output} needs air_bearing, which is left out"),
            );
            fault.allowed = format!(
                "[], or outputs of disk and ramp alone: {}",
                keys::STRUCTURE_OUTPUTS.join(", ")
            );
            fault.hint = format!("remove {output} from outputs, or do not leave air_bearing out");
        }
        let full =
            self.view.chosen("solver.effects", &words::EFFECTS) == Some(Effects::Full) && !left_out;
        let asker = asks.map_or("effects = \"full\"", String::as_str);
        if (asks.is_some() || full)
            && self.sound(&["disk.rpm"])
            && self.view.number("disk.rpm") == 0.0
        {
            let fault = self.fault(
                "E133",
                &["disk.rpm"],
                format!("{asker} needs the air bearing, which needs a spinning disk"),
            );
            fault.allowed = "> 0 rev/min".to_string();
            fault.hint = format!("or ask only for {}", keys::STRUCTURE_OUTPUTS.join(", "));
        }
    }

    /// Notes about keys the study gives though another key leaves them without effect.
    pub(super) fn without_effect(&mut self) {
        let any = |path: &str, word: &str| {
            self.view.settings.get(path).is_none_or(|setting| {
                setting.values.iter().any(|value| match value {
                    Datum::Word(found) => found == word,
                    Datum::Words(words) => words.iter().any(|found| found == word),
                    _ => false,
                })
            })
        };
        let refines = ["search.refine.tolerance_pct", "search.refine.crossing_pct"];
        let refines = refines.iter().any(|path| self.view.settings.has(path));
        let rules: [(bool, &str, &[&str]); 9] = [
            (
                refines,
                "neither tolerance_pct nor crossing_pct is given",
                &["search.refine.closest_pct", "search.refine.most_points"],
            ),
            (
                self.view.numbers("pulse.widths_ms").len() != 1,
                "pulse.widths_ms has one width, and widths are added between two",
                &["search.refine.tolerance_pct", "search.refine.crossing_pct"],
            ),
            (
                self.view.words("ramp.models").len() != 1,
                "ramp.models has one model",
                &["search.refine.crossing_pct"],
            ),
            (
                any("pulse.shape", "trapezoid"),
                "pulse.shape is not trapezoid",
                &["pulse.rise_share"],
            ),
            (
                any("pulse.shape", "damped_sine"),
                "pulse.shape is not damped_sine",
                &["pulse.frequency_hz", "pulse.decay_per_s"],
            ),
            (
                any("pulse.shape", "table"),
                "pulse.shape is not table",
                &["pulse.table", "pulse.table_time_ms"],
            ),
            (
                any("pulse.window_ms", "until_decayed"),
                "pulse.window_ms is not until_decayed",
                &["pulse.decay_share", "pulse.window_max_ms"],
            ),
            (
                !self.view.settings.has("suspension.modes"),
                "the suspension is given by its modes",
                &imported_suspension::REPLACED,
            ),
            (
                any("ramp.models", "deformable"),
                "ramp.models has no deformable",
                &[
                    "ramp.deformable.modes",
                    "ramp.deformable.bottom_modes",
                    "ramp.deformable.damping_ratio",
                    "ramp.deformable.mesh.file",
                    "ramp.deformable.coupled_modes",
                ],
            ),
        ];
        for (has_effect, why, paths) in rules {
            for path in paths {
                let given = self.view.settings.get(path).is_some_and(|setting| {
                    matches!(setting.origin(), Origin::File | Origin::Set(_))
                });
                if given && !has_effect {
                    let fault = self.fault("N116", &[path], format!("has no effect: {why}"));
                    fault.hint = "leave it out".to_string();
                }
            }
        }
    }

    pub(super) fn search(&mut self) {
        let paths = ["search.amplitude_g.min", "search.amplitude_g.max"];
        if self.sound(&paths) {
            let (low, high) = (self.view.number(paths[0]), self.view.number(paths[1]));
            if low >= high {
                let fault = self.fault(
                    "E156",
                    &paths,
                    format!("the search range {low} to {high} g is empty"),
                );
                fault.allowed = "min < max".to_string();
            }
        }
        self.refine();
        for (path, what) in [("ramp.models", "ramp models"), ("pulse.signs", "signs")] {
            if !self.sound(&[path]) {
                continue;
            }
            let words = self.view.words(path);
            if words.is_empty() {
                let fault = self.fault(
                    "E154",
                    &[path],
                    format!("the list is empty: a study needs {what}"),
                );
                fault.allowed = keys::find(path)
                    .map(|key| key.kind.allowed())
                    .unwrap_or_default();
            }
            if let Some(twice) = repeated(words) {
                let fault = self.fault("E154", &[path], format!("holds {twice:?} twice"));
                fault.allowed = "values that differ".to_string();
            }
        }
        if self.sound(&["pulse.widths_ms"]) {
            let widths = self.view.numbers("pulse.widths_ms");
            if widths.is_empty() {
                let fault = self.fault(
                    "E154",
                    &["pulse.widths_ms"],
                    "the list is empty: a study needs pulse widths",
                );
                fault.allowed = "one or more widths".to_string();
            }
            let mut sorted = widths.to_vec();
            sorted.sort_by(f64::total_cmp);
            if let Some(twice) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
                let fault = self.fault(
                    "E154",
                    &["pulse.widths_ms"],
                    format!("holds {} twice", twice[0]),
                );
                fault.allowed = "values that differ".to_string();
            }
        }
    }
}

impl Check<'_, '_> {
    /// Lines cannot be told better than brackets.
    fn refine(&mut self) {
        let tolerance = "search.refine.tolerance_pct";
        if self.sound(&[tolerance, "search.tolerance_pct"])
            && let Some(lines) = self.view.maybe_number(tolerance)
            && lines < self.view.number("search.tolerance_pct")
        {
            let bracket = self.view.number("search.tolerance_pct");
            let what = format!("{lines} % is less than the bracket of every answer, {bracket} %");
            let fault = self.fault("E156", &[tolerance, "search.tolerance_pct"], what);
            fault.allowed = format!(">= {bracket} %");
        }
    }
}

fn repeated(words: &[String]) -> Option<&String> {
    words
        .iter()
        .enumerate()
        .find(|(position, word)| words[..*position].contains(word))
        .map(|(_, word)| word)
}
