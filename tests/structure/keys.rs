//! Code reads a study by the constants of its table: a key's path in quotes would compile with a typing error.

use crate::floors::{code, sources};
use opshock_study::study::keys::KEYS;
use std::path::Path;

#[test]
fn no_key_is_looked_up_by_a_string() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/opshock-study/src/study");
    let quoted: Vec<String> = KEYS
        .iter()
        .filter(|key| key.path.contains('.'))
        .map(|key| format!("\"{}\"", key.path))
        .collect();
    let mut found = Vec::new();
    let files = sources(&folder).into_iter();
    for file in files.filter(|file| !file.ends_with("study/fields.rs")) {
        let text = std::fs::read_to_string(&file).expect("a source");
        let code = code(&text);
        let program = code.split("#[cfg(test)]").next().unwrap_or(&code);
        let named = quoted.iter().filter(|path| program.contains(*path));
        found.extend(named.map(|path| format!("{}: {path}", file.display())));
    }
    assert!(
        found.is_empty(),
        "take the constant of study/fields.rs: {found:#?}"
    );
}
