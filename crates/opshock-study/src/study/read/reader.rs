//! Reads the members of a TOML table, each by its line of the table of keys, and collects faults.

use super::limit::{MAX_POINTS, too_many_points};
use crate::study::datum::Datum;
use crate::study::fault::StudyError;
use crate::study::key::{Key, Kind};
use crate::study::keys;
use crate::study::recorded::MeasuredPulse;
use crate::study::settings::{Setting, Settings};
use crate::study::suggest;
use crate::study::tree::{self, Node, Value};

/// Reads trees into settings and collects faults.
#[derive(Debug, Default)]
pub struct Reader {
    /// What was read.
    pub settings: Settings,
    /// Errors.
    pub errors: Vec<StudyError>,
    /// Warnings and notes.
    pub remarks: Vec<StudyError>,
    /// The record of a pulse that a file gives.
    pub measured: Option<MeasuredPulse>,
}

impl Reader {
    /// Reads a table's members. `pattern` is its path in the table of keys (`modes[]`), `path` its
    /// path with list positions (`modes[0]`). Keys already set stay as they are.
    pub fn table(&mut self, node: &Node, pattern: &str, path: &str) {
        let Value::Table(members) = &node.value else {
            return;
        };
        for (name, child) in members {
            let child_pattern = join(pattern, name);
            let child_path = join(path, name);
            if let Some(key) = keys::KEYS.iter().find(|key| key.path == child_pattern) {
                if !self.settings.has(&child_path) && !self.settings.is_spoilt(&child_path) {
                    self.key(key, &child_path, child);
                }
            } else if keys::is_table(&child_pattern) {
                match &child.value {
                    Value::Table(_) => self.table(child, &child_pattern, &child_path),
                    other => {
                        let fault = StudyError::at(
                            "E113",
                            &child.place,
                            &child_path,
                            format!("expected a table, found {}", other.kind()),
                        )
                        .value(child.place.text())
                        .allowed(format!(
                            "keys {}",
                            keys::names_below(&child_pattern).join(", ")
                        ))
                        .hint(format!("write [{child_path}] with its keys below"));
                        self.errors.push(fault);
                        self.settings.spoil(&child_path);
                    }
                }
            } else {
                let is_section = pattern.is_empty() && matches!(child.value, Value::Table(_));
                let unknown = suggest::unknown(
                    &child.key_place,
                    pattern,
                    &child_path,
                    name,
                    child,
                    is_section,
                );
                self.errors.push(unknown.fault);
                // The key was given, though in a wrong unit: it is not missing as well.
                if let Some(meant) = unknown.meant
                    && node.get(meant).is_none()
                {
                    self.settings.spoil(&join(path, meant));
                }
            }
        }
    }

    /// Reads the value of one key.
    pub fn key(&mut self, key: &'static Key, path: &str, node: &Node) {
        if key.kind == Kind::Tables {
            return self.tables(key, path, node);
        }
        let (values, places, is_axis) = match (&node.value, key.kind) {
            (Value::List(items), kind) if kind.is_single() => {
                if !key.may_be_axis() {
                    let fault = self
                        .wrong_kind(key, path, node)
                        .hint("this key cannot be an axis of the study");
                    return self.spoil(path, fault);
                }
                let values = items
                    .iter()
                    .map(|item| self.single(key, path, item))
                    .collect::<Vec<_>>();
                let places = items.iter().map(|item| item.place.clone()).collect();
                (values, places, true)
            }
            (Value::Table(_), Kind::Number(_)) if key.may_be_axis() => {
                let Some(values) = self.spaced(key, path, node) else {
                    return;
                };
                let places = vec![node.place.clone(); values.len()];
                (
                    values
                        .into_iter()
                        .map(|value| self.number(key, path, value, node))
                        .collect(),
                    places,
                    true,
                )
            }
            (Value::List(items), _) => {
                let places = items.iter().map(|item| item.place.clone()).collect();
                (vec![self.whole(key, path, node)], places, false)
            }
            _ => (vec![self.whole(key, path, node)], Vec::new(), false),
        };
        // A value without a datum was reported; the key keeps a stand-in for further checks.
        if values.iter().any(Option::is_none) {
            self.settings.spoil(path);
            return;
        }
        let values: Vec<Datum> = values.into_iter().flatten().collect();
        if is_axis && !self.check_axis(path, node, &values, &places) {
            return;
        }
        self.settings.put(
            path.to_string(),
            Setting {
                values,
                is_axis,
                place: node.place.clone(),
                key_place: node.key_place.clone(),
                value_places: places,
            },
        );
    }

    /// Reads a literal of the table of keys.
    pub fn literal(&mut self, key: &'static Key, path: &str, literal: &'static str) {
        self.key(key, path, &tree::literal(literal));
    }

