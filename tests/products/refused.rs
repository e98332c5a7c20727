//! Damaged files beside a study, each with the message it gets.

use std::path::{Path, PathBuf};

use opshock_study::study::StudyErrors;

/// Every file of a folder of `bad_inputs`, `at_least` so many, is refused with the code of its name and the message of its snapshot.
pub fn every_file_is_refused(
    folder: &str,
    at_least: usize,
    refused: impl Fn(&Path) -> Option<StudyErrors>,
) {
    let entries = std::fs::read_dir(format!("bad_inputs/{folder}")).expect("a folder");
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    assert!(files.len() >= at_least, "{}", files.len());
    insta::with_settings!({
        snapshot_path => format!("../bad_inputs/{folder}/messages"),
        prepend_module_to_snapshot => false,
        omit_expression => true,
    }, {
        for path in files {
            let name = path.file_stem().expect("a name").to_str().expect("UTF-8");
            let refused = refused(&path).expect(name);
            let code = name.split('_').next().expect("a code").to_uppercase();
            assert!(refused.errors.iter().any(|one| one.code == code), "{name}: {refused}");
            insta::assert_snapshot!(name, refused.to_string());
        }
    });
}
