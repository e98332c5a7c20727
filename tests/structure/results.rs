//! Committed results are of today's physics, today's studies and one another.

use opshock_study::provenance::{PHYSICS_HEAD, PHYSICS_STRUCTURE};
use opshock_study::study::Study;
use std::path::{Path, PathBuf};

/// Folders that take hours: they may be of older physics when their first line says so.
const MAY_BE_OLDER: [&str; 3] = ["accuracy", "bench", "match-paper"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Committed files below `results/`, by their path there; stores, pages and histories are ignored by git.
fn committed() -> Vec<(String, PathBuf)> {
    let results = root().join("results");
    let mut found = Vec::new();
    let mut folders = vec![results.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.strip_prefix(&results).expect("below").display();
            let name = name.to_string();
            match path.extension().and_then(|ending| ending.to_str()) {
                Some("opshock") => {}
                _ if path.is_dir() => folders.push(path),
                Some("md" | "json" | "csv" | "txt" | "svg" | "png") => found.push((name, path)),
                _ => {}
            }
        }
    }
    found.sort();
    found
}

/// Every `physics STRUCTURE/HEAD` of a text.
fn physics(text: &str) -> Vec<[u32; 2]> {
    let number = |text: &str| {
        let end = text.find(|c: char| !c.is_ascii_digit());
        text[..end.unwrap_or(text.len())].parse::<u32>().ok()
    };
    let reported = text.match_indices("physics ").filter_map(|(at, word)| {
        let (structure, head) = text[at + word.len()..].split_once('/')?;
        let all_digits = structure.bytes().all(|byte| byte.is_ascii_digit());
        Some([number(structure).filter(|_| all_digits)?, number(head)?])
    });
    reported.collect()
}

/// What is wrong with one committed file of results, by its path and text.
fn fault(name: &str, text: &str) -> Option<String> {
    let today = [PHYSICS_STRUCTURE, PHYSICS_HEAD];
    let reported = physics(text);
    let must_tell = name.ends_with(".md") || name.ends_with(".json") || name.ends_with(".txt");
    let is_today = reported.iter().all(|&one| one == today) && !(must_tell && reported.is_empty());
    let folder = name.split('/').next().unwrap_or_default();
    let first = text.lines().next().unwrap_or_default();
    // JSON has no first line; the Markdown beside it speaks for it.
    let is_known_older = MAY_BE_OLDER.contains(&folder)
        && (!physics(first).is_empty() || !(name.ends_with(".md") || name.ends_with(".txt")));
    (!is_today && !is_known_older).then(|| {
        format!(
            "results/{name}: physics {reported:?}, today's is {today:?}; `make results` makes it anew"
        )
    })
}

#[test]
fn an_older_result_is_found_and_an_older_measurement_says_so_first() {
    let line = |structure| {
        format!(
            "# Table\n\nopshock 0.1.0 (30625cb7dff8, physics {structure}/{PHYSICS_HEAD}), study 364c\n"
        )
    };
    let (today, older) = (line(PHYSICS_STRUCTURE), line(PHYSICS_STRUCTURE - 1));
    assert_eq!(physics(&older), [[PHYSICS_STRUCTURE - 1, PHYSICS_HEAD]]);
    assert_eq!(fault("fig13/table.md", &today), None);
    assert!(fault("fig13/table.md", &older).is_some());
    assert!(fault("fig13/table.md", &format!("{today}{older}")).is_some());
    assert!(fault("fig13/table.md", "opshock 0.1.0 (30625cb7dff8)").is_some());
    assert!(fault("accuracy/presets.md", &older).is_some());
    assert_eq!(
        fault(
            "accuracy/presets.md",
            &format!("Measured at 30625cb, physics 6/11.\n{older}")
        ),
        None
    );
}

