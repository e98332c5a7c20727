//! Makes a pulse of a recorded acceleration: units, zero line, filter, time window; and says what looks wrong.
//!
//! In this order the zero line is subtracted from the whole record, the record is filtered, and the window is cut out. The
//! first sample of the window is the onset of the shock.

use super::fault::StudyError;
use super::fields;
use super::samples::{self, Layout, Samples};
use super::settings::{Setting, Settings, View};
use super::words::{AccelerationUnit, TableOffset, TableScale, TimeUnit};
use crate::record::{Filter, Line, Record, phaseless};
use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2, s_from_ms};

/// Share of the peak up to which a pulse counts as beginning and ending at zero.
const LARGEST_STEP: f64 = 0.01;

/// Share of the peak above which the end of a record is inside the pulse.
const LARGEST_END: f64 = 0.1;

/// What a file's record becomes.
#[derive(Clone, Debug)]
pub struct MeasuredPulse {
    /// File.
    pub file: String,
    /// As read; relative accelerations count as G.
    pub raw: Record,
    /// What the shock is made of; time from the onset.
    pub used: Record,
    /// Onset in the file's time, s.
    pub onset_s: f64,
    /// What was subtracted, over the file's time.
    pub zero_line: Option<Line>,
    /// The filter.
    pub filter: Option<Filter>,
    /// Whether the used record is stretched to the widths of the study.
    pub is_stretched: bool,
    /// Whether the file's accelerations have a unit.
    pub has_unit: bool,
    /// What looks wrong with the pulse.
    pub warnings: Vec<String>,
}

/// Share of a record's length by which a sample may miss the window, for the rounding of decimals.
const ROUNDING: f64 = 1e-9;

/// Samples in ms and G in SI.
pub fn record_of(time_ms: &[f64], g: &[f64]) -> Record {
    Record {
        time_s: time_ms.iter().map(|time| s_from_ms(*time)).collect(),
        acceleration_m_per_s2: g.iter().map(|a| STANDARD_GRAVITY_M_PER_S2 * a).collect(),
    }
}

/// What the study says of a file.
pub struct Asked {
    /// Where the columns are.
    pub layout: Layout,
    time_unit: TimeUnit,
    acceleration_unit: Option<AccelerationUnit>,
    is_stretched: bool,
    window_ms: Option<[f64; 2]>,
    offset: Option<TableOffset>,
    filter: Option<Filter>,
}

/// Samples in ms and G, and where they come from.
pub type Made = (Vec<f64>, Vec<f64>, MeasuredPulse);

