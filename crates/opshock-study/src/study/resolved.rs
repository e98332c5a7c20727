//! Writes `study.resolved.toml`, every setting with its default in the order of the table of keys, and
//! computes the digest of a study from it.
//!
//! The text is itself a study: reading it gives the same points and the same digest. Numbers are
//! written with the shortest digits that read back to the same bits.

use std::fmt::Write as _;

use super::datum::Datum;
use super::fields;
use super::key::{Key, Kind, Presence};
use super::keys::{self, KEYS};
use super::measured_pulse;
use super::scene;
use super::settings::{Settings, View};

/// Keys that stand for what another key holds once the study is read.
const REPLACED: [&str; 2] = [
    fields::SLIDER_SURFACE_PRESET.path(),
    fields::SLIDER_SURFACE_FILE.path(),
];

/// Tables of such keys.
const REPLACED_BELOW: [&str; 3] = [
    "ramp.deformable.mesh.",
    "suspension.imported.",
    "base.imported.",
];

/// The resolved study.
pub fn text(settings: &Settings) -> String {
    let mut out = String::from(
        "# Every setting of the study, defaults included. This file is a study itself.\n\n",
    );
    // A table may be opened only once, so its keys are brought together first.
    let mut tables: Vec<(&str, String)> = Vec::new();
    let single = |key: &&Key| {
        let is_plain = !key.path.contains("[]") && key.kind != Kind::Tables;
        is_plain && !is_replaced(key.path) && !measured_pulse::is_replaced(settings, key.path)
    };
    for key in KEYS.iter().filter(single) {
        let Some(value) = value_at(settings, key.path) else {
            continue;
        };
        let (table, name) = key.path.rsplit_once('.').unwrap_or(("", key.path));
        let line = format!("{name} = {value}\n");
        match tables.iter_mut().find(|(known, _)| *known == table) {
            Some((_, lines)) => lines.push_str(&line),
            None => tables.push((table, line)),
        }
    }
    for (table, lines) in tables {
        if !table.is_empty() {
            let _ = write!(out, "\n[{table}]\n");
        }
        out.push_str(&lines);
    }
    let lists = KEYS.iter().filter(|key| key.kind == Kind::Tables);
    for key in lists.filter(|key| !key.path.contains("[]")) {
        for position in 0..View::of_study(settings).entries_at(key.path) {
            let _ = write!(out, "\n[[{}]]\n", key.path);
            for (member, value) in members(settings, key.path, &format!("{}[{position}]", key.path))
            {
                let _ = writeln!(out, "{member} = {value}");
            }
        }
    }
    out
}

/// The number at a dotted path with list positions.
pub fn number_at(table: &toml::Table, path: &str) -> Option<f64> {
    let mut here = toml::Value::Table(table.clone());
    for word in path.split('.') {
        let (name, position) = match word.split_once('[') {
            Some((name, rest)) => (
                name,
                Some(rest.trim_end_matches(']').parse::<usize>().ok()?),
            ),
            None => (word, None),
        };
        here = here.get(name)?.clone();
        if let Some(position) = position {
            here = here.get(position)?.clone();
        }
    }
    here.as_float()
        .or_else(|| here.as_integer().map(|n| n as f64))
}

/// Whether another key stands for this one once the study is read.
fn is_replaced(path: &str) -> bool {
    REPLACED.contains(&path) || REPLACED_BELOW.iter().any(|below| path.starts_with(below))
}

/// Members of an entry of a list of tables with their values; lists among them are written in one line.
fn members(settings: &Settings, list: &str, entry: &str) -> Vec<(&'static str, String)> {
    let prefix = format!("{list}[].");
    let mut members = Vec::new();
    for key in KEYS.iter() {
        let Some(member) = key.path.strip_prefix(&prefix) else {
            continue;
        };
        if member.contains("[]") || is_replaced(member) {
            continue;
        }
        let path = format!("{entry}.{member}");
        let value = match key.kind {
            Kind::Tables => inner_list(settings, key.path, &path),
            _ => value_at(settings, &path),
        };
        members.extend(value.map(|value| (member, value)));
    }
    members
}

/// A list of tables within an entry of another, if it has one.
fn inner_list(settings: &Settings, list: &str, path: &str) -> Option<String> {
    let Datum::Entries(count) = &settings.get(path)?.values[0] else {
        return None;
    };
    let entry = |position: usize| {
        let members = members(settings, list, &format!("{path}[{position}]"));
        let pairs = members
            .iter()
            .map(|(member, value)| format!("{member} = {value}"));
        format!("{{ {} }}", pairs.collect::<Vec<_>>().join(", "))
    };
    let entries: Vec<String> = (0..*count).map(entry).collect();
    Some(format!("[{}]", entries.join(", ")))
}

/// Digest of a study: of its resolved text.
pub fn digest(settings: &Settings) -> [u8; 32] {
    *hash(&text(settings)).as_bytes()
}

/// Digest, in hexadecimal digits, of the study whose resolved text this is.
pub fn digest_of(resolved: &str) -> String {
    hash(resolved).to_hex().to_string()
}

