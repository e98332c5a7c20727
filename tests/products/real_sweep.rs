//! Sweeps by the program with the real physics: threads, kills and torn journals leave no trace in the
//! answers.

use std::fs::OpenOptions;
use std::path::Path;
use std::process::Stdio;
use std::sync::LazyLock;
use std::time::Duration;

use super::cli::{Done, study};
use opshock_study::store::journal;
use opshock_study::store::record::Record;
use opshock_tests::hdf5_dump::dump;
use opshock_tests::program::program;

const STORE: &str = "s.opshock";

/// Figure 13 at 5 % and a film of 200 cells, two ramps and two widths, on the first 0.8 ms:
/// 8 points, some 60 runs.
const SMALL: &[&str] = &[
    "pulse.widths_ms=[0.5, 0.7]",
    "ramp.models=[\"none\", \"rigid\"]",
    "pulse.window_ms=0.8",
    "search.tolerance_pct=5",
    "search.max_refinements=1",
    "resolution.preset=\"coarse\"",
    "resolution.film_cells=200",
    "resolution.disk_cut_khz=10",
];

/// All of figure 13 at 5 %.
const WHOLE: &[&str] = &["search.tolerance_pct=5", "resolution.preset=\"coarse\""];

/// Everything a user reads out of a finished store.
#[derive(Debug, PartialEq)]
struct Answer {
    csv: String,
    json: String,
    /// `results.h5` bit by bit, but for what names machine and sitting.
    results: Vec<String>,
}

fn arguments(set: &[&str], threads: usize) -> Vec<String> {
    let path = study("fig13");
    let mut words: Vec<String> = ["sweep", path.to_str().unwrap(), "--store", STORE, "--quiet"]
        .map(String::from)
        .to_vec();
    words.push(format!("-j{threads}"));
    for value in set {
        words.extend(["--set".to_owned(), (*value).to_owned()]);
    }
    words
}

/// Sweeps to the end and reads the store.
fn finish(folder: &Path, set: &[&str], threads: usize) -> Answer {
    let words = arguments(set, threads);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let swept = Done::of(folder, &words);
    assert!([0, 4].contains(&swept.code), "{}", swept.stderr);
    let report = |format: &str| {
        let done = Done::of(folder, &["report", STORE, "--format", format]);
        assert_eq!(done.code, swept.code, "{}", done.stderr);
        done.stdout
    };
    Answer {
        csv: report("csv"),
        json: report("json"),
        results: dump(&folder.join(STORE).join("results.h5"), &["/machine"]),
    }
}

/// Finished runs in the journal.
fn runs(folder: &Path) -> usize {
    let content = journal::read(&folder.join(STORE).join("journal")).expect("reads");
    content.map_or(0, |content| {
        let is_run = |record: &&Record| matches!(record, Record::Run(_));
        content.records.iter().filter(is_run).count()
    })
}

/// Sweeps until the journal holds `more` new runs, then kills the program; whether it was still
/// running.
fn kill_after(folder: &Path, set: &[&str], more: usize) -> bool {
    let before = runs(folder);
    let mut child = program(crate::cli::OPSHOCK)
        .current_dir(folder)
        .args(arguments(set, 2))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts");
    loop {
        if let Some(status) = child.try_wait().expect("waits") {
            assert!([Some(0), Some(4)].contains(&status.code()), "{status}");
            return false;
        }
        if runs(folder) >= before + more {
            // SIGKILL: nothing of the program runs afterwards.
            child.kill().expect("kills");
            return child.wait().expect("waits").code().is_none();
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Cuts the last bytes off the journal, as a power loss may.
fn tear(folder: &Path, bytes: u64) {
    let file = OpenOptions::new()
        .write(true)
        .open(folder.join(STORE).join("journal"))
        .expect("opens");
    let length = file.metadata().expect("metadata").len();
    file.set_len(length - bytes).expect("cuts");
}

/// The small study swept once by two threads without disturbance, and its number of runs.
static UNDISTURBED: LazyLock<(Answer, usize)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("folder");
    let answer = finish(folder.path(), SMALL, 2);
    (answer, runs(folder.path()))
});

#[test]
fn the_physics_gives_the_same_bytes_on_one_thread_and_on_two() {
    let folder = tempfile::tempdir().expect("folder");
    let answer = finish(folder.path(), SMALL, 1);
    assert_eq!(answer, UNDISTURBED.0);
    assert_eq!(answer.csv.lines().count(), 1 + 8, "{}", answer.csv);
    assert!(answer.results.len() > 40);
}

#[test]
fn a_killed_sweep_of_the_physics_ends_with_the_same_bytes() {
    let folder = tempfile::tempdir().expect("folder");
    let mut kills = 0;
    for more in [3, 10, 1] {
        kills += usize::from(kill_after(folder.path(), SMALL, more));
    }
    assert_eq!(kills, 3, "the sweep ended before it could be killed");
    tear(folder.path(), 7);
    let left = runs(folder.path());
    assert!(left >= 3 + 10, "{left}");
    assert_eq!(finish(folder.path(), SMALL, 2), UNDISTURBED.0);
    // What the killed sweeps left was used and not computed again: at most what they had looked
    // ahead at comes on top.
    let (total, whole) = (runs(folder.path()), UNDISTURBED.1);
    assert!(
        total < whole + left,
        "{left} runs before, {total} and {whole} after"
    );
}

/// Figure 13, killed after every 40 runs and with a torn journal after every other kill.
#[test]
#[ignore = "slow: minutes; all of figure 13 at 5 %, killed again and again"]
fn durability_slow_fig13_killed_again_and_again_ends_with_the_same_bytes() {
    let folder = tempfile::tempdir().expect("folder");
    let (whole, killed) = (folder.path().join("whole"), folder.path().join("killed"));
    for place in [&whole, &killed] {
        std::fs::create_dir(place).expect("folder");
    }
    let expected = finish(&whole, WHOLE, 2);
    let mut kills = 0;
    while kill_after(&killed, WHOLE, 40) {
        kills += 1;
        if kills % 2 == 0 {
            tear(&killed, 5);
        }
    }
    println!(
        "{} runs undisturbed; {} in the journal after {kills} kills",
        runs(&whole),
        runs(&killed)
    );
    assert!(kills >= 3, "{kills} kills");
    assert_eq!(finish(&killed, WHOLE, 2), expected);
    // One thread reads the same answers out of a store that two have filled.
    assert_eq!(finish(&killed, WHOLE, 1), expected);
}