impl Asked {
    /// Reads the keys; `table` is that of the file.
    ///
    /// # Errors
    /// A key that is missing, or goes with no other.
    pub fn new(settings: &Settings, table: &Setting) -> Result<Self, Box<StudyError>> {
        let fault = |path: &str, code: &'static str, message: String, allowed: &str| {
            let place = settings.get(path).map_or(&table.key_place, |s| &s.place);
            let fault = StudyError::at(code, place, path, message).value(place.text());
            Box::new(fault.allowed(allowed))
        };
        let view = View::first(settings);
        let (time_unit, scale) = (
            view.get(&fields::PULSE_TABLE_TIME_UNIT),
            view.get(&fields::PULSE_TABLE_SCALE),
        );
        let (Some(time_unit), Some(scale)) = (time_unit, scale) else {
            let missing = [
                (
                    time_unit.is_none(),
                    "pulse.table_time_unit (\"s\", \"ms\" or \"us\")",
                ),
                (
                    scale.is_none(),
                    "pulse.table_scale (\"measured\" or \"stretched\")",
                ),
            ];
            let missing: Vec<&str> = missing.iter().filter(|m| m.0).map(|m| m.1).collect();
            let message = format!("a file needs {}", missing.join(" and "));
            let allowed = "table_time_unit = \"ms\" with table_scale = \"stretched\": times in ms, stretched to pulse.widths_ms; \
                           or other words";
            return Err(fault(fields::PULSE_TABLE.path(), "E112", message, allowed));
        };
        let acceleration_unit = view.get(&fields::PULSE_TABLE_ACCELERATION_UNIT);
        if acceleration_unit.is_none() && scale == TableScale::Measured {
            let message =
                "a measured pulse needs pulse.table_acceleration_unit (\"g\" or \"m_per_s2\")";
            let allowed = "a unit; relative accelerations go with table_scale = \"stretched\"";
            return Err(fault(
                fields::PULSE_TABLE.path(),
                "E112",
                message.to_string(),
                allowed,
            ));
        }
        let columns = match view.get(&fields::PULSE_TABLE_COLUMNS) {
            [] => [1.0, 2.0],
            &[time, value] if time != value && time.fract() == 0.0 && value.fract() == 0.0 => {
                [time, value]
            }
            _ => {
                let message = "columns of time and acceleration are two different whole numbers";
                let path = fields::PULSE_TABLE_COLUMNS.path();
                return Err(fault(
                    path,
                    "E153",
                    message.to_string(),
                    "two whole numbers >= 1, for example [1, 3]",
                ));
            }
        };
        let class = view.get(&fields::PULSE_TABLE_FILTER);
        let butterworth = (
            view.get(&fields::PULSE_TABLE_CUTOFF_HZ),
            view.get(&fields::PULSE_TABLE_FILTER_ORDER),
        );
        let filter = match (class, butterworth) {
            (Some(class), _) => Some(Filter::Class(class.0)),
            (None, (Some(cutoff_hz), Some(order))) => {
                Some(Filter::Butterworth { cutoff_hz, order })
            }
            _ => None,
        };
        let window = fields::PULSE_TABLE_WINDOW_MS;
        let window_ms = view.settings.has(window.path()).then(|| view.get(&window));
        let offset = view.get(&fields::PULSE_TABLE_OFFSET);
        if offset.is_some() && window_ms.is_none() {
            let message =
                "the zero line is found outside of pulse.table_window_ms, which is not given";
            let path = fields::PULSE_TABLE_OFFSET.path();
            return Err(fault(
                path,
                "E153",
                message.to_string(),
                "with table_window_ms = [from, to], the part of the record that is the pulse",
            ));
        }
        Ok(Self {
            layout: Layout {
                columns: columns.map(|column| column as usize - 1),
                may_have_more: view.settings.has(fields::PULSE_TABLE_COLUMNS.path()),
                skip_rows: view.get(&fields::PULSE_TABLE_SKIP_ROWS).unwrap_or(0),
            },
            time_unit,
            acceleration_unit,
            is_stretched: scale == TableScale::Stretched,
            window_ms,
            offset,
            filter,
        })
    }

    /// A heading whose unit is another one than the key's.
    pub fn disagreement(&self, settings: &Settings, samples: &Samples) -> Option<StudyError> {
        let times = ["s", "sec", "ms", "msec", "us", "µs", "μs", "usec"];
        let own_times: &[&str] = match self.time_unit.ms {
            ms if ms > 1.0 => &times[..2],
            1.0 => &times[2..4],
            _ => &times[4..],
        };
        let accelerations = ["g", "gn", "m/s2", "m/s^2", "m/s²", "m_per_s2"];
        let own_accelerations: &[&str] = match self.acceleration_unit {
            Some(unit) if unit.g == 1.0 => &accelerations[..2],
            Some(_) => &accelerations[2..],
            None => &accelerations,
        };
        let columns: [(&str, &[&str], &[&str]); 2] = [
            (fields::PULSE_TABLE_TIME_UNIT.path(), &times, own_times),
            (
                fields::PULSE_TABLE_ACCELERATION_UNIT.path(),
                &accelerations,
                own_accelerations,
            ),
        ];
        for (column, (path, known, own)) in columns.into_iter().enumerate() {
            for row in &samples.header {
                let unit = samples::unit_of(&row[column]).to_lowercase();
                if known.contains(&unit.as_str())
                    && !own.contains(&unit.as_str())
                    && let Some(setting) = settings.get(path)
                {
                    let message = format!(
                        "the heading {:?} of the file names another unit than {path}",
                        row[column]
                    );
                    let fault = StudyError::at("E153", &setting.place, path, message);
                    let fault = fault.value(setting.place.text()).allowed(unit);
                    return Some(fault.hint("a wrong heading is skipped by pulse.table_skip_rows"));
                }
            }
        }
        None
    }

    /// The pulse.
    ///
    /// # Errors
    /// The key that cannot be fulfilled, and why.
    pub fn pulse(&self, file: &str, samples: &Samples) -> Result<Made, (&'static str, String)> {
        // A factor of 1 leaves every bit as it is.
        let in_g = self.acceleration_unit.map_or(1.0, |unit| unit.g);
        let time_ms: Vec<f64> = samples.time.iter().map(|t| t * self.time_unit.ms).collect();
        let mut g: Vec<f64> = samples.acceleration.iter().map(|a| a * in_g).collect();
        if !time_ms.iter().chain(&g).all(|number| number.is_finite()) {
            let message = "a number is too large in ms or G".to_string();
            return Err((fields::PULSE_TABLE.path(), message));
        }
        let raw = record_of(&time_ms, &g);
        let [from, to] = self.window_ms.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let rounding_ms = ROUNDING * (time_ms[time_ms.len() - 1] - time_ms[0]);
        let is_inside = |t: &f64| (from - rounding_ms..=to + rounding_ms).contains(t);
        let zero_line = self.zero_line(&raw, rounding_ms)?;
        if let Some(line) = &zero_line {
            for (value, time_s) in g.iter_mut().zip(&raw.time_s) {
                *value -= line.at(*time_s) / STANDARD_GRAVITY_M_PER_S2;
            }
        }
        if let Some(filter) = &self.filter {
            let key = match filter {
                Filter::Class(_) => fields::PULSE_TABLE_FILTER.path(),
                Filter::Butterworth { .. } => fields::PULSE_TABLE_CUTOFF_HZ.path(),
            };
            if let Some(row) = raw.uneven() {
                let at = samples.time[row];
                let message = format!(
                    "a filter needs evenly spaced times; sample {} at {at} is off",
                    row + 1
                );
                return Err((key, message));
            }
            let filtered = phaseless(&g, raw.rate_hz(), filter);
            g = filtered.map_err(|error| (key, error.to_string()))?;
        }
        let chosen: Vec<usize> = (0..g.len()).filter(|&k| is_inside(&time_ms[k])).collect();
        let (first, last) = match chosen[..] {
            [first, .., last] => (first, last),
            _ => {
                let message = format!(
                    "the window {from} to {to} ms holds {} samples of the record from {} to {} ms; a pulse needs at least 2",
                    chosen.len(),
                    time_ms[0],
                    time_ms[time_ms.len() - 1]
                );
                return Err((fields::PULSE_TABLE_WINDOW_MS.path(), message));
            }
        };
        let onset_ms = time_ms[first];
        let ends_with_record = last + 1 == g.len();
        let time_ms: Vec<f64> = time_ms[first..=last].iter().map(|t| t - onset_ms).collect();
        let g = g[first..=last].to_vec();
        if let Some((_, message)) = samples::faults(&time_ms, &g) {
            return Err((fields::PULSE_TABLE.path(), message));
        }
        let used = record_of(&time_ms, &g);
        let pulse = MeasuredPulse {
            file: file.to_string(),
            warnings: warnings(&used, ends_with_record),
            raw,
            used,
            onset_s: s_from_ms(onset_ms),
            zero_line,
            filter: self.filter,
            is_stretched: self.is_stretched,
            has_unit: self.acceleration_unit.is_some(),
        };
        Ok((time_ms, g, pulse))
    }

    fn zero_line(
        &self,
        raw: &Record,
        rounding_ms: f64,
    ) -> Result<Option<Line>, (&'static str, String)> {
        let (Some(offset), Some([from, to])) = (self.offset, self.window_ms) else {
            return Ok(None);
        };
        let (from_s, to_s) = (s_from_ms(from - rounding_ms), s_from_ms(to + rounding_ms));
        let (line, needed) = match offset {
            TableOffset::MeanBefore => (raw.mean(|t| t < from_s), "samples before it"),
            TableOffset::LineOutside => {
                let line = raw.line(|t| t < from_s || t > to_s);
                (line, "two samples or more before or after it")
            }
        };
        let message = || {
            let first = 1e3 * raw.time_s[0];
            format!(
                "the window begins at {from} ms, the record at {first} ms; a zero line needs {needed}"
            )
        };
        line.map(Some)
            .ok_or_else(|| (fields::PULSE_TABLE_OFFSET.path(), message()))
    }
}

/// What looks wrong with a pulse.
fn warnings(used: &Record, ends_with_record: bool) -> Vec<String> {
    let values = &used.acceleration_m_per_s2;
    let peak = used.peak_m_per_s2();
    let share = |value: Option<&f64>| value.map_or(0.0, |value| value / peak);
    let (first, last) = (share(values.first()), share(values.last()));
    let mut warnings = Vec::new();
    if first.abs() > LARGEST_STEP {
        let pct = 100.0 * first;
        warnings.push(format!(
            "the pulse begins with a step of {pct:.1} % of its peak"
        ));
    }
    if last.abs() > LARGEST_END && ends_with_record {
        let pct = 100.0 * last;
        warnings.push(format!(
            "the record ends inside the pulse, at {pct:.1} % of its peak"
        ));
    } else if last.abs() > LARGEST_STEP {
        let pct = 100.0 * last;
        warnings.push(format!(
            "the pulse ends with a step of {pct:.1} % of its peak"
        ));
    }
    if peak < 0.0 {
        warnings.push(
            "the peak is negative: a shock of sign + moves the disk away from the slider first"
                .to_string(),
        );
    }
    warnings
}
