//! Puts the samples of a file in the place of its name, and the width of a measured pulse in that of the widths.
//!
//! A resolved study holds the samples and none of the keys that made them.
//!
//! The width of a measured pulse is the time about its peak in which it stays above [`WIDTH_ABOVE`] of the peak.

use super::datum::Datum;
use super::fault::StudyError;
use super::fields;
use super::included::{self, Location};
use super::read::Reader;
use super::recorded::{Asked, record_of};
use super::samples;
use super::settings::{Setting, Settings, View};
use super::source::{Origin, Place};
use super::words::TableScale;

/// Share of the peak above which a measured pulse has its width.
pub const WIDTH_ABOVE: f64 = 0.1;

/// Keys that say how a file is read.
pub const OF_A_FILE: [&str; 9] = [
    fields::PULSE_TABLE_TIME_UNIT.path(),
    fields::PULSE_TABLE_ACCELERATION_UNIT.path(),
    fields::PULSE_TABLE_COLUMNS.path(),
    fields::PULSE_TABLE_SKIP_ROWS.path(),
    fields::PULSE_TABLE_WINDOW_MS.path(),
    fields::PULSE_TABLE_OFFSET.path(),
    fields::PULSE_TABLE_FILTER.path(),
    fields::PULSE_TABLE_CUTOFF_HZ.path(),
    fields::PULSE_TABLE_FILTER_ORDER.path(),
];

/// Whether the samples stand for this key once the study is read.
pub fn is_replaced(settings: &Settings, path: &str) -> bool {
    let scale = View::first(settings).get(&fields::PULSE_TABLE_SCALE);
    path == fields::PULSE_TABLE.path()
        || OF_A_FILE.contains(&path)
        || (path == fields::PULSE_TABLE_SCALE.path() && scale == Some(TableScale::Stretched))
        || (path == fields::PULSE_WIDTHS_MS.path() && scale == Some(TableScale::Measured))
}

/// Length of a pulse with the time of its record, ms; `None` for every other pulse.
pub fn length_ms(view: &View<'_>) -> Option<f64> {
    let is_measured = view.get(&fields::PULSE_TABLE_SCALE) == Some(TableScale::Measured);
    let times = view.get(&fields::PULSE_TABLE_TIME_MS);
    times.last().copied().filter(|_| is_measured)
}

/// Reads the file of a pulse into the two lists that may also be given directly, and finds the width of one with the
/// time of its record.
pub fn read(reader: &mut Reader, location: &Location) {
    if reader.settings.has(fields::PULSE_TABLE.path()) && !of_file(reader, location) {
        reader.settings.spoil(fields::PULSE_TABLE.path());
        // Whether it needs widths is not known.
        if !reader.settings.has(fields::PULSE_WIDTHS_MS.path()) {
            reader.settings.spoil(fields::PULSE_WIDTHS_MS.path());
        }
    }
    let view = View::first(&reader.settings);
    if view.get(&fields::PULSE_TABLE_SCALE) == Some(TableScale::Measured) {
        own_width(reader);
    }
}

