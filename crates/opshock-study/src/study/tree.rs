//! A TOML text as a tree of values that know their places, and the command line laid over it.

use std::sync::Arc;

use toml::de::{DeTable, DeValue};

use super::fault::StudyError;
use super::set_arg::SetArg;
use super::source::{self, Origin, Place, Source};

/// A value and its place.
#[derive(Clone, Debug)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Place of the value.
    pub place: Place,
    /// Place of the key in front of it; of the value itself inside a list.
    pub key_place: Place,
}

/// A TOML value. Numbers keep their text, so that overflow can be told from infinity.
#[derive(Clone, Debug)]
pub enum Value {
    /// Text.
    Text(String),
    /// Whole number: digits and radix.
    Integer(String, u32),
    /// Other number.
    Float(String),
    /// true or false.
    Flag(bool),
    /// Date or time.
    Date,
    /// List.
    List(Vec<Node>),
    /// Table, in file order.
    Table(Vec<(String, Node)>),
}

impl Value {
    /// Kind of value, for messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Text(_) => "text",
            Self::Integer(..) => "a whole number",
            Self::Float(_) => "a number",
            Self::Flag(_) => "true or false",
            Self::Date => "a date",
            Self::List(_) => "a list",
            Self::Table(_) => "a table",
        }
    }
}

impl Node {
    /// Member of a table.
    pub fn get(&self, name: &str) -> Option<&Node> {
        match &self.value {
            Value::Table(members) => members
                .iter()
                .find(|(member, _)| member == name)
                .map(|(_, node)| node),
            _ => None,
        }
    }
}

/// Parses a whole TOML text.
///
/// # Errors
/// E104 (limits) and every E103 (syntax), with their places.
pub fn parse(source: &Arc<Source>, origin: Origin) -> Result<Node, Vec<StudyError>> {
    source::check_limits(source, origin).map_err(|fault| vec![*fault])?;
    let (table, errors) = DeTable::parse_recoverable(&source.text);
    if errors.is_empty() {
        let span = table.span();
        return Ok(Node::from_table(
            source,
            origin,
            table.get_ref(),
            span.clone(),
            span,
        ));
    }
    let mut faults: Vec<StudyError> = Vec::new();
    for error in errors {
        let fault = syntax_fault(source, origin, &error);
        // One broken place often makes several messages; the first of a line is the cause.
        if faults.iter().all(|known| known.line != fault.line) {
            faults.push(fault);
        }
    }
    Err(faults)
}

fn syntax_fault(source: &Arc<Source>, origin: Origin, error: &toml::de::Error) -> StudyError {
    let mut span = error.span().unwrap_or(0..0);
    span.start = span.start.min(source.text.len());
    span.end = span.end.clamp(span.start, source.text.len());
    let place = Place {
        source: source.clone(),
        span: span.clone(),
        origin,
    };
    let (line, column) = source.line_column(span.start);
    let text = source.text.lines().nth(line - 1).unwrap_or("");
    let shown: String = text
        .chars()
        .take(120)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    let caret = " ".repeat(column.saturating_sub(1).min(120));
    StudyError::at(
        "E103",
        &place,
        "",
        format!(
            "TOML syntax: {}\n    {shown}\n    {caret}^",
            error.message().replace('\n', ", ")
        ),
    )
    .hint("see https://toml.io for the syntax")
}

/// A value from the command line: TOML, and text when it is not.
pub fn value_or_text(source: &Arc<Source>, at: usize, text: &str, position: usize) -> Node {
    let origin = Origin::Set(position);
    let whole = Place {
        source: source.clone(),
        span: at..at + text.len(),
        origin,
    };
    let key_place = Place {
        source: source.clone(),
        span: 0..at.saturating_sub(1),
        origin,
    };
    let shallow = source::check_limits(&Source::new("", text), origin).is_ok();
    let parsed = if shallow {
        DeValue::parse(text).ok()
    } else {
        None
    };
    match parsed {
        Some(value) => {
            let mut node = Node::from_value(source, origin, value.get_ref(), value.span(), 0..0);
            node.shift(at);
            node.key_place = key_place;
            node
        }
        None => Node {
            value: Value::Text(text.to_string()),
            place: whole,
            key_place,
        },
    }
}

/// A TOML literal of the table of keys.
///
/// # Panics
/// When the table of keys holds a literal that is not TOML; a test reads them all.
pub fn literal(text: &'static str) -> Node {
    let source = Source::new("default", text);
    let value = DeValue::parse(text).unwrap_or_else(|error| panic!("default {text:?}: {error}"));
    let span = value.span();
    Node::from_value(
        &source,
        Origin::Default,
        value.get_ref(),
        span.clone(),
        span,
    )
}

impl Node {
    fn from_table(
        source: &Arc<Source>,
        origin: Origin,
        table: &DeTable<'_>,
        span: std::ops::Range<usize>,
        key_span: std::ops::Range<usize>,
    ) -> Self {
        let place = |span| Place {
            source: source.clone(),
            span,
            origin,
        };
        let members = table
            .iter()
            .map(|(key, value)| {
                let node =
                    Self::from_value(source, origin, value.get_ref(), value.span(), key.span());
                (key.get_ref().to_string(), node)
            })
            .collect();
        Self {
            value: Value::Table(members),
            place: place(span),
            key_place: place(key_span),
        }
    }

