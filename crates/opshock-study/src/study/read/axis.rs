//! Reads the values of an axis: a list, or `{ from, to, count, spacing }`.

use super::limit::{MAX_POINTS, too_many_points};
use super::reader::{Reader, join};
use crate::study::datum::Datum;
use crate::study::fault::StudyError;
use crate::study::key::{Key, Kind};
use crate::study::source::Place;
use crate::study::suggest;
use crate::study::tree::{Node, Value};

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

impl Reader {
    /// Values of `{ from, to, count, spacing }`.
    pub(super) fn spaced(
        &mut self,
        key: &'static Key,
        path: &str,
        node: &Node,
    ) -> Option<Vec<f64>> {
        let Value::Table(members) = &node.value else {
            return None;
        };
        const SHAPE: &str = "{ from = 0.25, to = 4.0, count = 9, spacing = \"log\" }";
        let mut good = true;
        for (name, member) in members {
            if !["from", "to", "count", "spacing"].contains(&name.as_str()) {
                self.errors.push(
                    StudyError::at("E110", &member.key_place, &join(path, name), "unknown key")
                        .value(member.place.text())
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

    /// The values of an axis: some, all different, not too many.
    pub(super) fn check_axis(
        &mut self,
        path: &str,
        node: &Node,
        values: &[Datum],
        places: &[Place],
    ) -> bool {
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
}
