//! Writes the messages about values of the wrong kind or size.

use super::reader::Reader;
use crate::study::fault::StudyError;
use crate::study::fields;
use crate::study::film_memory::{film_bytes, reference_bytes};
use crate::study::key::{Key, Kind};
use crate::study::renamed;
use crate::study::suggest;
use crate::study::tree::{Node, Value};

impl Reader {
    pub(super) fn wrong_kind(&self, key: &'static Key, path: &str, node: &Node) -> StudyError {
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
        .allowed(key.kind.wanted());
        match (&node.value, key.kind) {
            (
                Value::Text(text),
                Kind::Number(_) | Kind::Integer(..) | Kind::Axis(_) | Kind::NumberOrWord(..),
            ) => {
                let text = match text.matches(',').count() {
                    // A decimal comma.
                    1 => &text.replace(',', "."),
                    _ => text,
                };
                let number: String = text
                    .trim()
                    .chars()
                    .take_while(|letter| letter.is_ascii_digit() || "+-.eE".contains(*letter))
                    .collect();
                if number.parse::<f64>().is_err() {
                    fault.hint(format!("for example {} = {}", key.name(), key.example()))
                } else if let Some((written, place)) = with_digits_beside_the_point(&number) {
                    fault.hint(format!(
                        "write {} = {written}: TOML needs a digit {place} the point",
                        key.name()
                    ))
                } else {
                    fault.hint(format!(
                        "write {} = {number}: without quotes, the unit is in the key's name",
                        key.name()
                    ))
                }
            }
            _ => fault.hint(format!("for example {} = {}", key.name(), key.example())),
        }
    }
}

/// A number that TOML does not take for one, as `.1` and `1.`, with the digit it lacks, and on
/// which side of the point that is; `None` when none is lacking.
fn with_digits_beside_the_point(number: &str) -> Option<(String, &'static str)> {
    let (whole, rest) = number.split_once('.')?;
    if !whole.ends_with(|letter: char| letter.is_ascii_digit()) {
        return Some((format!("{whole}0.{rest}"), "before"));
    }
    (!rest.starts_with(|letter: char| letter.is_ascii_digit()))
        .then(|| (format!("{whole}.0{rest}"), "after"))
}

pub(super) fn not_a_word(
    key: &Key,
    path: &str,
    node: &Node,
    text: &str,
    words: &[&str],
) -> StudyError {
    let code = if key.code == "E130" || matches!(key.kind, Kind::NumberOrWord(..)) {
        "E113"
    } else {
        key.code
    };
    let message = match code {
        "E157" => "no preset of this name".to_string(),
        "E158" => "unknown output".to_string(),
        _ => "not one of the words allowed here".to_string(),
    };
    let fault = StudyError::at(code, &node.place, path, message)
        .value(node.place.text())
        .allowed(key.kind.allowed());
    match (
        renamed::word_today(key.path, text),
        suggest::nearest(text, words),
    ) {
        (Some(today), _) => fault.hint(format!("write {today:?}, the word of format 2")),
        (None, Some(near)) => fault.hint(format!("did you mean {near:?}?")),
        (None, None) => fault,
    }
}

pub(super) fn memory_hint(path: &str, count: f64) -> String {
    let bytes = match path {
        _ if path == fields::RESOLUTION_FILM_CELLS.path() => film_bytes(count),
        _ if path == fields::RESOLUTION_FILM_CORRECTION_CELLS.path() => reference_bytes(count),
        _ => return "take a smaller number".to_string(),
    };
    format!(
        "it would take about {:.1} GB of memory in every worker",
        bytes / 1e9
    )
}
