//! The key reference: what each key means, in the words of the table of keys.

use super::fields;
use super::key::{Key, Presence};
use super::keys::{self, KEYS};
use super::suggest;
use super::unit;
use std::fmt::Write as _;

/// What the keys of a section act on, by the beginning of their names; the longest that fits counts.
const ACTS: [(&str, &str); 30] = [
    (
        "asperity_contact",
        "the contact of slider and disk, and the height that the film sees",
    ),
    ("base", "the motion of spindle, ramp mount and pivot"),
    ("disk", "the disk's bending, and the wind under the slider"),
    ("disk.damping", "the decay of the disk's vibration"),
    (
        "disk.run_out",
        "the height of the disk under slider and ramp",
    ),
    (
        fields::DISK_WAVES.path(),
        "the height of the disk under the slider",
    ),
    ("failure", "what of slider and disk is called failure"),
    ("fields", "which pressure fields are kept"),
    ("gas", "the air bearing"),
    ("head", "which head is simulated"),
    ("heads", "several heads, an axis of the study"),
    ("hub", "the tilt of the disk on its bearing"),
    ("name", "the products' headings"),
    ("output", "what is written beside the answers"),
    (
        "outputs",
        "which effects are simulated, and what is answered",
    ),
    ("pulse", "the acceleration of base, disk and suspension"),
    ("ramp", "the contact of disk and ramp"),
    ("ramp.deformable", "the motion of the ramp's arms"),
    (
        "resolution",
        "the discretisation: its error and its cost, not the drive",
    ),
    ("search", "how the critical shock is found, not the drive"),
    ("slider", "place, size and inertia of the slider"),
    (
        "slider.surface",
        "the air bearing: flight, stiffness, damping",
    ),
    (
        fields::SLIDER_VISCOUS_SHEAR.path(),
        "force and moments on the slider along the film",
    ),
    ("solver", "how the equations are solved, not the drive"),
    ("study_format", "how this file is read"),
    (
        "surface_forces",
        "the forces between slider and disk beside the air's",
    ),
    ("suspension", "the load beam between base and slider"),
    ("suspension.dimple", "the contact of slider and load beam"),
    (
        "suspension.gimbal",
        "the springs between slider and load beam",
    ),
    ("suspension.limiters", "how far the dimple can open"),
];

/// What is known of a key, in a few lines; with a name that is no key, an error that says which there are.
///
/// # Errors
///
/// The name, and keys with similar names.
pub fn of(name: &str) -> Result<String, String> {
    let pattern = keys::pattern(name);
    if let Some(key) = keys::find(&pattern) {
        return Ok(described(key));
    }
    let below: Vec<&Key> = KEYS
        .iter()
        .filter(|key| {
            key.path
                .strip_prefix(&pattern)
                .is_some_and(|rest| rest.starts_with(['.', '[']))
        })
        .collect();
    if !below.is_empty() {
        return Ok(below.iter().fold(String::new(), |mut text, key| {
            let _ = writeln!(text, "{:<50} {}", key.path, key.help);
            text
        }));
    }
    let paths: Vec<&str> = of_the_study().map(|key| key.path).collect();
    let last = pattern.rsplit('.').next().unwrap_or_default();
    let alike = paths
        .iter()
        .filter(|path| path.rsplit('.').next() == Some(last));
    let mut alike: Vec<&str> = alike
        .chain(suggest::nearest(&pattern, &paths).iter())
        .copied()
        .collect();
    alike.dedup();
    Err(match alike.is_empty() {
        true => format!(
            "there is no key {name}; sections are {}",
            keys::sections().join(", ")
        ),
        false => format!("there is no key {name}; did you mean {}?", alike.join(", ")),
    })
}

/// Lines of a key: meaning, unit, kind and range, usual range, default, example, place.
fn described(key: &Key) -> String {
    let mut text = format!("{}\n", key.path);
    let mut line = |what: &str, value: String| {
        let _ = writeln!(text, "  {what:<10}{value}");
    };
    line("meaning", key.help.to_owned());
    for (what, value) in facts(key) {
        line(what, value);
    }
    text
}

/// All but path and meaning.
fn facts(key: &Key) -> Vec<(&'static str, String)> {
    let mut facts = Vec::new();
    let mut fact = |what: &'static str, value: String| facts.push((what, value));
    if let Some(unit) = unit::of_path(key.path) {
        fact(
            "unit",
            format!("{} ({})", unit.symbol, unit.dimension.name()),
        );
    }
    fact("value", key.kind.wanted());
    if let Some((low, high)) = key.usual {
        fact("usually", format!("{low} to {high}; else a warning (W201)"));
    }
    match key.presence {
        Presence::Required => fact("default", "none: it must be given".to_owned()),
        Presence::Default(value) | Presence::Together(value) => fact("default", value.to_owned()),
        Presence::Optional(absent) => fact("default", format!("absent: {absent}")),
        Presence::ByPreset => fact("default", "by resolution.preset".to_owned()),
    }
    fact("example", format!("{} = {}", key.name(), key.example()));
    if key.may_be_axis() {
        fact(
            "axis",
            "a list of values is an axis of the study".to_owned(),
        );
    }
    let fits = |start: &str| {
        let rest = key.path.strip_prefix(start);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[', '_']))
    };
    let acts = ACTS.iter().filter(|(start, _)| fits(start));
    if let Some((_, what)) = acts.max_by_key(|(start, _)| start.len()) {
        fact("acts on", (*what).to_owned());
    }
    facts
}

/// Keys of a study; a head's own are the study's.
fn of_the_study() -> impl Iterator<Item = &'static Key> {
    let is_own =
        |key: &&Key| !key.path.starts_with("heads[]") || key.path == fields::HEADS_HEAD.path();
    KEYS.iter().filter(is_own)
}

/// The reference of all keys, Markdown; those of a head are the study's and are left out.
pub fn markdown() -> String {
    let mut text = "# Keys of a study\n\nWritten by `opshock schema --markdown`. The same for one key: `opshock schema KEY`.\n".to_owned();
    let mut section = "";
    for key in of_the_study() {
        let own = key.path.split(['.', '[']).next().unwrap_or_default();
        if own != section {
            section = own;
            let _ = write!(text, "\n## {section}\n");
        }
        let _ = write!(text, "\n**`{}`**: {}\n", key.path, key.help);
        let facts = facts(key).into_iter();
        let facts: Vec<String> = facts
            .map(|(what, value)| format!("{what} {value}"))
            .collect();
        let facts = facts.join("; ").replace('<', "\\<").replace('*', "\\*");
        let _ = writeln!(text, "{facts}.");
    }
    text
}
