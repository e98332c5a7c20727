//! From a tree of TOML values to checked settings, by the table of keys.
//!
//! Every value is checked alone here: known key, kind, range, usual range. What depends on
//! several keys is checked in [`super::validity`].

use super::fault::StudyError;
use super::key::{Key, Kind, Range};
use super::keys;
use super::settings::{Datum, Setting, Settings};
use super::source::{Origin, Place};
use super::suggest;
use super::tree::{self, Node, Value};

/// Most values of one axis, and most points of a study.
pub const MAX_POINTS: usize = 100_000;

/// Reads trees into settings and collects faults.
#[derive(Debug, Default)]
pub struct Reader {
    /// What was read.
    pub settings: Settings,
    /// Errors.
    pub errors: Vec<StudyError>,
    /// Warnings and notes.
    pub remarks: Vec<StudyError>,
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
                self.errors.push(suggest::unknown(
                    &child.key_place,
                    pattern,
                    &child_path,
                    name,
                    child,
                    is_section,
                ));
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

    /// The values of an axis: some, all different, not too many.
    fn check_axis(&mut self, path: &str, node: &Node, values: &[Datum], places: &[Place]) -> bool {
        if values.is_empty() {
            let fault = StudyError::at(
                "E154",
                &node.place,
                path,
                "the list is empty: an axis needs at least one value",
            )
            .value("[]")
            .allowed("one or more values");
            self.spoil(path, fault);
            return false;
        }
        if values.len() > MAX_POINTS {
            self.spoil(
                path,
                too_many_points(&node.place, path, values.len() as f64),
            );
            return false;
        }
        let mut sorted: Vec<(String, usize)> = values
            .iter()
            .enumerate()
            .map(|(position, value)| (format!("{value:?}"), position))
            .collect();
        sorted.sort();
        for pair in sorted.windows(2) {
            if pair[0].0 == pair[1].0 {
                let place = places.get(pair[1].1).unwrap_or(&node.place);
                let fault =
                    StudyError::at("E154", place, path, "the axis holds the same value twice")
                        .value(place.text())
                        .allowed("values that differ")
                        .hint("leave one of the two out");
                self.spoil(path, fault);
                return false;
            }
        }
        true
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

    fn points(&mut self, key: &'static Key, path: &str, items: &[Node]) -> Option<Datum> {
        let mut points = Vec::new();
        let mut good = true;
        for item in items {
            let corner = match &item.value {
                Value::List(pair) if pair.len() == 2 => {
                    match (
                        self.any_number(key, path, &pair[0]),
                        self.any_number(key, path, &pair[1]),
                    ) {
                        (Some(Datum::Number(x)), Some(Datum::Number(y))) => Some([x, y]),
                        _ => {
                            good = false;
                            continue;
                        }
                    }
                }
                _ => None,
            };
            match corner {
                Some(corner) => points.push(corner),
                None => {
                    let fault = self.wrong_kind(key, path, item);
                    self.errors.push(fault);
                    good = false;
                }
            }
        }
        good.then_some(Datum::Points(points))
    }

    /// A single number, word, flag or text.
    fn single(&mut self, key: &'static Key, path: &str, node: &Node) -> Option<Datum> {
        match (key.kind, &node.value) {
            (Kind::Number(_) | Kind::NumberOrWord(..), Value::Integer(..) | Value::Float(_)) => {
                self.any_number(key, path, node)
            }
            (Kind::NumberOrWord(_, words), Value::Text(text)) => {
                if words.contains(&text.as_str()) {
                    return Some(Datum::Word(text.clone()));
                }
                self.errors.push(not_a_word(key, path, node, text, words));
                None
            }
            (Kind::Integer(low, high), Value::Integer(..) | Value::Float(_)) => {
                self.integer(key, path, node, low, high)
            }
            (Kind::Word(words), Value::Text(_)) => {
                self.word(key, path, node, words).map(Datum::Word)
            }
            (Kind::Flag, Value::Flag(flag)) => Some(Datum::Flag(*flag)),
            (Kind::Text, Value::Text(text)) => Some(Datum::Text(text.clone())),
            _ => {
                let fault = self.wrong_kind(key, path, node);
                self.errors.push(fault);
                None
            }
        }
    }

    fn word(
        &mut self,
        key: &'static Key,
        path: &str,
        node: &Node,
        words: &[&'static str],
    ) -> Option<String> {
        match &node.value {
            Value::Text(text) if words.contains(&text.as_str()) => Some(text.clone()),
            Value::Text(text) => {
                self.errors.push(not_a_word(key, path, node, text, words));
                None
            }
            _ => {
                let fault = self.wrong_kind(key, path, node);
                self.errors.push(fault);
                None
            }
        }
    }

    /// A number's text as f64, refusing nan, infinity and what f64 cannot hold.
    fn any_number(&mut self, key: &'static Key, path: &str, node: &Node) -> Option<Datum> {
        match self.finite(key, path, node) {
            Some(value) => self.number(key, path, value, node),
            None => None,
        }
    }

    fn finite(&mut self, key: &'static Key, path: &str, node: &Node) -> Option<f64> {
        let (value, text) = match &node.value {
            Value::Float(text) => (text.parse::<f64>().ok(), text.as_str()),
            Value::Integer(digits, radix) => (
                i128::from_str_radix(digits, *radix)
                    .ok()
                    .map(|value| value as f64),
                digits.as_str(),
            ),
            _ => {
                let fault = self.wrong_kind(key, path, node);
                self.errors.push(fault);
                return None;
            }
        };
        let lower = text.to_ascii_lowercase();
        if lower.contains("nan") || lower.contains("inf") {
            self.errors.push(
                StudyError::at("E120", &node.place, path, "must be finite")
                    .value(node.place.text())
                    .allowed(key.kind.allowed())
                    .hint(format!("for example {}", key.example())),
            );
            return None;
        }
        let mantissa = lower.split('e').next().unwrap_or("");
        let lost = |value: f64| {
            value == 0.0
                && matches!(node.value, Value::Float(_))
                && mantissa.bytes().any(|digit| (b'1'..=b'9').contains(&digit))
        };
        match value {
            Some(value) if value.is_finite() && !lost(value) => Some(value),
            _ => {
                self.errors.push(
                    StudyError::at(
                        "E121",
                        &node.place,
                        path,
                        "outside the range of double precision",
                    )
                    .value(node.place.text())
                    .allowed("0, or a magnitude from 5e-324 to 1.7e308")
                    .hint(format!("for example {}", key.example())),
                );
                None
            }
        }
    }

    /// Range and usual range of a number.
    fn number(&mut self, key: &'static Key, path: &str, value: f64, node: &Node) -> Option<Datum> {
        let range = number_range(key.kind)?;
        let unit = super::unit::of_path(path)
            .map(|unit| format!(" {}", unit.symbol))
            .unwrap_or_default();
        let shown = match node.value {
            Value::Table(_) => format!("{value}"),
            _ => node.place.text().to_string(),
        };
        if !range.contains(value) {
            let mut fault = StudyError::at(key.code, &node.place, path, format!("must be {range}"))
                .value(&shown)
                .allowed(format!("{range}{unit}"));
            fault = match (key.path, value < 0.0) {
                ("disk.rpm", true) => {
                    fault.hint("a mirrored drive has the other angle between ramp and slider")
                }
                _ => fault.hint(format!("for example {}", key.example())),
            };
            self.errors.push(fault);
            return None;
        }
        if let Some((low, high)) = key.usual
            && node.place.origin != Origin::Default
            && value != 0.0
            && !(low..=high).contains(&value)
        {
            self.remarks.push(
                StudyError::at(
                    "W201",
                    &node.place,
                    path,
                    format!("outside the usual range {low} to {high}{unit}"),
                )
                .value(&shown)
                .allowed(format!("usually {low} to {high}{unit}"))
                .hint("check the unit in the key's name; accept with --accept W201"),
            );
        }
        if key.code == "E132" && key.name().ends_with("ratio") && value >= 1.0 {
            self.remarks.push(
                StudyError::at("W202", &node.place, path, "overdamped")
                    .value(&shown)
                    .allowed("usually below 1")
                    .hint("a ratio of 0.02 is 2 %; accept with --accept W202"),
            );
        }
        Some(Datum::Number(value))
    }

    fn integer(
        &mut self,
        key: &'static Key,
        path: &str,
        node: &Node,
        low: i64,
        high: i64,
    ) -> Option<Datum> {
        let allowed = format!("whole numbers {low} to {high}");
        let fault = |code: &'static str, message: String| {
            StudyError::at(code, &node.place, path, message)
                .value(node.place.text())
                .allowed(&allowed)
        };
        let (digits, radix) = match &node.value {
            Value::Integer(digits, radix) => (digits, *radix),
            _ => {
                self.finite(key, path, node)?;
                self.errors.push(fault(
                    "E134",
                    "must be a whole number, without a decimal point".to_string(),
                ));
                return None;
            }
        };
        // Beyond i128 is beyond every limit of the table.
        let value = i128::from_str_radix(digits, radix).unwrap_or(if digits.starts_with('-') {
            i128::MIN
        } else {
            i128::MAX
        });
        if (i128::from(low)..=i128::from(high)).contains(&value) {
            return Some(Datum::Integer(value as i64));
        }
        self.errors.push(if key.path == "study_format" {
            fault("E134", "this program reads format 1".to_string())
                .hint("a newer opshock may read this file")
        } else if value < 0 {
            fault("E134", "must not be negative".to_string())
                .hint(format!("for example {}", key.example()))
        } else if value < i128::from(low) {
            fault("E135", "is too small".to_string()).hint(format!("for example {}", key.example()))
        } else {
            fault("E135", "is too large".to_string()).hint(memory_hint(key.path, value as f64))
        });
        None
    }

    /// Values of `{ from, to, count, spacing }`.
    fn spaced(&mut self, key: &'static Key, path: &str, node: &Node) -> Option<Vec<f64>> {
        let Value::Table(members) = &node.value else {
            return None;
        };
        const SHAPE: &str = "{ from = 0.25, to = 4.0, count = 9, spacing = \"log\" }";
        let mut good = true;
        for (name, member) in members {
            if !["from", "to", "count", "spacing"].contains(&name.as_str()) {
                self.errors.push(
                    StudyError::at("E110", &member.key_place, &join(path, name), "unknown key")
                        .allowed("from, to, count, spacing")
                        .hint(
                            suggest::nearest(name, &["from", "to", "count", "spacing"])
                                .map_or(format!("write {SHAPE}"), |near| {
                                    format!("did you mean {near}?")
                                }),
                        ),
                );
                good = false;
            }
        }
        let missing: Vec<&str> = ["from", "to", "count"]
            .into_iter()
            .filter(|name| node.get(name).is_none())
            .collect();
        if !missing.is_empty() {
            self.errors.push(
                StudyError::at(
                    "E112",
                    &node.place,
                    path,
                    format!("missing {}", missing.join(", ")),
                )
                .allowed(SHAPE),
            );
            good = false;
        }
        if !good {
            return None;
        }
        let from = self.finite(key, &join(path, "from"), node.get("from")?);
        let to = self.finite(key, &join(path, "to"), node.get("to")?);
        let count_node = node.get("count")?;
        let count_key = &COUNT;
        let count = self.single(count_key, &join(path, "count"), count_node);
        let spacing = match node.get("spacing") {
            None => Some("linear".to_string()),
            Some(word) => self.word(&SPACING, &join(path, "spacing"), word, &["linear", "log"]),
        };
        let (from, to, Some(Datum::Integer(count)), spacing) = (from?, to?, count, spacing?) else {
            return None;
        };
        let refuse = |code: &'static str, at: &Node, message: &str, allowed: &str| {
            StudyError::at(code, &at.place, path, message)
                .value(node.place.text())
                .allowed(allowed)
        };
        if from >= to {
            self.errors.push(refuse(
                "E154",
                node,
                "the axis runs backwards or stands still",
                "from < to",
            ));
            return None;
        }
        if count as usize > MAX_POINTS {
            self.errors
                .push(too_many_points(&count_node.place, path, count as f64));
            return None;
        }
        let log = spacing == "log";
        if log && from <= 0.0 {
            self.errors.push(refuse(
                "E154",
                node,
                "a log axis needs values above 0",
                "from > 0",
            ));
            return None;
        }
        let last = count as usize - 1;
        Some(
            (0..=last)
                .map(|position| match position {
                    0 => from,
                    _ if position == last => to,
                    _ => {
                        let share = position as f64 / last as f64;
                        if log {
                            from * (to / from).powf(share)
                        } else {
                            from + (to - from) * share
                        }
                    }
                })
                .collect(),
        )
    }

