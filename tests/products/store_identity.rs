//! A store knows its study by content: whatever the directory, the names and the folders, a command
//! that is given a study answers with that study's numbers or with a refusal.

use std::path::{Path, PathBuf};

use crate::cli::{Done, study};
use opshock_study::study::{SetArg, Study};
use opshock_tests::coarse;
use serde_json::Value;

/// One point, half a second: the drive of `fig13-stiffness` with a disk of this thickness, as a file that needs no
/// other.
fn drive(thickness_mm: f64) -> String {
    let mut sets: Vec<String> = coarse::TWO_POINTS.map(String::from).to_vec();
    sets.extend(coarse::SEARCH.map(String::from));
    sets.extend([
        "pulse.signs=[\"+\"]".to_owned(),
        format!("disk.thickness_mm={thickness_mm:?}"),
    ]);
    let sets: Vec<SetArg> = sets.iter().map(|set| set.parse().unwrap()).collect();
    Study::from_path(&study("fig13-stiffness"), &sets)
        .unwrap()
        .resolved_toml()
}

fn write(path: &Path, text: &str) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

fn sweep(at: &Path, file: &str, more: &[&str]) -> Done {
    Done::of(at, &[&["sweep", file, "--quiet", "-j1"], more].concat())
}

/// Digest and critical shock that a command prints.
fn answer(json: &Value) -> (String, f64) {
    let a_crit_g = json["points"][0]["a_crit_g"].as_f64().expect("an answer");
    (json["digest"].as_str().unwrap().to_owned(), a_crit_g)
}

