//! Rules that hold for a study as a whole: names, outputs, search, keys without effect.

use super::check::Check;
use super::gap_forces::DAMAGE;
use crate::study::datum::Datum;
use crate::study::field::{Field, Many, Named};
use crate::study::fields;
use crate::study::imported_suspension;
use crate::study::measured_pulse;
use crate::study::source::Origin;
use crate::study::words::{self, Effects, LeftOut, UncertaintyOf};
use opshock_solver::scene::plan::{Needs, Output};

impl Check<'_, '_> {
    pub(super) fn names(&mut self) {
        if !self.sound(&["name"]) {
            return;
        }
        let name = self.view.get(&fields::NAME);
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
        let outputs = self.view.get(&fields::OUTPUTS);
        if outputs.is_empty() {
            let fault = self.fault("E158", &["outputs"], "no output is asked for");
            fault.allowed = fields::OUTPUTS.key.kind.allowed();
        }
        if let Some(twice) = repeated(&outputs) {
            let fault = self.fault("E159", &["outputs"], format!("asks for {twice} twice"));
            fault.allowed = "each output once".to_string();
        }
        const ROUGHNESS: &str = fields::ASPERITY_CONTACT_ROUGHNESS_NM.path();
        let has_contact = outputs.contains(&Output::SliderContact);
        if has_contact && self.sound(&[ROUGHNESS]) && !self.view.settings.has(ROUGHNESS) {
            let message = "slider_contact of smooth surfaces, which bear nothing";
            let fault = self.fault("E158", &["outputs"], message);
            fault.allowed = "with asperity_contact.roughness_nm".to_string();
            fault.hint = "give roughness_nm, or do not ask for slider_contact".to_string();
        }
        if !self.sound(&[
            fields::SOLVER_LEAVE_OUT.path(),
            fields::SOLVER_EFFECTS.path(),
        ]) {
            return;
        }
        let left_out = self.view.get(&fields::SOLVER_LEAVE_OUT);
        let left_out = left_out.contains(&LeftOut::AirBearing);
        let needs_head = |output: &&Output| output.needs() > Needs::Structure;
        let asks = outputs.iter().find(needs_head);
        if let (Some(output), true) = (asks, left_out) {
            let fault = self.fault(
                "E158",
                &[fields::SOLVER_LEAVE_OUT.path()],
                format!("{output} needs air_bearing, which is left out"),
            );
            fault.allowed = format!(
                "[], or outputs of disk and ramp alone: {}",
                words::structure_outputs()
            );
            fault.hint = format!("remove {output} from outputs, or do not leave air_bearing out");
        }
        let full = self.view.get(&fields::SOLVER_EFFECTS) == Effects::Full && !left_out;
        let asker = asks.map_or("effects = \"full\"", |output| output.as_str());
        if (asks.is_some() || full)
            && self.sound(&[fields::DISK_RPM.path()])
            && self.view.number(fields::DISK_RPM.path()) == 0.0
        {
            let fault = self.fault(
                "E133",
                &[fields::DISK_RPM.path()],
                format!("{asker} needs the air bearing, which needs a spinning disk"),
            );
            fault.allowed = "> 0 rev/min".to_string();
            fault.hint = format!("or ask only for {}", words::structure_outputs());
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
        let refines = [
            fields::SEARCH_ADDED_POINTS_TOLERANCE_PCT.path(),
            fields::SEARCH_ADDED_POINTS_CROSSING_PCT.path(),
        ];
        let refines = refines.iter().any(|path| self.view.settings.has(path));
        let is_given = |path: &str| self.view.settings.has(path);
        let has_rayleigh = is_given(fields::SUSPENSION_RAYLEIGH_ALPHA_PER_S.path())
            || is_given(fields::SUSPENSION_RAYLEIGH_BETA_S.path());
        let rules: [(bool, &str, &[&str]); 14] = [
            (
                any(fields::FAILURE_CRITERION.path(), "touch"),
                "failure.criterion is damage, which it does not decide",
                &[fields::FAILURE_CLEARANCE_NM.path()],
            ),
            (
                is_given(fields::FAILURE_CRITERION.path())
                    && any(fields::FAILURE_CRITERION.path(), "damage"),
                "failure.criterion is not damage",
                &DAMAGE,
            ),
            (
                !has_rayleigh,
                "suspension.rayleigh is given",
                &[fields::SUSPENSION_DAMPING_RATIO.path()],
            ),
            (
                self.view.get(&fields::SEARCH_UNCERTAINTY),
                "search.uncertainty is false",
                &[
                    fields::SEARCH_UNCERTAINTY_OF.path(),
                    fields::SEARCH_TARGET_UNCERTAINTY_PCT.path(),
                ],
            ),
            (
                refines,
                "neither tolerance_pct nor crossing_pct is given",
                &[
                    fields::SEARCH_ADDED_POINTS_CLOSEST_PCT.path(),
                    fields::SEARCH_ADDED_POINTS_MAX_POINTS.path(),
                ],
            ),
            (
                self.view.get(&fields::PULSE_WIDTHS_MS).len() != 1,
                "pulse.widths_ms has one width, and widths are added between two",
                &[
                    fields::SEARCH_ADDED_POINTS_TOLERANCE_PCT.path(),
                    fields::SEARCH_ADDED_POINTS_CROSSING_PCT.path(),
                ],
            ),
            (
                self.view.get(&fields::RAMP_MODELS).len() != 1,
                "ramp.models has one model",
                &[fields::SEARCH_ADDED_POINTS_CROSSING_PCT.path()],
            ),
            (
                any(fields::PULSE_SHAPE.path(), "trapezoid"),
                "pulse.shape is not trapezoid",
                &[fields::PULSE_RISE_SHARE.path()],
            ),
            (
                any(fields::PULSE_SHAPE.path(), "damped_sine"),
                "pulse.shape is not damped_sine",
                &[
                    fields::PULSE_FREQUENCY_HZ.path(),
                    fields::PULSE_DECAY_PER_S.path(),
                ],
            ),
            (
                any(fields::PULSE_SHAPE.path(), "table"),
                "pulse.shape is not table",
                &[
                    fields::PULSE_TABLE.path(),
                    fields::PULSE_TABLE_TIME_MS.path(),
                ],
            ),
            (
                is_given(fields::PULSE_TABLE.path()),
                "pulse.table is not given",
                &measured_pulse::OF_A_FILE,
            ),
            (
                any(fields::PULSE_WINDOW_MS.path(), "until_decayed"),
                "pulse.window_ms is not until_decayed",
                &[
                    fields::PULSE_DECAY_SHARE.path(),
                    fields::PULSE_WINDOW_MAX_MS.path(),
                ],
            ),
            (
                !self.view.settings.has(fields::SUSPENSION_MODES.path()),
                "the suspension is given by its modes",
                &imported_suspension::REPLACED,
            ),
            (
                any(fields::RAMP_MODELS.path(), "deformable"),
                "ramp.models has no deformable",
                &[
                    fields::RAMP_DEFORMABLE_MODES.path(),
                    fields::RAMP_DEFORMABLE_BOTTOM_MODES.path(),
                    fields::RAMP_DEFORMABLE_DAMPING_RATIO.path(),
                    fields::RAMP_DEFORMABLE_MESH_FILE.path(),
                    fields::RAMP_DEFORMABLE_COUPLED_MODES.path(),
                    fields::RAMP_DEFORMABLE_PRONY.path(),
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
        let paths = [
            fields::SEARCH_AMPLITUDE_G_MIN.path(),
            fields::SEARCH_AMPLITUDE_G_MAX.path(),
        ];
        if self.sound(&paths) {
            let (low, high) = (self.view.number(paths[0]), self.view.number(paths[1]));
            if low >= high {
                let fault = self.fault(
                    "E156",
                    &paths,
                    format!("the search range {low} to {high} G is empty"),
                );
                fault.allowed = "min < max".to_string();
            }
        }
        self.refine();
        self.decisive();
        self.required();
        self.each_once(&fields::RAMP_MODELS, "ramp models");
        self.each_once(&fields::PULSE_SIGNS, "signs");
        if self.sound(&[fields::PULSE_WIDTHS_MS.path()]) {
            let widths = self.view.get(&fields::PULSE_WIDTHS_MS);
            if widths.is_empty() {
                let fault = self.fault(
                    "E154",
                    &[fields::PULSE_WIDTHS_MS.path()],
                    "the list is empty: a study needs pulse widths",
                );
                fault.allowed = "one or more widths".to_string();
            }
            let mut sorted = widths.to_vec();
            sorted.sort_by(f64::total_cmp);
            if let Some(twice) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
                let fault = self.fault(
                    "E154",
                    &[fields::PULSE_WIDTHS_MS.path()],
                    format!("holds {} twice", twice[0]),
                );
                fault.allowed = "values that differ".to_string();
            }
        }
    }
}

impl Check<'_, '_> {
    /// A list with something in it, and that once.
    fn each_once<T>(&mut self, field: &Field<Many<T>>, what: &str)
    where
        T: Named + PartialEq + std::fmt::Display,
    {
        let path = field.path();
        if !self.sound(&[path]) {
            return;
        }
        let values = self.view.get(field);
        if values.is_empty() {
            let message = format!("the list is empty: a study needs {what}");
            let fault = self.fault("E154", &[path], message);
            fault.allowed = field.key.kind.allowed();
        }
        if let Some(twice) = repeated(&values) {
            let message = format!("holds {:?} twice", twice.to_string());
            let fault = self.fault("E154", &[path], message);
            fault.allowed = "values that differ".to_string();
        }
    }

    /// Widths are added by the answers of all points, which must not change afterwards.
    fn decisive(&mut self) {
        let added = [
            fields::SEARCH_ADDED_POINTS_TOLERANCE_PCT.path(),
            fields::SEARCH_ADDED_POINTS_CROSSING_PCT.path(),
        ];
        let path = fields::SEARCH_UNCERTAINTY_OF.path();
        let is_decisive =
            self.view.get(&fields::SEARCH_UNCERTAINTY_OF) == Some(UncertaintyOf::Decisive);
        if let Some(adds) = added.into_iter().find(|path| self.view.settings.has(path))
            && self.sound(&[path, adds])
            && is_decisive
        {
            let what = format!(
                "\"decisive\" cannot stand beside {adds}, which adds widths by the answers of all points"
            );
            let fault = self.fault("E156", &[path], what);
            fault.allowed = "\"all\", or no search.added_points".to_string();
        }
    }

    /// An amplitude that no search tries cannot be required.
    fn required(&mut self) {
        let path = fields::SEARCH_REQUIRED_AMPLITUDE_G.path();
        let [low, high] = [
            fields::SEARCH_AMPLITUDE_G_MIN.path(),
            fields::SEARCH_AMPLITUDE_G_MAX.path(),
        ];
        if self.sound(&[path, low, high])
            && let Some(required_g) = self.view.maybe_number(path)
            && let ends = [low, high].map(|end| self.view.number(end))
            && !(ends[0]..=ends[1]).contains(&required_g)
        {
            let what = format!("{required_g} G is outside of the searched amplitudes");
            let fault = self.fault("E156", &[path, low, high], what);
            fault.allowed = format!("{} to {}", ends[0], ends[1]);
        }
    }

    /// Interpolation between answers cannot be better than their brackets.
    fn refine(&mut self) {
        let tolerance = fields::SEARCH_ADDED_POINTS_TOLERANCE_PCT.path();
        if self.sound(&[tolerance, fields::SEARCH_TOLERANCE_PCT.path()])
            && let Some(lines) = self.view.maybe_number(tolerance)
            && lines < self.view.number(fields::SEARCH_TOLERANCE_PCT.path())
        {
            let bracket = self.view.number(fields::SEARCH_TOLERANCE_PCT.path());
            let what = format!("{lines} % is less than the bracket of every answer, {bracket} %");
            let fault = self.fault(
                "E156",
                &[tolerance, fields::SEARCH_TOLERANCE_PCT.path()],
                what,
            );
            fault.allowed = format!(">= {bracket} %");
        }
    }
}

fn repeated<T: PartialEq>(values: &[T]) -> Option<&T> {
    values
        .iter()
        .enumerate()
        .find(|(position, value)| values[..*position].contains(value))
        .map(|(_, value)| value)
}