    fn wrong_kind(&self, key: &'static Key, path: &str, node: &Node) -> StudyError {
        let fault = StudyError::at(
            "E113",
            &node.place,
            path,
            format!(
                "expected {}, found {}",
                key.kind.expected(),
                node.value.kind()
            ),
        )
        .value(node.place.text())
        .allowed(key.kind.allowed());
        match (&node.value, key.kind) {
            (
                Value::Text(text),
                Kind::Number(_) | Kind::Integer(..) | Kind::Axis(_) | Kind::NumberOrWord(..),
            ) => {
                let number: String = text
                    .trim()
                    .chars()
                    .take_while(|letter| letter.is_ascii_digit() || "+-.eE".contains(*letter))
                    .collect();
                if number.parse::<f64>().is_ok() {
                    fault.hint(format!(
                        "write {} = {number}: without quotes, the unit is in the key's name",
                        key.name()
                    ))
                } else {
                    fault.hint(format!("for example {} = {}", key.name(), key.example()))
                }
            }
            _ => fault.hint(format!("for example {} = {}", key.name(), key.example())),
        }
    }
}

static COUNT: Key = Key::required(
    "count",
    Kind::Integer(2, 1_000_000_000_000),
    "9",
    "Number of values.",
);
static SPACING: Key = Key::required(
    "spacing",
    Kind::Word(&["linear", "log"]),
    "\"log\"",
    "Spacing.",
);