/// The answer of `sweep`.
fn swept(at: &Path, file: &str, more: &[&str]) -> (String, f64) {
    let done = sweep(at, file, &[&["--json"], more].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    answer(&done.json())
}

/// Refused as another study's, with nothing printed; what was said.
fn refused(done: &Done) -> String {
    assert_eq!(
        (done.code, done.stdout.as_str()),
        (6, ""),
        "{}",
        done.stderr
    );
    assert!(done.stderr.contains("E188"), "{}", done.stderr);
    done.stderr.clone()
}

#[test]
fn every_study_shows_its_own_numbers_from_every_directory() {
    let root = tempfile::tempdir().unwrap();
    let root = root.path();
    // Two files in one folder, and one with the name of the first in another; all studies have one name.
    let files = ["one/a.toml", "one/c.toml", "two/a.toml", "one/a.txt"];
    let thicknesses_mm = [0.635, 0.9, 0.4, 0.5];
    for (file, thickness_mm) in files.iter().zip(thicknesses_mm) {
        write(&root.join(file), &drive(thickness_mm));
    }
    // Each from another directory, by a relative and by an absolute path.
    let absolute = root.join("one/a.txt").display().to_string();
    let truth = [
        swept(&root.join("one"), "a.toml", &[]),
        swept(root, "one/c.toml", &[]),
        swept(&root.join("one"), "../two/a.toml", &[]),
        swept(&root.join("two"), &absolute, &[]),
    ];
    for (k, one) in truth.iter().enumerate() {
        for other in &truth[..k] {
            assert!(one.0 != other.0 && one.1 != other.1, "{truth:?}");
        }
    }
    for store in [
        "one/a.opshock",
        "one/c.opshock",
        "two/a.opshock",
        "one/a.txt.opshock",
    ] {
        assert!(root.join(store).join("journal").is_file(), "{store}");
    }
    let directories = ["", "one", "two", "one/a.opshock"];
    for (file, truth) in files.iter().zip(&truth) {
        for directory in directories {
            let up = "../".repeat(Path::new(directory).components().count());
            let absolute = root.join(file).display().to_string();
            for path in [format!("{up}{file}"), absolute] {
                for command in ["report", "status"] {
                    let done = Done::of(&root.join(directory), &[command, &path, "--json"]);
                    assert_eq!(done.code, 0, "{directory}: {}", done.stderr);
                    assert_eq!(
                        &answer(&done.json()),
                        truth,
                        "{command} {path} in {directory}"
                    );
                }
                let plan = Done::of(&root.join(directory), &["plan", &path, "--json"]).json();
                assert_eq!(plan["answered"], 1, "plan {path} in {directory}: {plan}");
            }
        }
    }
    let compared = Done::of(
        root,
        &["compare", "one/a.toml", "two/../one/c.toml", "--json"],
    )
    .json();
    let settings = compared["settings"].as_array().unwrap();
    assert_eq!(settings.len(), 1, "{compared}");
    assert_eq!(settings[0]["key"], "disk.thickness_mm");
    for (side, truth) in [("a", &truth[0]), ("b", &truth[1])] {
        assert_eq!(compared["points"][0][side]["a_crit_g"], truth.1);
    }
}

#[test]
fn one_store_never_takes_two_studies() {
    let root = tempfile::tempdir().unwrap();
    let root = root.path();
    for (file, thickness_mm) in [("a.toml", 0.635), ("c.toml", 0.9), ("two/a.toml", 0.9)] {
        write(&root.join(file), &drive(thickness_mm));
    }
    let truth = swept(root, "a.toml", &["--store", "s.opshock"]);
    let bytes = || std::fs::read(root.join("s.opshock/results.h5")).unwrap();
    let before = bytes();
    // Another file is refused from any directory, for writing and for reading, with what differs.
    let elsewhere = root.join("two");
    for (at, file, store) in [
        (root, "c.toml", "s.opshock"),
        (root, "two/a.toml", "s.opshock"),
        (&elsewhere, "a.toml", "../s.opshock"),
    ] {
        for command in ["sweep", "plan", "status", "report", "export"] {
            let said = refused(&Done::of(at, &[command, file, "--store", store]));
            assert!(said.contains("disk.thickness_mm 0.635 -> 0.9"), "{said}");
        }
        let said = refused(&Done::of(at, &["compare", file, store, "--store", store]));
        assert!(said.contains("disk.thickness_mm"), "{said}");
        let said = refused(&Done::of(at, &["merge", file, store]));
        assert!(said.contains("disk.thickness_mm"), "{said}");
    }
    assert_eq!(bytes(), before);
    // A copy of the same study is the same study.
    std::fs::copy(root.join("a.toml"), root.join("two/copy.toml")).unwrap();
    let copy = Done::of(
        &elsewhere,
        &["report", "copy.toml", "--store", "../s.opshock", "--json"],
    );
    assert_eq!(answer(&copy.json()), truth);
    assert_eq!(
        swept(&elsewhere, "copy.toml", &["--store", "../s.opshock"]),
        truth
    );
}

#[test]
fn an_edited_study_goes_on_in_its_store_and_shows_nothing_of_before() {
    let root = tempfile::tempdir().unwrap();
    let (old, new) = (root.path().join("old"), root.path().join("new"));
    write(&old.join("a.toml"), &drive(0.635));
    let before = swept(&old, "a.toml", &[]);
    // Moved together, then edited.
    std::fs::rename(&old, &new).unwrap();
    assert_eq!(swept(root.path(), "new/a.toml", &[]), before);
    write(&new.join("a.toml"), &drive(0.9));
    let said = refused(&Done::of(&new, &["status", "a.toml"]));
    assert!(said.contains("disk.thickness_mm 0.635 -> 0.9"), "{said}");
    // What the command line sets is an edit.
    let as_before = [
        "report",
        "a.toml",
        "--json",
        "--set",
        "disk.thickness_mm=0.635",
    ];
    assert_eq!(answer(&Done::of(&new, &as_before).json()), before);
    let done = Done::of(
        &new,
        &["sweep", "a.toml", "-j1", "--progress", "lines", "--json"],
    );
    assert!(
        done.stderr.contains("disk.thickness_mm 0.635 -> 0.9"),
        "{}",
        done.stderr
    );
    let after = answer(&done.json());
    assert!(after.0 != before.0 && after.1 != before.1, "{after:?}");
    assert_eq!(
        answer(&Done::of(&new, &["report", "a.toml", "--json"]).json()),
        after
    );
    // Back again: nothing has to be simulated, and nothing is mixed up.
    write(&new.join("a.toml"), &drive(0.635));
    assert_eq!(swept(&new, "a.toml", &[]), before);
}

#[test]
fn the_journal_alone_is_a_store() {
    let root = tempfile::tempdir().unwrap();
    write(&root.path().join("a.toml"), &drive(0.635));
    let truth = swept(root.path(), "a.toml", &[]);
    let store = root.path().join("a.opshock");
    for file in ["study.resolved.toml", "study.toml", "results.h5"] {
        std::fs::remove_file(store.join(file)).unwrap();
        for source in ["a.toml", "a.opshock"] {
            for command in ["report", "status"] {
                let done = Done::of(root.path(), &[command, source, "--json"]);
                assert_eq!(done.code, 0, "without {file}: {}", done.stderr);
                assert_eq!(
                    answer(&done.json()),
                    truth,
                    "{command} {source} without {file}"
                );
            }
        }
    }
    let merged = Done::of(
        root.path(),
        &["merge", "all.opshock", "a.opshock", "--json"],
    );
    assert_eq!(answer(&merged.json()), truth);
    assert_eq!(swept(root.path(), "a.toml", &[]), truth);
    let kept: PathBuf = store.join("study.resolved.toml");
    assert_eq!(std::fs::read_to_string(kept).unwrap(), drive(0.635));
}

#[test]
fn a_store_without_its_journal_header_still_knows_its_study() {
    let root = tempfile::tempdir().unwrap();
    let root = root.path();
    write(&root.join("a.toml"), &drive(0.635));
    let truth = swept(root, "a.toml", &[]);
    let store = root.join("a.opshock");
    let journal = store.join("journal");
    let mut bytes = std::fs::read(&journal).unwrap();
    bytes[20] ^= 1;
    std::fs::write(&journal, &bytes).unwrap();
    std::fs::remove_file(store.join("results.h5")).unwrap();
    for source in ["a.toml", "a.opshock"] {
        let done = Done::of(root, &["report", source, "--json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        assert_eq!(answer(&done.json()), truth);
    }
    // Nor is another study admitted, and without the text nothing is made up.
    let other = drive(0.9).replace("name = \"Fig. 13", "name = \"Another, not Fig. 13");
    write(&root.join("c.toml"), &other);
    refused(&sweep(root, "c.toml", &["--store", "a.opshock"]));
    std::fs::remove_file(store.join("study.resolved.toml")).unwrap();
    let done = Done::of(root, &["report", "a.opshock"]);
    assert_eq!(done.code, 6, "{}", done.stderr);
    assert!(done.stderr.contains("E182"), "{}", done.stderr);
    // The study itself makes it whole, with every run that is.
    assert_eq!(swept(root, "a.toml", &[]), truth);
}

#[test]
fn shards_of_before_an_edit_do_not_take_the_place_of_what_came_after() {
    let root = tempfile::tempdir().unwrap();
    let root = root.path();
    write(&root.join("a.toml"), &drive(0.635));
    for part in ["1/2", "2/2"] {
        let done = sweep(root, "a.toml", &["--shard", part]);
        assert_eq!(done.code, 0, "{}", done.stderr);
    }
    assert_eq!(Done::of(root, &["merge", "a.toml"]).code, 0);
    write(&root.join("a.toml"), &drive(0.9));
    let after = swept(root, "a.toml", &[]);
    refused(&Done::of(root, &["merge", "a.opshock"]));
    refused(&Done::of(root, &["merge", "a.toml"]));
    assert_eq!(
        answer(&Done::of(root, &["report", "a.toml", "--json"]).json()),
        after
    );
}

#[test]
fn a_study_whose_name_is_no_text_is_swept_and_read() {
    use std::os::unix::ffi::OsStrExt as _;
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join(std::ffi::OsStr::from_bytes(b"n\xe9"));
    write(&folder.join("a.toml"), &drive(0.635));
    let truth = swept(&folder, "a.toml", &[]);
    assert_eq!(
        answer(&Done::of(&folder, &["report", "a.toml", "--json"]).json()),
        truth
    );
}
