//! Names and places a reader can trust: no file whose name says nothing, studies in one spelling.

use std::path::Path;

#[test]
fn no_file_is_named_for_nothing() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut folders = vec![
        root.join("crates"),
        root.join("tests"),
        root.join("scripts"),
    ];
    let mut wrong = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let stem = path
                .file_stem()
                .and_then(|s| s.to_str())
                .unwrap_or("")
                .to_string();
            if ["util", "utils", "helper", "helpers", "common", "misc"].contains(&stem.as_str()) {
                wrong.push(path.display().to_string());
            }
            if path.is_dir() {
                folders.push(path);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn studies_write_keys_with_single_spaces() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies");
    let mut wrong = Vec::new();
    for study in std::fs::read_dir(root).expect("studies/") {
        let folder = study.expect("an entry").path();
        if !folder.is_dir() {
            continue;
        }
        assert!(
            folder.join("README.md").exists(),
            "{} has no README.md",
            folder.display()
        );
        let text = std::fs::read_to_string(folder.join("study.toml")).expect("study.toml");
        for (k, line) in text.lines().enumerate() {
            let code = line.split('#').next().unwrap_or("");
            if let Some(at) = code.find('=') {
                let (key, value) = (&code[..at], &code[at + 1..]);
                let single = key.ends_with(' ')
                    && !key.ends_with("  ")
                    && value.starts_with(' ')
                    && !value.starts_with("  ");
                if !single {
                    wrong.push(format!("{}:{}: {line}", folder.display(), k + 1));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
