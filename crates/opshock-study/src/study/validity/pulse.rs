//! Rules for the pulse: its width against time step and window, and the samples of a sampled one.

use super::check::{Check, trim};
use crate::study::datum::Datum;
use crate::study::fault::StudyError;
use crate::study::fields;
use crate::study::source::Place;
use crate::study::words::Shape;
use crate::study::{measured_pulse, samples, scene, unit};

/// Steps a pulse must span.
const STEPS_PER_PULSE: f64 = 8.0;

/// Net velocity change of a sampled shock that is taken for a mistake, m/s.
const LARGEST_VELOCITY_M_PER_S: f64 = 1000.0;

impl Check<'_, '_> {
    pub(super) fn pulse(&mut self, widths_ms: &[f64]) {
        if !self.sound(&[fields::PULSE_WIDTHS_MS.path()]) {
            return;
        }
        for &width in widths_ms {
            self.width(width);
        }
        self.sampled_pulse();
    }

    /// One pulse width, ms, against step and window.
    pub fn width(&mut self, width: f64) {
        let place = self.width_place(width);
        let width_s = unit::si(fields::PULSE_WIDTHS_MS.path(), width);
        let step_s = scene::resolutions(self.view).structure.step_s;
        // A step that is exactly an eighth must pass whatever its decimal rounding.
        let shortest_s = STEPS_PER_PULSE * step_s * (1.0 - 1e-12);
        if self.sound(&[
            fields::RESOLUTION_STRUCTURE_STEP_US.path(),
            fields::RESOLUTION_PRESET.path(),
        ]) && width_s < shortest_s
        {
            let message = format!(
                "a pulse of {width} ms is shorter than {STEPS_PER_PULSE} steps of {} us",
                trim(step_s * 1e6)
            );
            let fault = self.push(match place {
                Some(place) => {
                    StudyError::at("E151", &place, fields::PULSE_WIDTHS_MS.path(), message)
                }
                None => StudyError::in_file("E151", "--pulse-ms", message),
            });
            fault.value = format!("{width}");
            fault.allowed = format!(
                "widths from {} ms, or resolution.structure_step_us <= {}",
                trim(STEPS_PER_PULSE * step_s * 1e3),
                trim(width_s / STEPS_PER_PULSE * 1e6)
            );
            fault.hint = "set a smaller step".to_string();
        }
        if self.sound(&[
            fields::PULSE_WINDOW_MS.path(),
            fields::PULSE_WINDOW_MAX_MS.path(),
        ]) {
            let fixed = self.view.maybe_number(fields::PULSE_WINDOW_MS.path());
            let path = if fixed.is_some() {
                fields::PULSE_WINDOW_MS.path()
            } else {
                fields::PULSE_WINDOW_MAX_MS.path()
            };
            let end_ms =
                fixed.unwrap_or_else(|| self.view.number(fields::PULSE_WINDOW_MAX_MS.path()));
            let length = measured_pulse::length_ms(self.view).unwrap_or(width);
            if end_ms < length {
                let fault = self.fault("E152", &[path], format!(
                    "the simulation ends {end_ms} ms after the onset, inside the pulse of {length:.4} ms"
                ));
                fault.allowed = format!(">= {length:.4} ms");
            }
        }
    }

    /// Place of a width in the study; none when the command line named it.
    pub(super) fn width_place(&self, width: f64) -> Option<Place> {
        let setting = self.view.settings.get(fields::PULSE_WIDTHS_MS.path())?;
        match &setting.values[0] {
            Datum::Numbers(numbers) => {
                let position = numbers.iter().position(|known| *known == width)?;
                Some(setting.place_of(position).clone())
            }
            _ => None,
        }
    }

    pub(super) fn sampled_pulse(&mut self) {
        let paths = [
            fields::PULSE_SHAPE.path(),
            fields::PULSE_TABLE.path(),
            fields::PULSE_TABLE_TIME_MS.path(),
            fields::PULSE_TABLE_RELATIVE.path(),
        ];
        if !self.sound(&paths) || self.view.get(&fields::PULSE_SHAPE) != Shape::Table {
            return;
        }
        if !self.view.settings.has(fields::PULSE_TABLE_TIME_MS.path()) {
            let fault = self.fault(
                "E112",
                &[fields::PULSE_SHAPE.path()],
                "missing key: pulse.table, for example table = \"pulse.csv\"",
            );
            fault.key = fields::PULSE_TABLE.path().to_string();
            fault.value = String::new();
            fault.allowed = "a file with columns of time and acceleration".to_string();
            return;
        }
        let time_ms = self.view.get(&fields::PULSE_TABLE_TIME_MS);
        let relative = self.view.get(&fields::PULSE_TABLE_RELATIVE);
        if let Some((_, message)) = samples::faults(time_ms, relative) {
            let fault = self.fault("E153", &[fields::PULSE_TABLE_TIME_MS.path()], message);
            fault.allowed = "2 samples or more, times rising from 0".to_string();
            return;
        }
        if !self.sound(&[fields::SEARCH_AMPLITUDE_G_MAX.path()]) {
            return;
        }
        let largest = relative
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        let widths = self.view.get(&fields::PULSE_WIDTHS_MS).iter();
        let longest = widths.fold(0.0_f64, |most, width| most.max(*width));
        let width_ms = measured_pulse::length_ms(self.view).unwrap_or(longest);
        let last = time_ms.last().copied().unwrap_or(1.0);
        let area: f64 = (1..time_ms.len())
            .map(|row| {
                0.5 * (relative[row] + relative[row - 1]) * (time_ms[row] - time_ms[row - 1])
            })
            .sum();
        let velocity = self.view.get(&fields::SEARCH_AMPLITUDE_G_MAX)
            * (area / largest).abs()
            * unit::si(fields::PULSE_WIDTHS_MS.path(), width_ms)
            / last;
        if velocity > LARGEST_VELOCITY_M_PER_S {
            let path = if self.view.settings.has(fields::PULSE_TABLE.path()) {
                fields::PULSE_TABLE.path()
            } else {
                fields::PULSE_TABLE_TIME_MS.path()
            };
            let fault = self.fault("W204", &[path], format!(
                "the sampled shock changes the drive's velocity by {velocity:.0} m/s at the highest amplitude"
            ));
            fault.allowed = format!("usually below {LARGEST_VELOCITY_M_PER_S} m/s");
            fault.hint = "check the unit of the times".to_string();
        }
    }
}