#[test]
fn results_are_of_todays_physics() {
    let mut faults = Vec::new();
    let files = committed();
    for (name, path) in &files {
        if name.ends_with(".png") {
            continue;
        }
        let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{name}: {error}"));
        faults.extend(fault(name, &text));
    }
    // Every table and picture has a Markdown file written with it.
    for (name, path) in &files {
        let speaks = |other: &str| path.with_file_name(other).is_file();
        let stem = path
            .file_stem()
            .and_then(|stem| stem.to_str())
            .unwrap_or_default();
        let stem = stem.split('-').next().unwrap_or_default();
        let of_figures = (stem.starts_with("fig") && speaks("figures.md"))
            || (stem == "critical_shock" && speaks("table.md"))
            || (stem == "damage_boundary" && speaks("qualification.md"));
        let of_match = ["observations", "parameters", "samples", "ranges", "choices"]
            .contains(&stem)
            && speaks("match.md");
        let tells = name.ends_with(".txt")
            || name.starts_with("uncertainty/")
            || ["times.csv", "accuracy/coverage.csv"].contains(&name.as_str());
        if !(tells || of_figures || of_match || speaks(&format!("{stem}.md"))) {
            faults.push(format!(
                "results/{name}: no Markdown file says its program and physics"
            ));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn results_are_of_todays_studies_and_of_the_committed_table() {
    let read = |name: &str| {
        std::fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    let digest = |name: &str| {
        let path = root().join("studies").join(name).join("study.toml");
        let study = Study::from_path(&path, &[]).unwrap_or_else(|errors| panic!("{errors}"));
        study.digest_hex()
    };
    let table = blake3::hash(read("results/fig13/table.csv").as_bytes()).to_hex();
    let table = format!("results/fig13/table.csv (blake3 {})", &table[..16]);
    let mut faults = Vec::new();
    let mut holds = |name: &str, wanted: &str| {
        if !read(name).contains(wanted) {
            faults.push(format!(
                "{name}: not made with {wanted}; `make results` makes it anew"
            ));
        }
    };
    for study in [
        "fig13",
        "fig13-converged",
        "fig13-stiffness",
        "fig13-geometry",
        "clearance",
        "damage",
        "touch",
    ] {
        holds(&format!("results/{study}/table.md"), &digest(study));
    }
    for name in ["figures.md", "claims.md", "sensitivity.md"] {
        holds(&format!("results/paper/{name}"), &digest("paper-cases"));
    }
    for name in ["figures.md", "claims.md"] {
        holds(&format!("results/paper/{name}"), &table);
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The verification manual has today's physics, and a sheet and figures for each case that tests/physics/sheets.toml words.
#[test]
fn the_verification_manual_is_of_todays_sheets() {
    let read = |path: &Path| std::fs::read_to_string(path).unwrap();
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = read(&tests.join("../docs/verification-manual.md"));
    assert_eq!(fault("verification-manual.md", &page), None);
    let words: toml::Table = read(&tests.join("physics/sheets.toml")).parse().unwrap();
    let sheets = words["sheet"].as_array().unwrap();
    assert_eq!(page.matches("\n### ").count(), sheets.len());
    for sheet in sheets {
        let word = |key: &str| sheet[key].as_str().unwrap();
        let [name, title, at] = ["name", "title", "at"].map(word);
        let own = page.split("\n### ").find(|own| own.starts_with(title));
        let own = own.unwrap_or_else(|| panic!("{title}: no sheet; `make manual`"));
        for key in ["problem", "reference", "trust"] {
            let is_there = own.contains(word(key).trim_end_matches('.'));
            assert!(is_there, "{title}, {key}: `make manual` makes it anew");
        }
        let (file, test) = at.split_once("::").unwrap();
        let suite = sheet
            .get("suite")
            .map_or("physics", |suite| suite.as_str().unwrap());
        let files = std::fs::read_dir(tests.join(suite)).unwrap();
        let files = files.map(|file| file.unwrap().path());
        let sources: String = files
            .filter(|path| path.is_file())
            .map(|path| read(&path))
            .collect();
        let named = format!("\"{name}\"");
        assert!(sources.contains(&named), "{name}: no test has it");
        let source = read(&tests.join(format!("{suite}/{file}.rs")));
        assert!(source.contains(&format!("fn {test}")), "{at}: no such test");
    }
}