fn number_range(kind: Kind) -> Option<Range> {
    match kind {
        Kind::Number(range)
        | Kind::NumberOrWord(range, _)
        | Kind::Axis(range)
        | Kind::Numbers(range)
        | Kind::Pair(range) => Some(range),
        Kind::Points => Some(super::key::ANY),
        _ => None,
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

fn not_a_word(key: &Key, path: &str, node: &Node, text: &str, words: &[&str]) -> StudyError {
    let code = if key.code == "E130" || matches!(key.kind, Kind::NumberOrWord(..)) {
        "E113"
    } else {
        key.code
    };
    let message = match code {
        "E157" => "not an accuracy opshock has a named rung for".to_string(),
        "E158" => "unknown output".to_string(),
        _ => "not one of the words allowed here".to_string(),
    };
    let fault = StudyError::at(code, &node.place, path, message)
        .value(node.place.text())
        .allowed(key.kind.allowed());
    match (code, suggest::nearest(text, words)) {
        ("E157", _) => {
            fault.hint("the finest rung reaches 0.1%; single resolutions can be set finer")
        }
        (_, Some(near)) => fault.hint(format!("did you mean {near:?}?")),
        _ => fault,
    }
}

/// The refusal of a study with too many points, with what it would cost.
pub fn too_many_points(place: &Place, path: &str, count: f64) -> StudyError {
    // About 15 simulations of 0.3 s and 300 bytes in the journal each.
    let hours = count * 15.0 * 0.3 / 3600.0;
    let gigabytes = count * 15.0 * 300.0 / 1e9;
    StudyError::at(
        "E155",
        place,
        path,
        format!(
            "{count:.0} points are too many: about {hours:.0} core hours and {gigabytes:.1} GB"
        ),
    )
    .allowed(format!("at most {MAX_POINTS} points"))
    .hint("split the study, or take coarser axes")
}

fn memory_hint(path: &str, count: f64) -> String {
    let bytes = match path {
        // Sparse factors by nested dissection: about 31 n log2 n entries.
        "solver.film_cells" => 8.0 * 31.0 * count * count.max(2.0).log2(),
        // Two shapes of 2 (elements + 1) freedoms and as many modes per harmonic.
        "solver.disk_harmonics" => count * 2.0 * 82.0 * 82.0 * 8.0,
        "solver.disk_elements" => 8.0 * (2.0 * count + 2.0).powi(2),
        "solver.suspension_modes" => 8.0 * count * count,
        _ => return "take a smaller number".to_string(),
    };
    format!(
        "it would take about {:.1} GB of memory in every worker",
        bytes / 1e9
    )
}

/// A path with one more name.
pub fn join(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_string()
    } else {
        format!("{path}.{name}")
    }
}
