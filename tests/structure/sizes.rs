//! A file holds one idea: none is longer than a reader takes in.

use crate::floors::sources;
use std::path::Path;

/// Most lines of a Rust file.
const MOST_LINES: usize = 500;

/// Longer files that are left, each to be split and then taken off the list.
const LONGER: &[&str] = &[
    "crates/opshock-solver/src/air_bearing/flux.rs",
    "crates/opshock-solver/src/head/stage.rs",
    "crates/opshock-solver/src/scene/plan.rs",
    "tests/products/study_reading.rs",
];

#[test]
fn no_file_is_long_but_those_listed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut wrong = Vec::new();
    let mut listed = LONGER.to_vec();
    for path in ["crates", "tests"]
        .map(|folder| sources(&root.join(folder)))
        .concat()
    {
        let name = path
            .strip_prefix(&root)
            .expect("inside")
            .display()
            .to_string();
        let n_lines = std::fs::read_to_string(&path)
            .expect("readable")
            .lines()
            .count();
        let is_listed = listed.contains(&name.as_str());
        listed.retain(|other| *other != name);
        if n_lines > MOST_LINES && !is_listed {
            wrong.push(format!(
                "{name} has {n_lines} lines, more than {MOST_LINES}"
            ));
        }
        if n_lines <= MOST_LINES && is_listed {
            wrong.push(format!("{name} has {n_lines} lines: take it off the list"));
        }
    }
    wrong.extend(
        listed
            .iter()
            .map(|name| format!("{name} is on the list and does not exist")),
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
