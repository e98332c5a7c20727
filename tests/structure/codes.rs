//! The list of errors and warnings names every code of the program, and no other.

use crate::floors::{code, sources};
use std::collections::BTreeSet;
use std::path::Path;

/// Codes in a text that stand between two characters that are not part of a word.
fn codes(text: &str) -> BTreeSet<String> {
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    let is_code = |word: &&str| {
        word.len() == 4
            && word.starts_with(['E', 'W', 'N'])
            && word[1..].bytes().all(|digit| digit.is_ascii_digit())
    };
    words.filter(is_code).map(str::to_owned).collect()
}

#[test]
fn every_code_is_on_the_page_of_errors() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let page = std::fs::read_to_string(root.join("docs/errors.md")).expect("docs/errors.md");
    let mut said = BTreeSet::new();
    for path in sources(&root.join("crates")) {
        let text = std::fs::read_to_string(&path).expect("readable");
        // In quotes: what is printed. Comments may name a code of another page.
        let text = code(&text).replace(r#"'"'"#, "").replace(r#"\""#, "");
        let printed = text.split('"').skip(1).step_by(2);
        said.extend(printed.flat_map(codes));
    }
    assert!(said.len() > 80, "{said:?}");
    let listed = codes(&page);
    let missing: Vec<_> = said.difference(&listed).collect();
    let gone: Vec<_> = listed.difference(&said).collect();
    assert!(
        missing.is_empty() && gone.is_empty(),
        "missing {missing:?}, gone {gone:?}"
    );
}
