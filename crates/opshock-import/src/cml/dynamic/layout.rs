//! Splits `DynLULS.def` into sections: lines of asterisks open them, a line of names is followed by a line of values.
//!
//! A section is identified by its place in the order and, where its names are known, by them too.

use super::super::reader::Reader;
use super::super::run::is_numeric;
use crate::fault::{Fault, Faults};
use crate::text::{Line, Word};

/// Sections in their order, with their known names.
pub const SECTIONS: [(&str, &[&str]); 19] = [
    (
        "problem",
        &[
            "xl", "yl/xl", "xg", "yg", "zg", "f0", "xf0", "yf0", "halt", "rpm", "dt", "tf", "ra",
            "ra_if", "ra_of",
        ],
    ),
    ("suspension", &["iact", "xact", "dact", "vact", "skew"]),
    ("initial condition", &["hm", "hp", "hr", "dx", "dy", "yaw"]),
    ("solver", &["iqpo", "akmax", "emax", "idisc"]),
    ("grid", &[]),
    ("track profile", &[]),
    ("disk topography", &[]),
    ("slider topography", &[]),
    ("track access", &[]),
    ("disk speed", &[]),
    ("flutter", &[]),
    ("air", &[]),
    ("intermolecular forces", &[]),
    ("contact", &[]),
    ("load and unload", &[]),
    ("shock", &[]),
    ("matrices of the suspension", &[]),
    ("ramp profile", &[]),
    (
        "disk",
        &["e", "nu", "rho", "x_ramp", "ramp_ang", "ramp_clr"],
    ),
];

/// Places in [`SECTIONS`] of the sections that are read.
pub const PROBLEM: usize = 0;
/// Actuator and skew.
pub const ACTUATOR: usize = 1;
/// Attitude at the start.
pub const ATTITUDE: usize = 2;
/// Model of the flow.
pub const SOLVER: usize = 3;
/// Gas.
pub const AIR: usize = 11;
/// Pulse.
pub const SHOCK: usize = 15;
/// Matrices of the suspension.
pub const MATRICES: usize = 16;
/// Disk, and place of the ramp.
pub const DISK: usize = 18;

/// Lines of a section.
pub struct Section<'a> {
    /// Line of asterisks that opens it.
    pub line: usize,
    /// What stands between the asterisks, in lower case.
    pub title: String,
    lines: Vec<Line<'a>>,
}

/// A value with its name in lower case, without its unit.
#[derive(Clone)]
pub struct Value<'a> {
    /// Name.
    pub name: String,
    /// Word on the line of values.
    pub word: Word<'a>,
}

/// Sections of a file, of which there are to be `wanted`.
///
/// # Errors
/// E160 for a file without sections, E173 for another number of them.
pub fn split<'a>(reader: &mut Reader<'a>, wanted: usize) -> Result<Vec<Section<'a>>, Faults> {
    let mut sections: Vec<Section<'a>> = Vec::new();
    for line in reader.lines.by_ref() {
        if line.text.trim_start().starts_with("**") {
            // A frame of two lines of asterisks opens one section, one behind the last opens none.
            sections.pop_if(|section| section.lines.is_empty());
            sections.push(Section {
                line: line.number,
                title: line.text.trim().trim_matches('*').trim().to_lowercase(),
                lines: Vec::new(),
            });
        } else if let Some(section) = sections.last_mut() {
            section.lines.push(line);
        }
    }
    sections.pop_if(|section| section.lines.is_empty());
    if sections.is_empty() {
        return Err(reader.cut_short("its first section, a line of asterisks"));
    }
    let n = sections.len();
    if n == wanted {
        return Ok(sections);
    }
    let message = match n > wanted {
        true => "more sections than its layout has",
        false => "fewer sections than its layout has",
    };
    let titles: Vec<&str> = SECTIONS.iter().map(|(title, _)| *title).collect();
    let allowed = match wanted == SECTIONS.len() {
        true => format!("{wanted} below a header: {}", titles.join(", ")),
        false => format!("{wanted} of version 6.4, the first one without a header before it"),
    };
    let fault = Fault::of("E173", reader.file, message)
        .what("DynLULS.def")
        .value(format!("{n} sections"))
        .allowed(allowed);
    let fault = match sections.get(wanted) {
        Some(section) => fault.line(section.line),
        None => fault,
    };
    Err(fault.hint("a line of asterisks opens each").into())
}

