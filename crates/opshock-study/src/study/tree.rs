//! Parses a TOML text into a tree of values with their places in the text.

use std::path::Path;
use std::sync::Arc;

use toml::de::{DeTable, DeValue};

use super::fault::{StudyError, StudyErrors};
use super::source::{Origin, Place, Source};
use super::text_file;

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

/// A TOML value. Numbers keep their text, so that overflow can be distinguished from infinity.
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

/// Reads a TOML file: its text, and its tree.
///
/// # Errors
/// As [`text_file::read_text`] and [`parse`].
pub(crate) fn read(path: &Path) -> Result<(String, Node), StudyErrors> {
    let text = text_file::read_text(path).map_err(|fault| StudyErrors::from(*fault))?;
    let source = Source::new(path.display().to_string(), text.clone());
    let root = parse(&source, Origin::File).map_err(StudyErrors::new)?;
    Ok((text, root))
}

/// Parses a whole TOML text.
///
/// # Errors
/// E104 (limits) and every E103 (syntax), with their places.
pub fn parse(source: &Arc<Source>, origin: Origin) -> Result<Node, Vec<StudyError>> {
    text_file::check_limits(source, origin).map_err(|fault| vec![*fault])?;
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
    .hint(syntax_hint(source, text, line))
}

/// The likely cause of a syntax error on a line.
fn syntax_hint(source: &Source, text: &str, line: usize) -> String {
    let value = text
        .split_once('=')
        .map_or("", |(_, value)| value.trim_start());
    let comma = value.split_once(',').is_some_and(|(whole, rest)| {
        let digits = |part: &str| {
            part.bytes()
                .next()
                .is_some_and(|byte| byte.is_ascii_digit())
        };
        digits(whole) && digits(rest) && whole.bytes().all(|byte| byte.is_ascii_digit())
    });
    if comma {
        return "numbers have a decimal point, whatever the locale".to_string();
    }
    if value.is_empty() && text.trim_end().ends_with('=') {
        return "a value is missing after =".to_string();
    }
    match text_file::unclosed_bracket(&source.text).map(|at| source.line_column(at).0) {
        Some(opened) if opened <= line => {
            format!("a bracket opened in line {opened} is not closed")
        }
        _ => "see https://toml.io for the syntax".to_string(),
    }
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
    let shallow = text_file::check_limits(&Source::new("", text), origin).is_ok();
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
