//! A store of commit 7e99eeb (`tests/fixtures/fig13-7e99eeb`): what reads it today gives its table, or says why not.

use super::cli::Done;
use std::path::Path;

fn frozen() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/fig13-7e99eeb")
}

#[test]
fn a_store_of_7e99eeb_is_read_or_refused_with_a_code() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("s.opshock");
    std::fs::create_dir(&store).unwrap();
    for name in ["journal", "results.h5", "study.resolved.toml", "study.toml"] {
        std::fs::copy(frozen().join("store").join(name), store.join(name)).unwrap();
    }
    let study = frozen().join("study.toml").display().to_string();
    let table = std::fs::read_to_string(frozen().join("store/table.csv")).unwrap();
    for words in [
        &["report", "s.opshock", "--format", "csv"][..],
        &["report", "s.opshock", "--out", "r"],
        &["status", "s.opshock"],
        &["export", "s.opshock"],
        &["compare", "s.opshock", "s.opshock"],
        &["plan", &study, "--store", "s.opshock"],
    ] {
        let done = Done::of(folder.path(), words);
        match done.code {
            0 | 4 => assert!(!done.stdout.is_empty(), "{words:?}"),
            3 | 6 => assert!(
                done.stderr.contains("error: E1") || done.stderr.contains(": E1"),
                "{words:?}: {}",
                done.stderr
            ),
            code => panic!("{words:?}: {code}: {}", done.stderr),
        }
        if done.code == 0 && words.contains(&"csv") {
            assert_eq!(done.stdout, table);
        }
    }
}
