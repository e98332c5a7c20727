//! Reads `--set section.key=VALUE` and `--unset section.key`: one setting from the command line.

use std::sync::Arc;

use super::source::Source;
use super::tree::{self, Node};

/// One `--set` or `--unset` argument, its syntax checked.
#[derive(Clone, Debug)]
pub struct SetArg {
    /// Dotted path of the key, list positions as `modes[0]`.
    pub key: String,
    /// Value as written; empty where the key is taken away.
    pub text: String,
    /// The whole argument, for messages.
    pub(super) source: Arc<Source>,
    /// Offset of the value in it.
    pub(super) value_at: usize,
}

/// An argument that is not `section.key=VALUE`, or not a key: a mistake on the command line, not in a
/// study.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
#[error("{option} {argument:?}: {reason}; write {option} {form}")]
pub struct SetSyntaxError {
    /// `--set` or `--unset`.
    pub option: &'static str,
    /// How it is written.
    pub form: &'static str,
    /// The argument.
    pub argument: String,
    /// What is wrong with it.
    pub reason: String,
}

/// Whether a key is another one, or a key of that section.
pub fn is_within(key: &str, whole: &str) -> bool {
    let rest = key.strip_prefix(whole);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

impl SetArg {
    /// Splits `section.key=VALUE` at its first `=`.
    ///
    /// # Errors
    /// When there is no `=`, no value, or the key is not a dotted name.
    pub fn parse(argument: &str) -> Result<Self, SetSyntaxError> {
        let fail = |reason: &str| SetSyntaxError {
            option: "--set",
            form: "section.key=VALUE, as in --set disk.rpm=7200",
            argument: argument.to_string(),
            reason: reason.to_string(),
        };
        let (key, value) = argument
            .split_once('=')
            .ok_or_else(|| fail("there is no ="))?;
        let key = key.trim();
        if key.is_empty() {
            return Err(fail("there is no key before ="));
        }
        if !key.split('.').all(is_name) {
            return Err(fail("the key is not a dotted name"));
        }
        let text = value.trim();
        if text.is_empty() {
            return Err(fail("there is no value after ="));
        }
        let value_at = argument.len() - value.trim_start().len();
        Ok(Self {
            key: key.to_string(),
            text: text.to_string(),
            source: Source::new("--set", argument),
            value_at,
        })
    }

    /// The key of `--unset KEY`: a key, a section or an entry of a list that the study is to lack.
    ///
    /// # Errors
    /// When it is not a dotted name.
    pub fn unset(argument: &str) -> Result<Self, SetSyntaxError> {
        let key = argument.trim();
        if !key.split('.').all(is_name) {
            return Err(SetSyntaxError {
                option: "--unset",
                form: "section.key, as in --unset ramp.contact_stiffness_n_per_m",
                argument: argument.to_string(),
                reason: "the key is not a dotted name".to_string(),
            });
        }
        Ok(Self {
            key: key.to_string(),
            text: String::new(),
            source: Source::new("--unset", argument),
            value_at: 0,
        })
    }

    /// Whether the key is taken away.
    pub fn is_unset(&self) -> bool {
        self.text.is_empty()
    }

    /// The value: TOML, and text when it is not.
    pub(super) fn node(&self, position: usize) -> Node {
        tree::value_or_text(&self.source, self.value_at, &self.text, position)
    }
}

impl std::str::FromStr for SetArg {
    type Err = SetSyntaxError;

    fn from_str(argument: &str) -> Result<Self, Self::Err> {
        Self::parse(argument)
    }
}

impl std::fmt::Display for SetArg {
    /// As on the command line.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.is_unset() {
            true => write!(f, "--unset {}", self.key),
            false => write!(f, "--set {}={}", self.key, self.text),
        }
    }
}

/// A bare TOML name, with an optional list position: `modes[0]`.
fn is_name(segment: &str) -> bool {
    let (name, position) = match segment.split_once('[') {
        None => (segment, None),
        Some((name, rest)) => (name, Some(rest)),
    };
    let plain = |text: &str| {
        !text.is_empty()
            && text
                .bytes()
                .all(|byte| byte.is_ascii_alphanumeric() || b"_-".contains(&byte))
    };
    plain(name)
        && position.is_none_or(|rest| {
            rest.strip_suffix(']').is_some_and(|digits| {
                (1..=6).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit())
            })
        })
}
