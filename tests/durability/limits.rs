//! The program under limits of the process, and with folders that fail to close.

use std::path::Path;
use std::process::{Command, Output};

use opshock_tests::coarse;
use opshock_tests::program::program;
use opshock_tests::scenes::study_path;

const OPSHOCK: &str = env!("CARGO_BIN_EXE_opshock-under-test");

/// The words of a small sweep that keeps histories.
fn sweep() -> Vec<String> {
    let mut words = vec![
        "sweep".to_owned(),
        study_path("fig13").display().to_string(),
    ];
    words.extend(["--store", "s.opshock", "-j1", "--quiet"].map(String::from));
    for set in coarse::TWO_POINTS.iter().chain(&coarse::SEARCH) {
        words.extend(["--set".to_owned(), (*set).to_owned()]);
    }
    words
}

fn run(folder: &Path, before: &[&str], words: &[String]) -> Output {
    let under_test = program(OPSHOCK);
    let all = before.iter().map(std::ffi::OsStr::new);
    let mut all = all
        .chain([under_test.get_program()])
        .chain(under_test.get_args());
    let mut command = Command::new(all.next().expect("a program"));
    let command = command.args(all).args(words).current_dir(folder);
    command.output().expect("starts")
}

/// The signal of a file that grows past its limit would end the process with 153, half written.
#[test]
fn a_file_size_limit_is_reported_as_a_disk_that_is_full() {
    let root = tempfile::tempdir().expect("folder");
    // Blocks of 512 or 1024 bytes: below the probe, the journal, the checkpoint, a history; above them all.
    let mut codes = Vec::new();
    for blocks in [4, 16, 64, 256, 1024, 100_000] {
        let folder = root.path().join(blocks.to_string());
        std::fs::create_dir(&folder).expect("folder");
        let limit = format!("ulimit -f {blocks}; exec \"$0\" \"$@\"");
        let done = run(&folder, &["sh", "-c", &limit], &sweep());
        let said = String::from_utf8_lossy(&done.stderr);
        let code = done.status.code();
        if code != Some(0) {
            assert_eq!(code, Some(6), "{blocks} blocks: {said}");
            assert!(said.contains("E183"), "{blocks} blocks: {said}");
        }
        codes.push(code);
        // With room it goes on to the end.
        assert_eq!(run(&folder, &[], &sweep()).status.code(), Some(0));
    }
    assert_eq!((codes[0], codes[5]), (Some(6), Some(0)), "{codes:?}");
}

/// Every close of the process reported as failed with EIO, one after the other, in the commands that list folders.
#[test]
#[ignore = "needs strace: make verify-faults"]
fn faults_slow_a_file_or_folder_that_fails_to_close_is_no_panic() {
    let root = tempfile::tempdir().expect("folder");
    let folder = root.path();
    let done = run(folder, &[], &sweep());
    assert_eq!(done.status.code(), Some(0), "{done:?}");
    let words = |text: &str| text.split(' ').map(String::from).collect::<Vec<_>>();
    for command in [
        sweep(),
        words("report s.opshock --out r --quiet"),
        words("merge s.opshock"),
        words("status s.opshock"),
    ] {
        let mut reported = 0;
        for nth in 1..=80 {
            let inject = format!("inject=close:error=EIO:when={nth}");
            let strace = [
                "strace",
                "-f",
                "-qq",
                "-o",
                "trace",
                "-e",
                "trace=close",
                "-e",
                &inject,
            ];
            let done = run(folder, &strace, &command);
            let said = String::from_utf8_lossy(&done.stderr);
            let code = done.status.code().expect("no signal");
            if code == 127 && said.contains("loading shared libraries") {
                continue;
            }
            assert!(
                [0, 1, 2, 6].contains(&code) && !said.contains("panicked"),
                "close {nth} of {command:?}: {code}, {said}"
            );
            reported += usize::from(code != 0);
        }
        println!("{}: {reported} of 80 reported", command[0]);
    }
}