    /// Reports a fault and marks its key as not usable.
    pub fn spoil(&mut self, path: &str, fault: StudyError) {
        self.errors.push(fault);
        self.settings.spoil(path);
    }

    fn tables(&mut self, key: &'static Key, path: &str, node: &Node) {
        let Value::List(items) = &node.value else {
            let fault = self.wrong_kind(key, path, node);
            return self.spoil(path, fault);
        };
        if items.is_empty() {
            let fault = StudyError::at("E135", &node.place, path, "the list is empty")
                .value("[]")
                .allowed("at least one entry")
                .hint(format!("for example {}", key.example()));
            return self.spoil(path, fault);
        }
        if items.len() > 10_000 {
            let fault = StudyError::at(
                "E135",
                &node.place,
                path,
                format!("{} entries are too many", items.len()),
            )
            .allowed("at most 10000 entries");
            return self.spoil(path, fault);
        }
        self.settings.put(
            path.to_string(),
            Setting {
                values: vec![Datum::Entries(items.len())],
                is_axis: false,
                place: node.place.clone(),
                key_place: node.key_place.clone(),
                value_places: items.iter().map(|item| item.place.clone()).collect(),
            },
        );
        for (position, item) in items.iter().enumerate() {
            let item_path = format!("{path}[{position}]");
            match &item.value {
                Value::Table(_) => self.table(item, &format!("{}[]", key.path), &item_path),
                other => {
                    let fault = StudyError::at(
                        "E113",
                        &item.place,
                        &item_path,
                        format!("expected a table, found {}", other.kind()),
                    )
                    .value(item.place.text())
                    .allowed(key.kind.expected())
                    .hint(format!("for example {}", key.example()));
                    self.spoil(&item_path, fault);
                }
            }
        }
    }

    /// A value of a key that is not a list of tables.
    fn whole(&mut self, key: &'static Key, path: &str, node: &Node) -> Option<Datum> {
        match (key.kind, &node.value) {
            (Kind::Words(words), Value::List(items)) => {
                let mut read = Vec::new();
                let mut good = true;
                for item in items {
                    match self.word(key, path, item, words) {
                        Some(word) => read.push(word),
                        None => good = false,
                    }
                }
                good.then_some(Datum::Words(read))
            }
            (Kind::Words(words), Value::Text(_)) => self
                .word(key, path, node, words)
                .map(|word| Datum::Words(vec![word])),
            (Kind::Axis(_), Value::Table(_)) => {
                let values = self.spaced(key, path, node)?;
                let read: Vec<Option<Datum>> = values
                    .iter()
                    .map(|value| self.number(key, path, *value, node))
                    .collect();
                collect_numbers(read)
            }
            (Kind::Axis(_) | Kind::Numbers(_), Value::List(items)) => {
                if items.len() > MAX_POINTS {
                    self.errors
                        .push(too_many_points(&node.place, path, items.len() as f64));
                    return None;
                }
                let read: Vec<Option<Datum>> = items
                    .iter()
                    .map(|item| self.any_number(key, path, item))
                    .collect();
                collect_numbers(read)
            }
            (Kind::Axis(_), Value::Integer(..) | Value::Float(_)) => {
                collect_numbers(vec![self.any_number(key, path, node)])
            }
            (Kind::Pair(_), Value::List(items)) if items.len() == 2 => {
                let from = self.any_number(key, path, &items[0]);
                let to = self.any_number(key, path, &items[1]);
                match (from, to) {
                    (Some(Datum::Number(from)), Some(Datum::Number(to))) if from < to => {
                        Some(Datum::Pair([from, to]))
                    }
                    (Some(_), Some(_)) => {
                        self.errors.push(
                            StudyError::at(
                                key.code,
                                &node.place,
                                path,
                                "the range runs backwards or is empty",
                            )
                            .value(node.place.text())
                            .allowed("[from, to] with from < to"),
                        );
                        None
                    }
                    _ => None,
                }
            }
            (Kind::Points, Value::List(items)) => self.points(key, path, items),
            (kind, _) if kind.is_single() || kind == Kind::Text => self.single(key, path, node),
            _ => {
                let fault = self.wrong_kind(key, path, node);
                self.errors.push(fault);
                None
            }
        }
    }
}

fn collect_numbers(read: Vec<Option<Datum>>) -> Option<Datum> {
    read.into_iter()
        .map(|value| match value {
            Some(Datum::Number(value)) => Some(value),
            _ => None,
        })
        .collect::<Option<Vec<f64>>>()
        .map(Datum::Numbers)
}

/// A path with one more name.
pub fn join(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_string()
    } else {
        format!("{path}.{name}")
    }
}
