//! Suggests what was probably meant by an unknown key or section.

use super::fault::StudyError;
use super::keys;
use super::renamed;
use super::source::Place;
use super::tree::{Node, Value};
use super::unit::{self, Dimension, Unit};

/// The nearest of some names, when one is near enough to be meant.
pub fn nearest<'a>(name: &str, names: &[&'a str]) -> Option<&'a str> {
    let lower = name.to_ascii_lowercase();
    names
        .iter()
        .map(|known| {
            // One slip is forgiven even in a word of three letters.
            let slip = lower.len() >= 3 && strsim::damerau_levenshtein(&lower, known) == 1;
            let likeness = strsim::jaro_winkler(&lower, known)
                .max(strsim::normalized_damerau_levenshtein(&lower, known))
                .max(if slip { 0.9 } else { 0.0 });
            (likeness, *known)
        })
        .filter(|(likeness, _)| *likeness >= 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, known)| known)
}

/// The error for an unknown key or section: E110, E111, or E122 to E124 when only the unit in the
/// key's name is wrong.
pub fn unknown(
    place: &Place,
    pattern: &str,
    path: &str,
    name: &str,
    node: &Node,
    is_section: bool,
) -> Unknown {
    let plain = |fault: StudyError| Unknown { fault, meant: None };
    let siblings = keys::names_below(pattern);
    if let Some(today) = renamed::key_today(path) {
        let fault = StudyError::at("E110", place, path, "this key of format 1 has another name");
        let allowed = match keys::find(today) {
            Some(key) => key.kind.wanted(),
            None => format!("keys {}", keys::names_below(today).join(", ")),
        };
        let value = match &node.value {
            Value::List(_) | Value::Table(_) => String::new(),
            Value::Text(word) => {
                let word = renamed::word_today(today, word).unwrap_or(word);
                format!(" = {word:?}")
            }
            _ => format!(" = {}", node.place.text()),
        };
        return plain(
            fault
                .value(node.place.text())
                .allowed(allowed)
                .hint(format!("write {today}{value}")),
        );
    }
    if is_section {
        let sections = keys::sections();
        let fault = StudyError::at("E111", place, path, format!("unknown section [{name}]"))
            .allowed(sections.join(", "));
        let alias = ALIASES
            .iter()
            .find(|(other, _)| *other == name.to_ascii_lowercase());
        return plain(
            match alias
                .map(|(_, section)| *section)
                .or(nearest(name, &sections))
            {
                Some(near) => fault.hint(format!("did you mean [{near}]?")),
                None => fault.hint("sections are listed by `opshock schema`"),
            },
        );
    }
    if let Some((sibling, fault)) = wrong_unit(place, path, name, &siblings) {
        return Unknown {
            fault: fault.value(node.place.text()),
            meant: Some(sibling),
        };
    }
    let table = if pattern.is_empty() {
        "at the top of the file".to_string()
    } else {
        format!("in [{pattern}]")
    };
    let fault = StudyError::at("E110", place, path, format!("unknown key {table}"))
        .value(node.place.text())
        .allowed(siblings.join(", "));
    // A name that is exact in another section beats a similar one here; directly in a section it is the likelier one.
    let elsewhere = keys::KEYS
        .iter()
        .filter(|key| key.name() == name && !key.path.contains("[]"))
        .min_by_key(|key| key.path.matches('.').count());
    plain(
        match (
            elsewhere,
            nearest(name, &siblings).or(only_with_unit(name, &siblings)),
        ) {
            (Some(key), _) => fault.hint(format!("did you mean {}?", key.path)),
            (None, Some(near)) => fault.hint(format!("did you mean {near}?")),
            (None, None) => fault.hint("keys are listed by `opshock schema`"),
        },
    )
}

/// An unknown name: the fault, and the key that was certainly meant.
pub struct Unknown {
    /// The fault.
    pub fault: StudyError,
    /// The sibling whose unit alone was written wrongly.
    pub meant: Option<&'static str>,
}

/// Other names people give sections.
const ALIASES: &[(&str, &str)] = &[
    ("shock", "pulse"),
    ("platter", "disk"),
    ("head", "slider"),
    ("air", "gas"),
    ("bearing", "gas"),
    ("numerics", "resolution"),
    ("accuracy", "resolution"),
    ("sweep", "search"),
    ("store", "output"),
];

/// The one name among the siblings that has the same unit.
fn only_with_unit<'a>(name: &str, siblings: &[&'a str]) -> Option<&'a str> {
    let wanted = unit::part(name).unit?.suffix;
    let mut same = siblings.iter().filter(|sibling| {
        unit::part(sibling)
            .unit
            .is_some_and(|unit| unit.suffix == wanted)
    });
    let only = same.next().copied();
    if same.next().is_none() { only } else { None }
}

/// E122, E123 or E124 when a sibling has the same stem and another unit.
fn wrong_unit(
    place: &Place,
    path: &str,
    name: &str,
    siblings: &[&'static str],
) -> Option<(&'static str, StudyError)> {
    let found = unit::part(name);
    let (sibling, wanted) = siblings
        .iter()
        .filter_map(|sibling| {
            let parted = unit::part(sibling);
            let unit = parted.unit?;
            let likeness = if parted.stem.is_empty() && !found.stem.is_empty() {
                0.0
            } else {
                strsim::normalized_damerau_levenshtein(
                    &found.stem.to_ascii_lowercase(),
                    parted.stem,
                )
            };
            // A slip in the stem is the ordinary E110 when the unit is right.
            let same_unit =
                found.unit.is_some_and(|other| other.suffix == unit.suffix) && !found.other_case;
            (likeness >= 0.8 && !same_unit).then_some((likeness, *sibling, unit))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, sibling, unit)| (sibling, unit))?;
    let fault = |code: &'static str, message: String| {
        StudyError::at(code, place, path, message)
            .allowed(format!("{sibling}, in {}", wanted.symbol))
            .hint(format!("did you mean {sibling}?"))
    };
    let fault = match found.unit {
        None => fault(
            "E122",
            format!(
                "give the unit in the key's name: {}",
                units_of(wanted.dimension)
            ),
        ),
        Some(unit) if unit.dimension != wanted.dimension => fault(
            "E123",
            format!(
                "expected {}, got {}: _{} is {}",
                wanted.dimension.name(),
                unit.dimension.name(),
                unit.suffix,
                unit.symbol
            ),
        ),
        Some(_) if found.other_case => fault(
            "E124",
            format!("units are written in lower case: _{}", wanted.suffix),
        ),
        Some(unit) => fault(
            "E124",
            format!(
                "expected _{} ({}), got _{} ({})",
                wanted.suffix, wanted.symbol, unit.suffix, unit.symbol
            ),
        ),
    };
    Some((sibling, fault))
}

fn units_of(dimension: Dimension) -> String {
    unit::UNITS
        .iter()
        .filter(|unit: &&Unit| unit.in_use && unit.dimension == dimension)
        .map(|unit| format!("_{}", unit.suffix))
        .collect::<Vec<_>>()
        .join(", ")
}
