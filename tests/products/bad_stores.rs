//! Stores that cannot be used, one folder each under `tests/bad_inputs/stores/`, named after the
//! code that it must raise, with a snapshot of what the program says; and those that no file shows.

use std::path::Path;

use crate::cli::{Done, study};
use opshock_tests::coarse;
use opshock_tests::hdf5_dump::dump;

fn sweep(folder: &Path, store: &str, more: &[&str]) -> Done {
    let file = study("fig13");
    let mut words = vec!["sweep", file.to_str().unwrap(), "--store", store, "-j1"];
    words.push("--quiet");
    for set in coarse::TWO_POINTS.iter().chain(&coarse::SEARCH) {
        let key = set.split('=').next().unwrap();
        if !more.iter().any(|other| other.starts_with(key)) {
            words.extend(["--set", set]);
        }
    }
    for set in more {
        words.extend(["--set", set]);
    }
    Done::of(folder, &words)
}

/// What was said, without remarks about the study and what differs from machine to machine.
fn said(done: &Done) -> String {
    let mut text = String::new();
    let is_said = |line: &&str| line.starts_with("error: ") || line.starts_with("  ");
    let studies = study("fig13").canonicalize().unwrap();
    let studies = studies.ancestors().nth(2).unwrap().display().to_string();
    let stderr = done.stderr.replace(&studies, "STUDIES");
    for line in stderr.lines().filter(is_said) {
        let line = match line.split_once("in use by process ") {
            Some((before, _)) => format!("{before}in use by process N on HOST since TIME"),
            None => line.to_owned(),
        };
        text += &line;
        text += "\n";
    }
    text
}

fn snapshot(name: &str, done: &Done) {
    insta::with_settings!({
        snapshot_path => "../bad_inputs/messages",
        prepend_module_to_snapshot => false,
        omit_expression => true,
    }, {
        insta::assert_snapshot!(name, said(done));
    });
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        std::fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
    }
}

#[test]
fn every_bad_store_gets_its_message_and_stays_as_it_was() {
    let stores = Path::new(env!("CARGO_MANIFEST_DIR")).join("bad_inputs/stores");
    let mut count = 0;
    for entry in std::fs::read_dir(stores).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let code = name.split('_').next().unwrap().to_uppercase();
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("s.opshock");
        copy(&path, &store);
        let done = sweep(folder.path(), "s.opshock", &[]);
        assert_eq!(done.code, 6, "{name}: {}", done.stderr);
        assert!(
            said(&done).starts_with(&format!("error: {code}: ")),
            "{name}: {}",
            done.stderr
        );
        assert_eq!(done.stdout, "");
        snapshot(&name, &done);
        for file in std::fs::read_dir(&path).unwrap() {
            let file = file.unwrap();
            assert_eq!(
                std::fs::read(store.join(file.file_name())).unwrap(),
                std::fs::read(file.path()).unwrap(),
                "{name} was changed"
            );
        }
        count += 1;
    }
    assert_eq!(count, 6);
}

#[test]
fn e183_a_store_that_cannot_be_made_is_reported_before_computing() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    let done = sweep(folder.path(), "file/s.opshock", &[]);
    assert_eq!(done.code, 6);
    assert_eq!(done.stdout, "");
    snapshot("e183_below_a_file", &done);
}

#[test]
fn e184_a_store_in_use_names_its_holder() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("s.opshock");
    std::fs::create_dir(&store).unwrap();
    let _held = opshock_study::store::lock::StoreLock::take(&store).unwrap();
    let done = sweep(folder.path(), "s.opshock", &[]);
    assert_eq!(done.code, 6);
    let holder = format!("in use by process {} on ", std::process::id());
    assert!(done.stderr.contains(&holder), "{}", done.stderr);
    snapshot("e184_in_use", &done);
}

#[test]
fn a_changed_study_reuses_what_stays_valid_and_lists_what_changed() {
    let folder = tempfile::tempdir().unwrap();
    let one = sweep(folder.path(), "s.opshock", &[]);
    assert_eq!(one.code, 0, "{}", one.stderr);
    let wider = ["pulse.widths_ms=[0.5, 0.6]"];
    let grown = sweep(folder.path(), "s.opshock", &wider);
    assert_eq!(grown.code, 0, "{}", grown.stderr);
    assert!(
        grown.stderr.contains("study_changed")
            && grown.stderr.contains("pulse.widths_ms [0.5] -> [0.5,0.6]"),
        "{}",
        grown.stderr
    );
    let fresh = sweep(folder.path(), "fresh.opshock", &wider);
    assert_eq!(grown.stdout, fresh.stdout);
    let content = |store: &str| dump(&folder.path().join(store).join("results.h5"), &["/machine"]);
    assert_eq!(content("s.opshock"), content("fresh.opshock"));
    // Said once: the store now belongs to the changed study.
    let again = sweep(folder.path(), "s.opshock", &wider);
    assert!(!again.stderr.contains("study_changed"), "{}", again.stderr);
}
