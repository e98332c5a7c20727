//! ARCHITECTURE.md names what exists and nothing else.

use std::path::Path;

#[test]
fn every_module_is_on_the_map_and_every_path_on_it_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let page = std::fs::read_to_string(root.join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    let mut wrong = Vec::new();
    for folder in [
        "crates/opshock/src",
        "crates/opshock-import/src",
        "crates/opshock-paper/src",
        "crates/opshock-python/src",
        "crates/opshock-solid/src",
        "crates/opshock-solver/src",
        "crates/opshock-study/src",
    ] {
        for entry in std::fs::read_dir(root.join(folder)).expect("a source folder") {
            let path = entry.expect("an entry").path();
            let stem = path
                .file_stem()
                .and_then(|s| s.to_str())
                .expect("a name")
                .to_string();
            if ["lib", "main"].contains(&stem.as_str()) {
                continue;
            }
            if !page.contains(&format!("`{stem}/`")) && !page.contains(&format!("`{stem}.rs`")) {
                wrong.push(format!("{folder}/{stem} is not on the map"));
            }
        }
    }
    for quoted in page.split('`').skip(1).step_by(2) {
        let looks_like_a_path = quoted.contains('/')
            && !quoted.contains(' ')
            && !quoted.contains('*')
            && [
                "crates/", "tests/", "studies/", "scripts/", "docs/", "results/",
            ]
            .iter()
            .any(|top| quoted.starts_with(top));
        if looks_like_a_path && !root.join(quoted).exists() {
            wrong.push(format!("{quoted} does not exist"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