fn hash(resolved: &str) -> blake3::Hash {
    let mut hasher = blake3::Hasher::new();
    hasher.update(b"opshock study 1\n");
    hasher.update(resolved.as_bytes());
    hasher.finalize()
}

/// TOML of the value at a path: what was set, or what the resolution preset gives.
fn value_at(settings: &Settings, path: &str) -> Option<String> {
    if let Some(setting) = settings.get(path) {
        return Some(if setting.is_axis {
            format!(
                "[{}]",
                setting
                    .values
                    .iter()
                    .map(datum)
                    .collect::<Vec<_>>()
                    .join(", ")
            )
        } else {
            datum(&setting.values[0])
        });
    }
    let key = keys::find(path)?;
    let is_axis = |path| settings.get(path).is_some_and(|setting| setting.is_axis);
    let follows_axis = is_axis(fields::RESOLUTION_PRESET.path())
        || path == fields::RESOLUTION_COUPLING_TOLERANCE.path()
            && is_axis(fields::RESOLUTION_HEAD_TOLERANCE.path())
        || path == fields::RESOLUTION_FILM_CORRECTION_CELLS.path() && has_skews(settings);
    (key.presence == Presence::ByPreset && !follows_axis)
        .then(|| preset_value(settings, path))
        .flatten()
}

/// Whether points differ in their skew, on which the defect-correction grid depends.
fn has_skews(settings: &Settings) -> bool {
    const SKEW: &str = fields::SLIDER_SKEW_DEG.path();
    let is_axis = settings.get(SKEW).is_some_and(|setting| setting.is_axis);
    is_axis || settings.per_head().any(|own| own == SKEW)
}

/// A value the preset gives, back in the unit of its key.
fn preset_value(settings: &Settings, path: &str) -> Option<String> {
    let view = View::first(settings);
    let base = scene::resolutions(&view);
    let values = [
        (
            fields::RESOLUTION_DISK_CUT_KHZ.path(),
            number(base.disk.cut_hz / 1e3),
        ),
        (
            fields::RESOLUTION_DISK_HARMONICS.path(),
            base.disk.n_harmonics.to_string(),
        ),
        (
            fields::RESOLUTION_DISK_ELEMENTS.path(),
            base.disk.n_elements.to_string(),
        ),
        (
            fields::RESOLUTION_STATIC_CORRECTION.path(),
            base.disk.static_correction.to_string(),
        ),
        (
            fields::RESOLUTION_STRUCTURE_STEP_US.path(),
            number(nearest(base.structure.step_s, 1e6)),
        ),
        (
            fields::RESOLUTION_HEAD_TOLERANCE.path(),
            number(base.head.tolerance),
        ),
        (
            fields::RESOLUTION_APPROACH_SHARE.path(),
            number(base.head.approach_share),
        ),
        (
            fields::RESOLUTION_FILM_CELLS.path(),
            base.film.cells.to_string(),
        ),
        (
            fields::RESOLUTION_FILM_CORRECTION_CELLS.path(),
            base.film.correction_cells.to_string(),
        ),
        (
            fields::RESOLUTION_MIN_FILM_HEIGHT_NM.path(),
            number(nearest(base.film.min_height_m, 1e9)),
        ),
        (
            fields::RESOLUTION_COUPLING_TOLERANCE.path(),
            number(base.head.coupling_tolerance),
        ),
        (
            fields::RESOLUTION_SUSPENSION_MODES.path(),
            base.head.suspension_modes.to_string(),
        ),
    ];
    let found = values.into_iter().find(|(known, _)| *known == path)?;
    Some(found.1)
}

/// The value in a decimal unit that becomes `si` when divided by `scale`, with few digits.
fn nearest(si: f64, scale: f64) -> f64 {
    let raw = si * scale;
    let rounded: f64 = format!("{raw:.12e}").parse().unwrap_or(raw);
    if rounded / scale == si { rounded } else { raw }
}

fn datum(value: &Datum) -> String {
    let list = |items: Vec<String>| format!("[{}]", items.join(", "));
    match value {
        Datum::Number(value) => number(*value),
        Datum::Integer(value) => value.to_string(),
        Datum::Word(word) | Datum::Text(word) => text_literal(word),
        Datum::Flag(flag) => flag.to_string(),
        Datum::Words(words) => list(words.iter().map(|word| text_literal(word)).collect()),
        Datum::Numbers(numbers) => list(numbers.iter().map(|value| number(*value)).collect()),
        Datum::Pair([from, to]) => format!("[{}, {}]", number(*from), number(*to)),
        Datum::Points(points) => list(
            points
                .iter()
                .map(|[x, y]| format!("[{}, {}]", number(*x), number(*y)))
                .collect(),
        ),
        Datum::Entries(count) => count.to_string(),
    }
}

/// Shortest digits with a point or exponent; minus zero is zero.
fn number(value: f64) -> String {
    format!("{:?}", value + 0.0)
}

/// A basic TOML string.
fn text_literal(text: &str) -> String {
    let mut out = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            control if control.is_control() => {
                let _ = write!(out, "\\u{:04X}", control as u32);
            }
            other => out.push(other),
        }
    }
    out.push('"');
    out
}
