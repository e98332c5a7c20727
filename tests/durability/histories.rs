//! Kept histories that are damaged, cut, foreign or left aside.

use std::path::{Path, PathBuf};

use opshock_study::search::Ramp;
use opshock_study::store::{folder::session, history};
use opshock_study::sweep::{Event, MergeEnd, SweepInput, SweepOptions, merge, sweep};
use opshock_tests::hdf5_dump::dump;
use opshock_tests::mock_sweep::{MockSimulator, Recorder, study};

/// Two points; sweeps them into `folder`. Simulations made, and what was warned of.
fn run(input: &SweepInput, folder: &Path) -> (u64, Vec<String>) {
    let mut simulator = MockSimulator::new(input);
    simulator.records = true;
    let recorder = Recorder::default();
    let options = SweepOptions::with_threads(1);
    sweep(input, &simulator, folder, &options, &recorder).expect("sweeps");
    let warned = recorder
        .events()
        .into_iter()
        .filter_map(|event| match event {
            Event::Warning { message, .. } => Some(message),
            _ => None,
        });
    (simulator.calls(), warned.collect())
}

fn swept() -> (tempfile::TempDir, SweepInput, Vec<PathBuf>) {
    let folder = tempfile::tempdir().expect("folder");
    let input = study(&[Ramp::None], &[0.5]);
    run(&input, folder.path());
    let files = kept(folder.path());
    assert_eq!(files.len(), 4);
    (folder, input, files)
}

/// Everything in the folder of the histories.
fn kept(store: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(store.join("histories")).expect("folder");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("entry").path()).collect();
    files.sort();
    files
}

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).expect("reads")
}

#[test]
fn a_name_alone_is_no_finished_history() {
    let (folder, input, files) = swept();
    let whole = bytes(&files[0]);
    let content = dump(&files[0], &[]);
    let unsealed = whole.len() - 40;
    let mut flipped = whole.clone();
    flipped[300] ^= 1;
    // Nothing, cut, as of before histories were sealed, one bit: damage, which is reported.
    for damaged in [&[][..], &whole[..1000], &whole[..unsealed], &flipped] {
        std::fs::write(&files[0], damaged).expect("writes");
        let error = history::parse(&files[0], damaged).expect_err("is refused");
        assert_eq!(error.code(), "E182");
        let (calls, warned) = run(&input, folder.path());
        assert_eq!(calls, 1, "that run alone is recorded");
        let name = files[0].display().to_string();
        assert!(
            warned.len() == 1 && warned[0].starts_with(&name),
            "{warned:?}"
        );
        assert_eq!(dump(&files[0], &[]), content);
        assert_eq!(run(&input, folder.path()), (0, Vec::new()));
    }
    // Whole, but of another run.
    std::fs::copy(&files[1], &files[0]).expect("copies");
    assert_eq!(run(&input, folder.path()), (1, Vec::new()));
    assert_eq!(dump(&files[0], &[]), content);
    // Of the same run, but on another time axis or with other outputs.
    let mut later = input.clone();
    later.start_s += 1e-3;
    assert_eq!(run(&later, folder.path()).0, 4);
    later.plan = "{\"outputs\":[\"contact_force\"]}".into();
    assert_eq!(run(&later, folder.path()).0, 4);
    assert_eq!(run(&later, folder.path()).0, 0);
}

#[test]
fn what_a_killed_process_left_aside_is_cleared() {
    let (folder, input, files) = swept();
    let left = [
        "histories/.aside-abcdef",
        ".aside-abcdef",
        ".aside-journal",
        ".probe-abcdef",
    ];
    for name in left {
        std::fs::write(folder.path().join(name), [0; 100]).expect("writes");
    }
    run(&input, folder.path());
    for name in left {
        assert!(!folder.path().join(name).exists(), "{name}");
    }
    assert_eq!(kept(folder.path()), files);
}

#[test]
fn a_merge_takes_whole_histories_alone() {
    let (from, input, files) = swept();
    let mut damaged = bytes(&files[0]);
    damaged[300] ^= 1;
    std::fs::write(&files[0], damaged).expect("writes");
    let to = tempfile::tempdir().expect("folder");
    let sources = [from.path().to_owned()];
    let merged = merge(&input, to.path(), &sources, &session(1)).expect("merges");
    let MergeEnd::Merged(merged) = merged else {
        panic!("{merged:?}")
    };
    assert_eq!(merged.left.len(), 1);
    assert_eq!(merged.left[0].code(), "E182");
    assert_eq!(kept(to.path()).len(), 3);
    // The next sweep records what is missing.
    assert_eq!(run(&input, to.path()).0, 1);
    assert_eq!(kept(to.path()).len(), 4);
}
