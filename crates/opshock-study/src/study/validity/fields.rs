//! Rules for the times of pressure fields: given with the output that needs them, within the simulated time.

use super::check::{Check, trim};
use crate::study::fields;
use crate::study::source::Origin;
use opshock_solver::scene::plan::Output;

/// Key of the times.
const FIELD_TIMES: &str = fields::FIELDS_TIMES_MS.path();

/// The output that the times belong to.
const OUTPUT: Output = Output::PressureField;

impl Check<'_, '_> {
    pub(super) fn fields(&mut self) {
        if !self.sound(&["outputs", FIELD_TIMES]) {
            return;
        }
        let is_asked = self.view.get(&fields::OUTPUTS).contains(&OUTPUT);
        let times_ms = self.view.get(&fields::FIELDS_TIMES_MS);
        match (is_asked, self.view.settings.get(FIELD_TIMES)) {
            (true, None) => {
                let fault = self.fault(
                    "E112",
                    &["outputs"],
                    format!("missing key: {FIELD_TIMES}, for example times_ms = [0.6, 0.8]"),
                );
                fault.key = FIELD_TIMES.to_string();
                fault.value = String::new();
                fault.allowed = format!("times at which {OUTPUT} is kept");
                return;
            }
            (false, Some(setting)) => {
                if matches!(setting.origin(), Origin::File | Origin::Set(_)) {
                    let message = format!("has no effect: outputs has no {OUTPUT}");
                    let fault = self.fault("N116", &[FIELD_TIMES], message);
                    fault.hint = "leave it out".to_string();
                }
                return;
            }
            (false, None) => return,
            (true, Some(_)) => {}
        }
        if times_ms.is_empty() {
            let fault = self.fault("E154", &[FIELD_TIMES], "the list is empty");
            fault.allowed = format!("one or more times at which {OUTPUT} is kept");
        }
        let mut sorted = times_ms.to_vec();
        sorted.sort_by(f64::total_cmp);
        if let Some(twice) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            let message = format!("holds {} twice", twice[0]);
            let fault = self.fault("E154", &[FIELD_TIMES], message);
            fault.allowed = "values that differ".to_string();
        }
    }

    /// The last field against the end of the simulation, at the latest that of `until_decayed`.
    pub(super) fn fields_end(&mut self) {
        let paths = [
            fields::PULSE_START_MS.path(),
            fields::PULSE_WINDOW_MS.path(),
            fields::PULSE_WINDOW_MAX_MS.path(),
        ];
        let times_ms = self.view.get(&fields::FIELDS_TIMES_MS).iter().copied();
        let last_ms = times_ms.fold(f64::NEG_INFINITY, f64::max);
        if !self.sound(&paths) || !self.sound(&[FIELD_TIMES]) {
            return;
        }
        let fixed = self.view.maybe_number(paths[1]);
        let window_ms = fixed.unwrap_or_else(|| self.view.number(paths[2]));
        let fixed = fixed.is_some();
        let end_ms = self.view.number(paths[0]) + window_ms;
        // Onset and window may add up with a rounding.
        if last_ms > end_ms * (1.0 + 1e-12) {
            let fault = self.fault(
                "E152",
                &[FIELD_TIMES],
                format!(
                    "a field is asked for at {} ms, after the simulation's end at {} ms",
                    trim(last_ms),
                    trim(end_ms)
                ),
            );
            fault.allowed = format!("0 to {} ms", trim(end_ms));
            fault.hint = format!("or lengthen {}", if fixed { paths[1] } else { paths[2] });
        }
    }
}
