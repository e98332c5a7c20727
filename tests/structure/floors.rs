//! Which module may import which: a module uses modules of lower layers and itself.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Module of the solver, its layer.
const SOLVER: &[(&str, u8)] = &[
    ("quantity", 0),
    ("elementary", 0),
    ("lanes", 0),
    ("gas", 0),
    ("linalg", 0),
    ("grid", 0),
    ("mutant", 0),
    ("modal", 1),
    ("complementarity", 1),
    ("integrator", 1),
    ("fixed_point", 1),
    ("rough_contact", 1),
    ("shock", 2),
    ("disk", 2),
    ("ramp", 2),
    ("suspension", 2),
    ("slider", 2),
    ("air_bearing", 2),
    ("structure", 3),
    ("head", 3),
    ("scene", 4),
    ("simulation", 5),
];

/// Imports that cross one layer on purpose, with the reason.
const SOLVER_EXCEPTIONS: &[(&str, &str, &str)] = &[
    (
        "complementarity",
        "modal",
        "the reference method also steps modes of first order, which are plain numbers",
    ),
    (
        "air_bearing",
        "slider",
        "the film is cut to the slider's surface, which is geometry and no physics",
    ),
    (
        "linalg",
        "lanes",
        "factors are solved in vector registers, and lanes import nothing",
    ),
];

/// Module of the crate of importers, its layer.
const IMPORT: &[(&str, u8)] = &[
    ("fault", 0),
    ("text", 1),
    ("matrix", 2),
    ("gmsh", 2),
    ("cml", 3),
];

/// Module of the crate of solid elements, its layer.
const SOLID: &[(&str, u8)] = &[
    ("material", 0),
    ("sparse", 0),
    ("element", 1),
    ("mesh", 2),
    ("assembly", 3),
    ("modes", 4),
    ("reduction", 5),
    ("ramp", 6),
];

/// Module of the study crate, its layer.
const STUDY: &[(&str, u8)] = &[
    ("identity", 0),
    ("provenance", 0),
    ("record", 0),
    ("search", 0),
    ("study", 1),
    ("draws", 2),
    ("store", 2),
    ("sweep", 3),
    ("accuracy", 3),
    ("matching", 4),
    ("correction_cache", 3),
    ("batch", 4),
    ("hard_cases", 4),
    ("qualification", 4),
    ("population", 5),
    ("worth", 6),
    ("report", 7),
];

/// Module of the paper's crate, its layer.
const PAPER: &[(&str, u8)] = &[("claims", 0), ("figures", 0)];

pub fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(&next).expect("a source folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// A text without its comments.
pub fn code(text: &str) -> String {
    let lines = text.lines();
    let lines = lines.filter(|line| !line.trim_start().starts_with("//"));
    lines.collect::<Vec<_>>().join("\n")
}

/// Names after every `crate::` in code, with comments left out; `crate::{a, b::c}` gives a and b.
fn imported(text: &str) -> Vec<String> {
    let code = code(text);
    let mut names = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        if let Some(group) = rest.strip_prefix('{') {
            let mut depth = 0;
            let mut word = String::new();
            for c in group.chars() {
                match c {
                    '{' => depth += 1,
                    '}' if depth == 0 => break,
                    '}' => depth -= 1,
                    ',' if depth == 0 => names.push(std::mem::take(&mut word)),
                    _ if depth == 0 => word.push(c),
                    _ => {}
                }
            }
            names.push(word);
        } else {
            names.push(rest.to_string());
        }
    }
    names
        .iter()
        .map(|name| {
            name.trim()
                .chars()
                .take_while(|c| c.is_alphanumeric() || *c == '_')
                .collect::<String>()
        })
        .filter(|name| !name.is_empty())
        .collect()
}

