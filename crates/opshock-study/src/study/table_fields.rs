//! Reads the fields of a table of a match or specification file by name and kind; every fault is noted with its place.

use super::fault::StudyError;
use super::suggest;
use super::tree::{Node, Value};

/// A table.
pub(crate) struct Fields<'a> {
    node: &'a Node,
    path: String,
}

/// Faults found so far.
pub(crate) type Faults = Vec<StudyError>;

impl<'a> Fields<'a> {
    /// A table with no other fields than `names`.
    pub(crate) fn of(
        node: &'a Node,
        path: &str,
        names: &[&str],
        faults: &mut Faults,
    ) -> Option<Self> {
        let Value::Table(members) = &node.value else {
            faults.push(wrong_kind(node, path, "a table"));
            return None;
        };
        for (name, member) in members {
            if names.contains(&name.as_str()) {
                continue;
            }
            let full = join(path, name);
            let fault = StudyError::at("E110", &member.key_place, &full, "unknown key")
                .allowed(names.join(", "));
            faults.push(match suggest::nearest(name, names) {
                Some(near) => fault.hint(format!("did you mean {near}?")),
                None => fault,
            });
        }
        Some(Self {
            node,
            path: path.to_owned(),
        })
    }

    /// Dotted path of a field.
    pub(crate) fn path(&self, name: &str) -> String {
        join(&self.path, name)
    }

    /// An optional field.
    pub(crate) fn get(&self, name: &str) -> Option<&'a Node> {
        self.node.get(name)
    }

    /// The present ones of some fields.
    pub(crate) fn present<'n>(&self, names: &[&'n str]) -> Vec<&'n str> {
        names
            .iter()
            .copied()
            .filter(|name| self.get(name).is_some())
            .collect()
    }

    /// A fault of the table as a whole.
    pub(crate) fn fault(&self, code: &'static str, message: impl Into<String>) -> StudyError {
        StudyError::at(code, &self.node.key_place, &self.path, message)
    }

    /// A fault of a field.
    pub(crate) fn fault_of(
        &self,
        code: &'static str,
        name: &str,
        message: impl Into<String>,
    ) -> StudyError {
        match self.get(name) {
            Some(node) => StudyError::at(code, &node.place, &self.path(name), message)
                .value(node.place.text()),
            None => self.fault(code, message),
        }
    }

    /// Notes that a field is missing.
    pub(crate) fn missing(&self, name: &str, allowed: &str, faults: &mut Faults) {
        let fault = StudyError::at("E112", &self.node.key_place, &self.path(name), "is missing");
        faults.push(fault.allowed(allowed));
    }

    /// Text.
    pub(crate) fn text(&self, name: &str, faults: &mut Faults) -> Option<String> {
        let node = self.get(name)?;
        match &node.value {
            Value::Text(text) => Some(text.clone()),
            _ => {
                faults.push(wrong_kind(node, &self.path(name), "text"));
                None
            }
        }
    }

    /// A finite number.
    pub(crate) fn number(&self, name: &str, faults: &mut Faults) -> Option<f64> {
        let node = self.get(name)?;
        number(node, &self.path(name), faults)
    }

    /// A finite number that is not negative.
    pub(crate) fn positive(&self, name: &str, faults: &mut Faults) -> Option<f64> {
        let value = self.number(name, faults)?;
        if value < 0.0 {
            faults.push(
                self.fault_of("E130", name, "is negative")
                    .allowed("0 or more"),
            );
            return None;
        }
        Some(value)
    }

    /// A whole number in a range.
    pub(crate) fn count(
        &self,
        name: &str,
        [least, most]: [u64; 2],
        faults: &mut Faults,
    ) -> Option<u64> {
        let node = self.get(name)?;
        let value = match &node.value {
            Value::Integer(text, 10) => text.replace('_', "").parse::<u64>().ok(),
            _ => None,
        };
        let inside = value.filter(|value| (least..=most).contains(value));
        if inside.is_none() {
            let fault = self.fault_of("E134", name, "is no whole number in its range");
            faults.push(fault.allowed(format!("a whole number from {least} to {most}")));
        }
        inside
    }

    /// true or false.
    pub(crate) fn flag(&self, name: &str, faults: &mut Faults) -> Option<bool> {
        let node = self.get(name)?;
        match node.value {
            Value::Flag(flag) => Some(flag),
            _ => {
                faults.push(wrong_kind(node, &self.path(name), "true or false"));
                None
            }
        }
    }

    /// Entries of a list, each with its path.
    pub(crate) fn list(&self, name: &str, faults: &mut Faults) -> Vec<(&'a Node, String)> {
        let Some(node) = self.get(name) else {
            return Vec::new();
        };
        let path = self.path(name);
        match &node.value {
            Value::List(entries) => {
                let named = entries.iter().enumerate();
                named
                    .map(|(place, entry)| (entry, format!("{path}[{place}]")))
                    .collect()
            }
            _ => {
                faults.push(wrong_kind(node, &path, "a list"));
                Vec::new()
            }
        }
    }

    /// A list of texts.
    pub(crate) fn texts(&self, name: &str, faults: &mut Faults) -> Vec<String> {
        let mut texts = Vec::new();
        for (node, path) in self.list(name, faults) {
            match &node.value {
                Value::Text(text) => texts.push(text.clone()),
                _ => faults.push(wrong_kind(node, &path, "text")),
            }
        }
        texts
    }

    /// Two numbers, the first not above the second; `inf` only where an end may be open.
    pub(crate) fn range(&self, name: &str, is_open: bool, faults: &mut Faults) -> Option<[f64; 2]> {
        self.get(name)?;
        let entries = self.list(name, faults);
        let ends: Vec<f64> = entries
            .iter()
            .filter_map(|(node, path)| match (infinite(node), is_open) {
                (Some(end), true) => Some(end),
                _ => number(node, path, faults),
            })
            .collect();
        match ends[..] {
            [low, high] if low <= high => Some([low, high]),
            _ => {
                if ends.len() == entries.len() {
                    let fault = self.fault_of("E133", name, "is no range");
                    faults.push(fault.allowed("[lowest, highest]"));
                }
                None
            }
        }
    }
}

fn join(path: &str, name: &str) -> String {
    match path {
        "" => name.to_owned(),
        path => format!("{path}.{name}"),
    }
}

fn infinite(node: &Node) -> Option<f64> {
    match &node.value {
        Value::Float(text) => text.parse().ok().filter(|end: &f64| end.is_infinite()),
        _ => None,
    }
}

fn number(node: &Node, path: &str, faults: &mut Faults) -> Option<f64> {
    let value = match &node.value {
        Value::Float(text) | Value::Integer(text, 10) => text.replace('_', "").parse::<f64>().ok(),
        _ => {
            faults.push(wrong_kind(node, path, "a number"));
            return None;
        }
    };
    let finite = value.filter(|value| value.is_finite());
    if finite.is_none() {
        let fault = StudyError::at("E120", &node.place, path, "is not a finite number");
        faults.push(fault.value(node.place.text()).allowed("a finite number"));
    }
    finite
}

pub(crate) fn wrong_kind(node: &Node, path: &str, wanted: &str) -> StudyError {
    let message = format!("is {}, not {wanted}", node.value.kind());
    StudyError::at("E113", &node.place, path, message)
        .value(node.place.text())
        .allowed(wanted)
}
