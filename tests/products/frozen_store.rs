//! A store of commit 7e99eeb (`tests/fixtures/fig13-7e99eeb`): what reads it today gives its table.

use super::cli::Done;
use std::path::Path;

fn frozen() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/fig13-7e99eeb")
}

#[test]
fn a_store_of_7e99eeb_is_read() {
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
        assert_eq!(done.code, 0, "{words:?}: {}", done.stderr);
        assert!(!done.stdout.is_empty(), "{words:?}");
        if words.contains(&"csv") {
            assert_eq!(done.stdout, table);
        }
    }
    // The numbers are those of 7e99eeb, whatever program wrote the page.
    let page = std::fs::read_to_string(folder.path().join("r/table.md")).unwrap();
    assert!(
        page.contains("\nopshock 0.1.0 (7e99eeb266b3, physics 7/11), study "),
        "{page}"
    );
}