fn check(crate_folder: &str, floors: &[(&str, u8)], exceptions: &[(&str, &str, &str)]) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../crates")
        .join(crate_folder)
        .join("src");
    let floor: BTreeMap<&str, u8> = floors.iter().copied().collect();
    let mut wrong = Vec::new();
    let mut seen = std::collections::BTreeSet::new();
    for path in sources(&root) {
        let inside = path.strip_prefix(&root).expect("inside src");
        let first = inside.components().next().expect("a name");
        let module = Path::new(first.as_os_str())
            .file_stem()
            .and_then(|s| s.to_str())
            .expect("a module name")
            .to_string();
        if module == "lib" || module == "main" {
            continue;
        }
        let Some(&own) = floor.get(module.as_str()) else {
            wrong.push(format!("{module} has no floor"));
            continue;
        };
        seen.insert(module.clone());
        let text = std::fs::read_to_string(&path).expect("readable source");
        for name in imported(&text) {
            // Names that are no module (macros, re-exports at the root) have no layer.
            let Some(&other) = floor.get(name.as_str()) else {
                continue;
            };
            let allowed = name == module
                || other < own
                || exceptions
                    .iter()
                    .any(|(from, to, _)| *from == module && *to == name);
            if !allowed {
                wrong.push(format!(
                    "{}: {module} (floor {own}) imports {name} (floor {other})",
                    inside.display()
                ));
            }
        }
    }
    for (name, _) in floors {
        if !seen.contains(*name) {
            wrong.push(format!(
                "{name} is in the table of floors but not in the crate"
            ));
        }
    }
    assert!(wrong.is_empty(), "{crate_folder}:\n{}", wrong.join("\n"));
}

#[test]
fn solver_modules_import_lower_floors_only() {
    check("opshock-solver", SOLVER, SOLVER_EXCEPTIONS);
}

#[test]
fn import_modules_import_lower_floors_only() {
    check("opshock-import", IMPORT, &[]);
}

#[test]
fn solid_modules_import_lower_floors_only() {
    check("opshock-solid", SOLID, &[]);
}

#[test]
fn study_modules_import_lower_floors_only() {
    check("opshock-study", STUDY, &[]);
}

#[test]
fn paper_modules_import_lower_floors_only() {
    check("opshock-paper", PAPER, &[]);
}

#[test]
fn reader_of_imports_sees_groups_and_skips_comments() {
    let text = "use crate::{disk::DiskPose, ramp};\n// crate::head is only named\nfn f() { crate::gas::x() }";
    assert_eq!(imported(text), ["disk", "ramp", "gas"]);
}

/// Only one place may name each heavy library, so that it can be replaced.
#[test]
fn libraries_stay_in_their_place() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let mut wrong = Vec::new();
    for path in sources(&crates) {
        let name = path
            .strip_prefix(&crates)
            .expect("inside")
            .display()
            .to_string();
        let text = std::fs::read_to_string(&path).expect("readable");
        let code = |word: &str| {
            text.lines()
                .any(|line| !line.trim_start().starts_with("//") && line.contains(word))
        };
        if code("faer::") && !name.contains("/linalg/") && name != "opshock-solid/src/sparse.rs" {
            wrong.push(format!("{name} names faer"));
        }
        if name.starts_with("opshock-solver/src") || name.starts_with("opshock-solid/src") {
            for word in [
                "std::fs",
                "std::time",
                "std::env",
                "std::thread",
                "println!",
                "eprintln!",
            ] {
                if code(word) && !name.ends_with("tests.rs") {
                    wrong.push(format!("{name} uses {word}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Files get their names in one place, where every error is reported; the journal's system calls and
/// the lock are the others that write, and HDF5 files are made in memory.
#[test]
fn files_are_written_in_one_place() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let writers = ["files.rs", "lock.rs", "hdf5_file.rs"];
    let writers = writers.map(|name| crates.join("opshock-study/src/store").join(name));
    let mut wrong = Vec::new();
    for path in sources(&crates) {
        let text = std::fs::read_to_string(&path).expect("readable");
        // Tests stand at the end, or in files of their own.
        let code = text
            .split("#[cfg(test)]\nmod tests {")
            .next()
            .unwrap_or_default();
        let is_test =
            path.ends_with("tests.rs") || path.components().any(|part| part.as_os_str() == "tests");
        if is_test || writers.contains(&path) {
            continue;
        }
        for word in [
            "fs::write",
            "fs::copy",
            "fs::rename",
            "File::create",
            "File::options",
            "OpenOptions",
            "FileBuilder",
        ] {
            if code.contains(word) {
                wrong.push(format!("{} uses {word}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
