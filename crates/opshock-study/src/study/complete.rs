//! Completes the settings read from a study file: alternatives, defaults, and an error for every missing key.

use super::datum::Datum;
use super::fault::StudyError;
use super::fields;
use super::imported_base;
use super::imported_suspension;
use super::included::{self, Location};
use super::key::{Key, Presence};
use super::keys::{CHOICES, KEYS};
use super::measured_pulse;
use super::ramp_mesh;
use super::read::Reader;
use super::source::{Origin, Place};
use super::tree::{Node, Value};
use super::unit;

/// Completes the settings read from a file and the command line. `root` is the merged tree.
pub fn complete(reader: &mut Reader, root: &Node, location: &Location) {
    let heads = heads(reader);
    settle_clearances(reader);
    for of in std::iter::once("").chain(heads.iter().map(String::as_str)) {
        settle_choices(reader, of);
    }
    included::surface_base(reader, location);
    for head in &heads {
        included::surface_of_head(reader, location, head);
    }
    measured_pulse::read(reader, location);
    defaults(reader);
    // The gap between its contacts is compared with the disk's thickness.
    ramp_mesh::read(reader, location);
    for of in std::iter::once("").chain(heads.iter().map(String::as_str)) {
        imported_suspension::read(reader, location, of);
    }
    imported_base::read(reader, location);
    missing(reader, root, &heads);
}

/// What the keys of every head's own begin with: `heads[0].`, `heads[1].`, ...
fn heads(reader: &Reader) -> Vec<String> {
    let count = match reader.settings.get("heads").map(|list| &list.values[0]) {
        Some(Datum::Entries(count)) => *count,
        _ => 0,
    };
    (0..count).map(|entry| format!("heads[{entry}].")).collect()
}

/// Whether a key comes from the command line.
fn is_set(reader: &Reader, path: &str) -> bool {
    let setting = reader.settings.get(path);
    setting.is_some_and(|setting| matches!(setting.origin(), Origin::Set(_)))
}

/// The general clearance from the command line replaces the special ones of the file.
fn settle_clearances(reader: &mut Reader) {
    if is_set(reader, fields::RAMP_CLEARANCE_UM.path()) {
        for side in [
            fields::RAMP_CLEARANCE_TOP_UM.path(),
            fields::RAMP_CLEARANCE_BOTTOM_UM.path(),
        ] {
            if !is_set(reader, side) {
                reader.settings.remove(side);
            }
        }
    }
}

/// Of keys that exclude each other, those of the command line stay; `of` is what stands before them.
fn settle_choices(reader: &mut Reader, of: &str) {
    for choice in CHOICES {
        let alternatives = choice.alternatives.iter();
        let own = |paths: &&[&str]| paths.iter().map(|path| format!("{of}{path}")).collect();
        let given: Vec<Vec<String>> = alternatives
            .map(own)
            .filter(|paths: &Vec<String>| paths.iter().any(|path| reader.settings.has(path)))
            .collect();
        if given.len() < 2 {
            continue;
        }
        let from_set: Vec<bool> = given
            .iter()
            .map(|paths| paths.iter().any(|path| is_set(reader, path)))
            .collect();
        if from_set.iter().filter(|set| **set).count() == 1 {
            for (paths, set) in given.iter().zip(from_set) {
                if !set {
                    paths.iter().for_each(|path| reader.settings.remove(path));
                }
            }
            continue;
        }
        let mut paths: Vec<&str> = given
            .iter()
            .flatten()
            .map(String::as_str)
            .filter(|path| reader.settings.has(path))
            .collect();
        paths.sort_by_key(|path| {
            reader
                .settings
                .get(path)
                .map(|setting| setting.key_place.span.start)
        });
        if let Some(last) = paths.last().copied()
            && let Some(setting) = reader.settings.get(last)
        {
            let fault = StudyError::at(
                "E115",
                &setting.key_place,
                last,
                format!("{} is given twice: {}", choice.what, paths.join(" and ")),
            )
            .value(setting.place.text())
            .allowed("one of the two")
            .hint("leave one out");
            reader.errors.push(fault);
        }
    }
}

/// Fills in the defaults of keys that the study does not set.
fn defaults(reader: &mut Reader) {
    let unchosen = |reader: &Reader, path: &str| {
        CHOICES.iter().any(|choice| {
            choice.alternatives.iter().any(|paths| {
                !paths.contains(&path)
                    && paths
                        .iter()
                        .any(|other| reader.settings.has(other) || reader.settings.is_spoilt(other))
            }) && choice
                .alternatives
                .iter()
                .any(|paths| paths.contains(&path))
        })
    };
    let partner_given = |reader: &Reader, path: &str| {
        CHOICES
            .iter()
            .flat_map(|choice| choice.alternatives)
            .any(|paths| {
                paths.contains(&path)
                    && paths.iter().any(|other| {
                        *other != path
                            && (reader.settings.is_spoilt(other)
                                || reader.settings.get(other).is_some_and(|s| {
                                    // The command line alone may change one of a pair.
                                    matches!(s.origin(), Origin::File | Origin::Included)
                                }))
                    })
            })
    };
    for key in KEYS.iter().filter(|key| !key.path.contains("[]")) {
        let absent = !reader.settings.has(key.path);
        match key.presence {
            Presence::Default(literal) if absent => reader.literal(key, key.path, literal),
            Presence::Together(literal) if absent && !unchosen(reader, key.path) => {
                if !reader.settings.is_spoilt(key.path) && partner_given(reader, key.path) {
                    continue;
                }
                reader.literal(key, key.path, literal);
            }
            // A required key whose value cannot be used keeps its example for the other checks.
            Presence::Required if absent && reader.settings.is_spoilt(key.path) => {
                reader.literal(key, key.path, key.example);
            }
            _ => {}
        }
    }
    // Entries of lists of tables: as above.
    let left_out: Vec<(String, &'static Key, &'static str)> = entry_paths(reader)
        .into_iter()
        .filter(|(path, _)| !reader.settings.has(path))
        .filter_map(|(path, key)| match key.presence {
            Presence::Default(literal) => Some((path, key, literal)),
            Presence::Required if !reader.settings.are_sound(&[path.as_str()]) => {
                Some((path, key, key.example))
            }
            _ => None,
        })
        .collect();
    for (path, key, literal) in left_out {
        reader.literal(key, &path, literal);
    }
}