/// The file's part; whether there are samples now.
fn of_file(reader: &mut Reader, location: &Location) -> bool {
    let Some(setting) = reader.settings.get(fields::PULSE_TABLE.path()).cloned() else {
        return false;
    };
    let Datum::Text(file) = &setting.values[0] else {
        return false;
    };
    let asked = match Asked::new(&reader.settings, &setting) {
        Ok(asked) => asked,
        Err(fault) => {
            reader.errors.push(*fault);
            return false;
        }
    };
    let key = fields::PULSE_TABLE.path();
    let Some(source) = included::open_named(reader, location, key, file, &setting.place) else {
        return false;
    };
    let samples = match samples::read(&source, &asked.layout) {
        Ok(samples) => samples,
        Err(faults) => {
            reader.errors.extend(faults);
            return false;
        }
    };
    if let Some(fault) = asked.disagreement(&reader.settings, &samples) {
        reader.errors.push(fault);
        return false;
    }
    let (time_ms, relative, pulse) = match asked.pulse(file, &samples) {
        Ok(made) => made,
        Err((key, message)) => {
            let place = reader.settings.get(key).map(|setting| &setting.place);
            let place = place.unwrap_or(&setting.place).clone();
            let fault = StudyError::at("E153", &place, key, message).value(place.text());
            reader.errors.push(fault.allowed(allowed_of(key)));
            return false;
        }
    };
    for message in &pulse.warnings {
        let fault = StudyError::at("W205", &setting.place, key, message.clone());
        let fault = fault.value(setting.place.text());
        reader
            .remarks
            .push(fault.hint("`opshock pulse` shows the pulse"));
    }
    reader.measured = Some(pulse);
    let place = Place {
        span: 0..source.text.len(),
        source,
        origin: Origin::Included,
    };
    for (path, numbers) in [
        (fields::PULSE_TABLE_TIME_MS.path(), time_ms),
        (fields::PULSE_TABLE_RELATIVE.path(), relative),
    ] {
        put(reader, path, numbers, &place, &setting.key_place);
    }
    true
}

/// What a key allows beside a record.
fn allowed_of(key: &str) -> &'static str {
    const WINDOW: &str = fields::PULSE_TABLE_WINDOW_MS.path();
    const OFFSET: &str = fields::PULSE_TABLE_OFFSET.path();
    const TABLE: &str = fields::PULSE_TABLE.path();
    match key {
        WINDOW => "a part of the record",
        OFFSET => "a window with samples of the record beside it",
        TABLE => "finite accelerations, not all zero",
        _ => "even samples at a rate high enough, and a period of the cut-off in the record",
    }
}

fn put(reader: &mut Reader, path: &str, numbers: Vec<f64>, place: &Place, key_place: &Place) {
    let setting = Setting {
        values: vec![Datum::Numbers(numbers)],
        is_axis: false,
        place: place.clone(),
        key_place: key_place.clone(),
        value_places: Vec::new(),
    };
    reader.settings.put(path.to_string(), setting);
}

/// Puts the width of a pulse with the time of its record in the place of `pulse.widths_ms`.
fn own_width(reader: &mut Reader) {
    let (widths, scale) = (
        fields::PULSE_WIDTHS_MS.path(),
        fields::PULSE_TABLE_SCALE.path(),
    );
    let scale = reader.settings.get(scale).cloned();
    if let (Some(given), Some(_)) = (reader.settings.get(widths), &scale) {
        let message = "a measured pulse has its own width; pulse.widths_ms does not go with pulse.table_scale = \"measured\"";
        let fault = StudyError::at("E115", &given.key_place, widths, message)
            .value(given.place.text())
            .allowed("no widths")
            .hint("leave it out, or write table_scale = \"stretched\"");
        return reader.spoil(widths, fault);
    }
    let shapes = reader.settings.get(fields::PULSE_SHAPE.path());
    let is_table = |datum: &Datum| matches!(datum, Datum::Word(word) if word == "table");
    if let Some(shape) = shapes
        && !shape.values.iter().all(is_table)
    {
        let path = fields::PULSE_SHAPE.path();
        let message =
            "pulse.table_scale = \"measured\" is a shape and a width; no other shape goes with it";
        let fault = StudyError::at("E115", &shape.place, path, message)
            .value(shape.place.text())
            .allowed("\"table\"");
        reader.errors.push(fault);
    }
    let view = View::first(&reader.settings);
    let time_ms = view.get(&fields::PULSE_TABLE_TIME_MS);
    let relative = view.get(&fields::PULSE_TABLE_RELATIVE);
    match (samples::faults(time_ms, relative), scale) {
        (None, Some(scale)) => {
            let (from_ms, to_ms) = record_of(time_ms, relative).above(WIDTH_ABOVE);
            let width = four_digits(1e3 * (to_ms - from_ms));
            put(reader, widths, vec![width], &scale.place, &scale.key_place);
        }
        // Reported elsewhere.
        _ => reader.settings.spoil(widths),
    }
}

/// As many digits as a table shows, so that the width on it is the width itself.
fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