    fn from_value(
        source: &Arc<Source>,
        origin: Origin,
        value: &DeValue<'_>,
        span: std::ops::Range<usize>,
        key_span: std::ops::Range<usize>,
    ) -> Self {
        let value = match value {
            DeValue::Table(table) => {
                return Self::from_table(source, origin, table, span, key_span);
            }
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Integer(number) => Value::Integer(number.as_str().to_string(), number.radix()),
            DeValue::Float(number) => Value::Float(number.as_str().to_string()),
            DeValue::Boolean(flag) => Value::Flag(*flag),
            DeValue::Datetime(_) => Value::Date,
            DeValue::Array(list) => Value::List(
                list.iter()
                    .map(|item| {
                        Self::from_value(source, origin, item.get_ref(), item.span(), item.span())
                    })
                    .collect(),
            ),
        };
        let place = |span| Place {
            source: source.clone(),
            span,
            origin,
        };
        Self {
            value,
            place: place(span),
            key_place: place(key_span),
        }
    }

    /// Moves every place by an offset: the value was parsed apart from its source.
    fn shift(&mut self, by: usize) {
        for place in [&mut self.place, &mut self.key_place] {
            place.span = place.span.start + by..place.span.end + by;
        }
        match &mut self.value {
            Value::List(items) => items.iter_mut().for_each(|item| item.shift(by)),
            Value::Table(members) => members.iter_mut().for_each(|(_, node)| node.shift(by)),
            _ => {}
        }
    }
}

/// A value of the file that the command line replaced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// Key.
    pub key: String,
    /// Value in the file, as written; empty when the file did not have the key.
    pub file_value: String,
    /// Value that counts, as written on the command line.
    pub set_value: String,
}

/// Lays the `--set` arguments over a file's tree; they win. Returns what they replaced.
///
/// # Errors
/// E114 when the same key (or a key and its table) is set twice differently, E113 when a key's
/// path leads through something that is no table or list.
pub fn lay_over(root: &mut Node, sets: &[SetArg], faults: &mut Vec<StudyError>) -> Vec<Override> {
    let mut overrides = Vec::new();
    for (position, set) in sets.iter().enumerate() {
        if let Some(earlier) = sets[..position]
            .iter()
            .find(|other| collide(&other.key, &set.key))
        {
            if earlier.key == set.key && earlier.text == set.text {
                continue;
            }
            let place = set.node(position).place;
            faults.push(
                StudyError::at(
                    "E114",
                    &place,
                    &set.key,
                    format!(
                        "set twice: --set {}={} and --set {}={}",
                        earlier.key, earlier.text, set.key, set.text
                    ),
                )
                .value(&set.text)
                .allowed("one value for a key")
                .hint("leave one of the two out"),
            );
            continue;
        }
        let node = set.node(position);
        match insert(root, &set.key, node) {
            Ok(replaced) => overrides.push(Override {
                key: set.key.clone(),
                file_value: replaced
                    .map(|old| old.place.text().to_string())
                    .unwrap_or_default(),
                set_value: set.text.clone(),
            }),
            Err(fault) => faults.push(*fault),
        }
    }
    overrides
}

/// Whether two paths name the same key, or one lies inside the other.
fn collide(a: &str, b: &str) -> bool {
    let inside = |outer: &str, inner: &str| {
        inner
            .strip_prefix(outer)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    };
    inside(a, b) || inside(b, a)
}

/// Puts a node at a dotted path, making tables on the way; returns what stood there.
fn insert(root: &mut Node, path: &str, node: Node) -> Result<Option<Node>, Box<StudyError>> {
    let place = node.key_place.clone();
    let blocked = |message: String| {
        Box::new(
            StudyError::at("E113", &place, path, message)
                .hint("set the whole value instead, as one TOML value"),
        )
    };
    let mut here = root;
    let mut steps = path
        .split('.')
        .flat_map(|segment| {
            let (name, position) = match segment.split_once('[') {
                None => (segment, None),
                Some((name, rest)) => (
                    name,
                    rest.strip_suffix(']')
                        .and_then(|digits| digits.parse().ok()),
                ),
            };
            std::iter::once(Step::Name(name)).chain(position.map(Step::Position))
        })
        .peekable();
    while let Some(step) = steps.next() {
        let last = steps.peek().is_none();
        let kind = here.value.kind();
        here = match (step, &mut here.value) {
            (Step::Name(name), Value::Table(members)) => {
                let at = match members.iter().position(|(member, _)| member == name) {
                    Some(at) => at,
                    None => {
                        if matches!(steps.peek(), Some(Step::Position(_))) {
                            return Err(blocked(format!(
                                "there is no list {name} to take an entry of"
                            )));
                        }
                        let value = Value::Table(Vec::new());
                        let fresh = Node {
                            value,
                            place: place.clone(),
                            key_place: place.clone(),
                        };
                        if last {
                            members.push((name.to_string(), node));
                            return Ok(None);
                        }
                        members.push((name.to_string(), fresh));
                        members.len() - 1
                    }
                };
                &mut members[at].1
            }
            (Step::Position(position), Value::List(items)) => {
                let count = items.len();
                items.get_mut(position).ok_or_else(|| {
                    blocked(format!(
                        "entry {position} does not exist; the list has {count}, counted from 0"
                    ))
                })?
            }
            (Step::Name(name), _) => {
                return Err(blocked(format!("cannot hold a key {name}: found {kind}")));
            }
            (Step::Position(_), _) => {
                return Err(blocked(format!("cannot take an entry: found {kind}")));
            }
        };
        if last {
            return Ok(Some(std::mem::replace(here, node)));
        }
    }
    Ok(None)
}

enum Step<'a> {
    Name(&'a str),
    Position(usize),
}