/// Every member of every entry of every list of tables that is set.
fn entry_paths(reader: &Reader) -> Vec<(String, &'static Key)> {
    let members = KEYS.iter().filter(|key| key.path.contains("[]."));
    let paths = |key: &'static Key| entries(reader, key.path).into_iter().map(move |p| (p, key));
    members.flat_map(paths).collect()
}

/// A path of the table of keys at every entry of its lists.
fn entries(reader: &Reader, pattern: &str) -> Vec<String> {
    let Some((list, member)) = pattern.split_once("[]") else {
        return vec![pattern.to_string()];
    };
    let count = match reader.settings.get(list).map(|setting| &setting.values[0]) {
        Some(Datum::Entries(count)) => *count,
        _ => 0,
    };
    let at = |position: usize| entries(reader, &format!("{list}[{position}]{member}"));
    (0..count).flat_map(at).collect()
}

/// One E112 for everything that must be given and is not.
fn missing(reader: &mut Reader, root: &Node, heads: &[String]) {
    let mut absent: Vec<(String, &'static Key)> = KEYS
        .iter()
        .filter(|key| !key.path.contains("[]"))
        .filter(|key| matches!(key.presence, Presence::Required))
        .map(|key| (key.path.to_string(), key))
        .chain(
            entry_paths(reader)
                .into_iter()
                .filter(|(_, key)| key.presence == Presence::Required),
        )
        .filter(|(path, _)| !reader.settings.has(path))
        .filter(|(path, _)| {
            // Nothing is known about the members of a table that is no table.
            let mut above = path.as_str();
            loop {
                if reader.settings.is_spoilt(above) {
                    return false;
                }
                match above.rfind(['.', '[']) {
                    Some(cut) => above = &above[..cut],
                    None => return true,
                }
            }
        })
        .collect();
    let alternatives = CHOICES.iter().flat_map(|choice| choice.alternatives);
    for paths in alternatives {
        for of in std::iter::once("").chain(heads.iter().map(String::as_str)) {
            let is_there =
                |path: &str| reader.settings.has(path) || reader.settings.is_spoilt(path);
            let paths = paths.iter().map(|path| format!("{of}{path}"));
            let (given, gone): (Vec<_>, Vec<_>) = paths.partition(|path| is_there(path));
            if !given.is_empty() {
                let key = |path: String| super::keys::find(&path).map(|key| (path, key));
                absent.extend(gone.into_iter().filter_map(key));
            }
        }
    }
    let mut rails = Vec::new();
    for (path, setting) in reader.settings.iter() {
        let Some(rail) = path
            .strip_suffix(".kind")
            .filter(|rail| rail.contains("slider.surface.rail["))
        else {
            continue;
        };
        let needed: &[&str] = match &setting.values[0] {
            Datum::Word(word) if word == "polygon" => &["points_um"],
            _ => &["x_um", "y_um"],
        };
        for name in needed {
            let member = format!("{rail}.{name}");
            if !reader.settings.has(&member)
                && !reader.settings.is_spoilt(&member)
                && let Some(key) = super::keys::find(&member)
            {
                rails.push((member, key));
            }
        }
    }
    absent.extend(rails);
    if absent.is_empty() {
        return;
    }
    let place = nearest_place(reader, root, &absent[0].0);
    let list: Vec<String> = absent
        .iter()
        .map(|(path, key)| {
            let unit = unit::of_path(path)
                .map(|unit| format!(" in {}", unit.symbol))
                .unwrap_or_default();
            format!(
                "{path}{unit}, for example {} = {}",
                key.name(),
                key.example()
            )
        })
        .collect();
    let names: Vec<&str> = absent.iter().map(|(path, _)| path.as_str()).collect();
    let fault = StudyError::at(
        "E112",
        &place,
        &names.join(", "),
        format!(
            "missing {}: {}",
            if names.len() == 1 { "key" } else { "keys" },
            list.join("; ")
        ),
    )
    .allowed(
        absent
            .iter()
            .map(|(_, key)| key.kind.allowed())
            .collect::<Vec<_>>()
            .join("; "),
    )
    .hint("`opshock new` prints the smallest valid study");
    reader.errors.push(fault);
    for (path, key) in &absent {
        reader.settings.spoil(path);
        reader.literal(key, path, key.example());
    }
}

/// Place of the innermost table on the way to `path` that the study has.
fn nearest_place(reader: &Reader, root: &Node, path: &str) -> Place {
    if let Some((list, rest)) = path.split_once('[')
        && let Some(setting) = reader.settings.get(list)
        && let Some(position) = rest
            .split(']')
            .next()
            .and_then(|digits| digits.parse().ok())
        && let Some(place) = setting.value_places.get::<usize>(position)
    {
        return place.clone();
    }
    let mut here = root;
    for name in path.split('.') {
        match here.get(name) {
            Some(node) if matches!(node.value, Value::Table(_)) => here = node,
            _ => break,
        }
    }
    let mut place = if std::ptr::eq(here, root) {
        root.place.clone()
    } else {
        here.key_place.clone()
    };
    if std::ptr::eq(here, root) {
        place.span = 0..0;
    }
    place
}
