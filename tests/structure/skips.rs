//! No test passes by skipping: what needs a tool or a right of the machine is ignored with a reason that names the
//! target of the Makefile that runs it, and fails there without it.

use std::path::{Path, PathBuf};

/// Lines of every test of the workspace, with their places.
fn lines() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut folders = vec![root.join("tests"), root.join("crates")];
    let mut lines = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path: PathBuf = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs")
                && !path.ends_with("structure/skips.rs")
            {
                let text = std::fs::read_to_string(&path).expect("UTF-8");
                let places = (1..).map(|line| format!("{}:{line}", path.display()));
                lines.extend(places.zip(text.lines().map(String::from)));
            }
        }
    }
    lines
}

#[test]
fn no_test_asks_whether_it_can_run() {
    let signs = ["SKIPPED", "skipping", "OPSHOCK_NEED", "not installed\""];
    let wrong = lines()
        .into_iter()
        .filter(|(_, line)| signs.iter().any(|sign| line.contains(sign)));
    let wrong: Vec<String> = wrong
        .map(|(place, line)| format!("{place}: {line}"))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_test_that_needs_a_tool_names_a_target_that_runs_it() {
    let makefile = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Makefile");
    let makefile = std::fs::read_to_string(makefile).expect("Makefile");
    let all = makefile.lines().find(|line| line.starts_with("verify:"));
    let mut found = 0;
    for (place, line) in lines() {
        let Some(reason) = line
            .trim()
            .strip_prefix("#[ignore = \"")
            .filter(|reason| reason.contains("needs "))
        else {
            continue;
        };
        found += 1;
        let target = reason
            .split("make ")
            .nth(1)
            .unwrap_or_default()
            .trim_end_matches("\"]");
        assert!(
            makefile.contains(&format!("\n{target}: ")),
            "{place}: {line}: no such target"
        );
        assert!(
            all.is_some_and(|all| all.contains(target)),
            "{place}: {target} is no part of `make verify`"
        );
    }
    assert!(found >= 10, "{found}");
}
