//! Lays the settings of the command line over a study file: they win, and the values they replace are recorded.

use super::fault::StudyError;
use super::keys;
use super::set_arg::SetArg;
use super::tree::{Node, Value};

/// A value of the file that the command line replaced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// Key.
    pub key: String,
    /// Value in the file, as written; empty when the file did not have the key.
    pub file_value: String,
    /// Value that replaces it, as written on the command line; empty when the key was taken away.
    pub set_value: String,
}

/// Lays the `--set` and `--unset` arguments over a file's tree; they win. Returns what they replaced.
///
/// # Errors
/// E114 when the same key (or a key and its table) is set twice differently, E113 when a key's
/// path leads through something that is no table or list.
pub fn lay_over(root: &mut Node, sets: &[SetArg], faults: &mut Vec<StudyError>) -> Vec<Override> {
    let mut overrides = Vec::new();
    for (position, set) in sets.iter().enumerate() {
        if let Some(earlier) = sets[..position]
            .iter()
            .find(|other| collide(&other.key, &set.key) || moves(other, set))
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
                    format!("set twice: {earlier} and {set}"),
                )
                .value(&set.text)
                .allowed("one value for a key")
                .hint("leave one of the two out"),
            );
            continue;
        }
        // A key that there is not is put in, to be reported like any other.
        let is_known =
            || keys::find(&set.key).is_some() || keys::is_table(&keys::pattern(&set.key));
        if set.is_unset() && is_known() {
            match remove(root, &set.key) {
                Ok(old) => overrides.extend(old.map(|old| Override {
                    key: set.key.clone(),
                    file_value: old.place.text().to_string(),
                    set_value: String::new(),
                })),
                Err(message) => {
                    let place = set.node(position).place;
                    faults.push(StudyError::at("E113", &place, &set.key, message));
                }
            }
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

/// Puts lists under `--set list[0].member=...` arguments that the file itself does not hold:
/// the default of the key, or what `base` knows (a preset, an included file).
pub fn seed_lists(root: &mut Node, sets: &[SetArg], base: impl Fn(&Node, &str) -> Option<Node>) {
    for set in sets {
        let Some((list, _)) = set.key.split_once('[') else {
            continue;
        };
        let known = list
            .split('.')
            .try_fold(&*root, |here, name| here.get(name))
            .is_some();
        // A list the command line gives as a whole is its own.
        if known || sets.iter().any(|other| other.key == list) {
            continue;
        }
        if let Some(node) = base(root, list) {
            // The way there may be blocked by a value; the argument itself then reports it.
            let _ = insert(root, list, node);
        }
    }
}

/// Whether an entry that is taken away moves the one that another argument takes away.
fn moves(a: &SetArg, b: &SetArg) -> bool {
    let list = |set: &SetArg| {
        let (list, last) = set.key.rsplit_once('[')?;
        (set.is_unset() && last.ends_with(']')).then(|| list.to_owned())
    };
    list(a).is_some_and(|of_a| Some(of_a) == list(b))
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

/// Takes away what stands at a dotted path, if anything does.
///
/// # Errors
/// What is wrong with a position that a list does not have.
fn remove(root: &mut Node, path: &str) -> Result<Option<Node>, String> {
    let steps: Vec<Step<'_>> = steps(path).collect();
    let mut here = root;
    for (k, step) in steps.iter().enumerate() {
        let last = k + 1 == steps.len();
        here = match (step, &mut here.value) {
            (Step::Name(name), Value::Table(members)) => {
                let Some(at) = members.iter().position(|(member, _)| member == name) else {
                    return Ok(None);
                };
                if last {
                    return Ok(Some(members.remove(at).1));
                }
                &mut members[at].1
            }
            (Step::Position(position), Value::List(items)) => {
                if *position >= items.len() {
                    return Err(no_entry(*position, items.len()));
                }
                if last {
                    return Ok(Some(items.remove(*position)));
                }
                &mut items[*position]
            }
            _ => return Ok(None),
        };
    }
    Ok(None)
}

fn no_entry(position: usize, count: usize) -> String {
    format!("entry {position} does not exist; the list has {count}, counted from 0")
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
    let mut steps = steps(path).peekable();
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
                items
                    .get_mut(position)
                    .ok_or_else(|| blocked(no_entry(position, count)))?
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

/// The steps of a dotted path.
fn steps(path: &str) -> impl Iterator<Item = Step<'_>> {
    path.split('.').flat_map(|segment| {
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
}

enum Step<'a> {
    Name(&'a str),
    Position(usize),
}