/// Names of a line in lower case, without parts in brackets.
fn names(line: Line<'_>) -> Vec<String> {
    let mut depth = 0_usize;
    let outside = line.text.chars().filter(|c| {
        let before = depth;
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        before == 0 && depth == 0
    });
    let outside: String = outside.collect();
    outside.split_whitespace().map(str::to_lowercase).collect()
}

/// Values of a section in their order; those behind the last name of a line, and those on further lines, have a name too.
pub fn lists<'a>(section: &Section<'a>) -> Vec<Value<'a>> {
    let mut last: Vec<String> = Vec::new();
    let mut found = Vec::new();
    for line in &section.lines {
        if !line.words().next().is_some_and(|word| is_numeric(&word)) {
            last = names(*line);
            continue;
        }
        for (at, word) in line.words().enumerate() {
            let Some(name) = last.get(at).or(last.last()) else {
                break;
            };
            found.push(Value {
                name: name.clone(),
                word,
            });
        }
    }
    found
}

/// Values of a section in their order. Numbers without a line of names before them are lists and are skipped.
///
/// # Errors
/// E175 for names without values, and where the section lacks a name that it should have.
pub fn values<'a>(
    file: &str,
    sections: &[Section<'a>],
    at: usize,
) -> Result<Vec<Value<'a>>, Faults> {
    let (title, wanted) = SECTIONS[at];
    let section = &sections[at];
    let starts_with_number =
        |line: &Line<'_>| line.words().next().is_some_and(|word| is_numeric(&word));
    let mut found = Vec::new();
    let mut lines = section.lines.iter().peekable();
    while let Some(line) = lines.next() {
        if starts_with_number(line) {
            continue;
        }
        let names = names(*line);
        let Some(behind) = lines.next_if(|line| starts_with_number(line)) else {
            let fault = Fault::of("E175", file, "names without a line of values");
            return Err(fault
                .line(line.number)
                .what(title)
                .value(line.text.trim())
                .allowed("a line of values behind a line of names")
                .into());
        };
        let words: Vec<Word<'a>> = behind.words().collect();
        if words.len() < names.len() {
            let fault = Fault::of("E175", file, "fewer values than names");
            return Err(fault
                .line(behind.number)
                .what(title)
                .value(format!("{} values", words.len()))
                .allowed(format!("{}: {}", names.len(), line.text.trim()))
                .into());
        }
        let pairs = names.into_iter().zip(words);
        found.extend(pairs.map(|(name, word)| Value { name, word }));
    }
    let has = |name: &str| found.iter().any(|value| value.name == name);
    if wanted.iter().all(|name| has(name)) {
        return Ok(found);
    }
    let lacking: Vec<&str> = wanted.iter().copied().filter(|name| !has(name)).collect();
    let there: Vec<&str> = found.iter().map(|value| value.name.as_str()).collect();
    let message = format!("section {} should be its {title}", at + 1);
    let fault = Fault::of("E175", file, message)
        .line(section.line)
        .what(title)
        .value(there.join(" "))
        .allowed(wanted.join(" "));
    let elsewhere = sections.iter().position(|section| {
        let all: Vec<String> = section.lines.iter().flat_map(|line| names(*line)).collect();
        wanted
            .iter()
            .all(|name| all.iter().any(|found| found == name))
    });
    Err(fault
        .hint(match elsewhere {
            Some(other) => format!(
                "section {} has these names: are sections exchanged?",
                other + 1
            ),
            None => format!("it lacks {}", lacking.join(", ")),
        })
        .into())
}
