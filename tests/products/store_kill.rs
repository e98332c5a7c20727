//! Processes that are killed or run out of disk in the middle of a sweep.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use opshock_study::search::Status;
use opshock_study::sweep::{Silent, SweepEnd, SweepOptions, stored, sweep};
use opshock_tests::hdf5_dump::dump;
use opshock_tests::mock_sweep::{MockSimulator, fig13};
use opshock_tests::program::program;

const MOCK: &str = env!("CARGO_BIN_EXE_sweep-mock");

fn finish(folder: &Path) -> SweepEnd {
    let input = fig13();
    sweep(
        &input,
        &MockSimulator::new(&input),
        folder,
        &SweepOptions::with_threads(2),
        &Silent,
    )
    .expect("sweeps")
}

fn content(folder: &Path) -> Vec<String> {
    dump(&folder.join("results.h5"), &["/machine"])
}

/// Starts a sweep of some 500 runs of 3 ms on two threads and waits until it runs.
fn start(folder: &Path) -> Child {
    let mut child = program(MOCK)
        .arg(folder)
        .args(["2", "3"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts");
    let mut line = String::new();
    let output = child.stdout.as_mut().expect("piped");
    BufReader::new(output).read_line(&mut line).expect("ready");
    child
}

#[test]
fn killed_sweeps_end_with_the_same_bits_and_lose_nothing() {
    let root = tempfile::tempdir().expect("folder");
    let reference = finish(&root.path().join("whole"));
    let expected = content(&root.path().join("whole"));
    let folder = root.path().join("killed");
    for round in 0..5 {
        let mut child = start(&folder);
        std::thread::sleep(Duration::from_millis(40 + 37 * round));
        child.kill().expect("kills");
        child.wait().expect("waits");
    }
    // What a killed sweep left can be read before it goes on.
    let partial = stored(&fig13(), &folder).expect("reads").summary;
    assert!(partial.totals.runs > 0);
    for (row, answer) in partial.points.iter().zip(&reference.summary.points) {
        assert!(row == answer || row.status == Status::Open);
    }
    let end = finish(&folder);
    assert_eq!(end.summary, reference.summary);
    assert_eq!(content(&folder), expected);
    assert_eq!(
        stored(&fig13(), &folder).expect("reads").summary,
        reference.summary
    );
    assert!(
        end.computed_runs < reference.computed_runs,
        "the killed sweeps left nothing"
    );
}

#[test]
fn a_full_disk_ends_the_sweep_and_keeps_what_was_finished() {
    let root = tempfile::tempdir().expect("folder");
    let whole = finish(&root.path().join("whole"));
    let folder = root.path().join("full");
    // 32 blocks of 512 or 1024 bytes: the journal does not fit.
    let status = Command::new("sh")
        .arg("-c")
        .arg("trap '' XFSZ; ulimit -f 32; exec \"$0\" \"$1\" 2 1 60000 2>/dev/null >/dev/null")
        .arg(MOCK)
        .arg(&folder)
        .status()
        .expect("runs");
    assert_eq!(status.code(), Some(6));
    let end = finish(&folder);
    assert_eq!(end.summary, whole.summary);
    assert!(end.computed_runs < whole.computed_runs);
    assert_eq!(content(&folder), content(&root.path().join("whole")));
}
