//! Reads single values: numbers with range and unit, whole numbers, words, corners.

use super::message::{memory_hint, not_a_word};
use super::reader::Reader;
use crate::study::datum::Datum;
use crate::study::fault::StudyError;
use crate::study::fields;
use crate::study::key::{self, Key, Kind, Range};
use crate::study::source::Origin;
use crate::study::tree::{Node, Value};
use crate::study::unit;

impl Reader {
    pub(super) fn points(
        &mut self,
        key: &'static Key,
        path: &str,
        items: &[Node],
    ) -> Option<Datum> {
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
    pub(super) fn single(&mut self, key: &'static Key, path: &str, node: &Node) -> Option<Datum> {
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

    pub(super) fn word(
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
    pub(super) fn any_number(
        &mut self,
        key: &'static Key,
        path: &str,
        node: &Node,
    ) -> Option<Datum> {
        match self.finite(key, path, node) {
            Some(value) => self.number(key, path, value, node),
            None => None,
        }
    }

    pub(super) fn finite(&mut self, key: &'static Key, path: &str, node: &Node) -> Option<f64> {
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
    pub(super) fn number(
        &mut self,
        key: &'static Key,
        path: &str,
        value: f64,
        node: &Node,
    ) -> Option<Datum> {
        let range = number_range(key.kind)?;
        let unit = unit::of_path(path)
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
            let is_backwards = key.path == fields::DISK_RPM.path() && value < 0.0;
            fault = match is_backwards {
                true => fault.hint("a mirrored drive has the other angle between ramp and slider"),
                false => fault.hint(format!("for example {}", key.example())),
            };
            self.errors.push(fault);
            return None;
        }
        // A range above 0 is one of sizes: the sign is free.
        let within = |low: f64, high: f64| {
            let size = if low > 0.0 { value.abs() } else { value };
            (low..=high).contains(&size)
        };
        if let Some((low, high)) = key.usual
            && node.place.origin != Origin::Default
            && value != 0.0
            && !within(low, high)
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
                .hint("check the unit in the key's name"),
            );
        }
        if key.code == "E132" && key.name().ends_with("ratio") && value >= 1.0 {
            self.remarks.push(
                StudyError::at("W202", &node.place, path, "overdamped")
                    .value(&shown)
                    .allowed("usually below 1")
                    .hint("a ratio of 0.02 is 2 %"),
            );
        }
        Some(Datum::Number(value))
    }

    pub(super) fn integer(
        &mut self,
        key: &'static Key,
        path: &str,
        node: &Node,
        low: i64,
        high: i64,
    ) -> Option<Datum> {
        let allowed = key.kind.allowed();
        let fault = |code: &'static str, message: String| {
            StudyError::at(code, &node.place, path, message)
                .value(node.place.text())
                .allowed(&allowed)
        };
        let value = match &node.value {
            // Beyond i128 is beyond every limit of the table.
            Value::Integer(digits, radix) => {
                i128::from_str_radix(digits, *radix).unwrap_or(if digits.starts_with('-') {
                    i128::MIN
                } else {
                    i128::MAX
                })
            }
            // 2e3 is a whole number too; the conversion saturates.
            _ => {
                let value = self.finite(key, path, node)?;
                if value.fract() != 0.0 {
                    self.errors
                        .push(fault("E134", "must be a whole number".to_string()));
                    return None;
                }
                value as i128
            }
        };
        if (i128::from(low)..=i128::from(high)).contains(&value) {
            return Some(Datum::Integer(value as i64));
        }
        self.errors.push(if key.path == "study_format" {
            fault("E134", "this program reads format 2".to_string()).hint(match value {
                1 => "write study_format = 2; keys that have another name since are listed with it",
                3.. => "a newer opshock may read this file",
                _ => "write study_format = 2",
            })
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
}

fn number_range(kind: Kind) -> Option<Range> {
    match kind {
        Kind::Number(range)
        | Kind::NumberOrWord(range, _)
        | Kind::Axis(range)
        | Kind::Numbers(range)
        | Kind::Pair(range) => Some(range),
        Kind::Points => Some(key::ANY),
        _ => None,
    }
}
