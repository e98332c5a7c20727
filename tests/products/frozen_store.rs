//! A store of an older format (commit 7e99eeb, `tests/fixtures/fig13-7e99eeb`) is refused by its format and stays as
//! it is.

use super::cli::Done;
use std::path::Path;

#[test]
fn a_store_of_an_older_format_is_refused_and_left_alone() {
    let frozen = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/fig13-7e99eeb/store");
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("s.opshock");
    std::fs::create_dir(&store).unwrap();
    let names = ["journal", "results.h5", "study.resolved.toml", "study.toml"];
    for name in names {
        std::fs::copy(frozen.join(name), store.join(name)).unwrap();
    }
    let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies/fig13/study.toml");
    let study = study.display().to_string();
    for words in [
        &["report", "s.opshock", "--format", "csv"][..],
        &["report", "s.opshock", "--out", "r"],
        &["status", "s.opshock"],
        &["export", "s.opshock"],
        &["sweep", &study, "--store", "s.opshock"],
    ] {
        let done = Done::of(folder.path(), words);
        assert_eq!(done.code, 6, "{words:?}: {}", done.stderr);
        assert!(
            done.stderr.contains("E181")
                && done.stderr.contains("compute it anew, in another folder"),
            "{words:?}: {}",
            done.stderr
        );
    }
    for name in names {
        let [now, before] = [&store, &frozen].map(|at| std::fs::read(at.join(name)).unwrap());
        assert!(now == before, "{name}");
    }
    assert!(!folder.path().join("r").exists());
}
