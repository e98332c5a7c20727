//! A file holds one idea: none is longer than a reader takes in.

use crate::floors::sources;
use std::path::Path;

/// Most lines of a Rust file.
const MOST_LINES: usize = 500;

#[test]
fn no_file_is_long() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let files = ["crates", "tests"].map(|folder| sources(&root.join(folder)));
    let mut wrong = Vec::new();
    for path in files.concat() {
        let text = std::fs::read_to_string(&path).expect("readable");
        let n_lines = text.lines().count();
        if n_lines > MOST_LINES {
            wrong.push(format!("{} has {n_lines} lines", path.display()));
        }
    }
    assert!(
        wrong.is_empty(),
        "more than {MOST_LINES}: {}",
        wrong.join("\n")
    );
}
