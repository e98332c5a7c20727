//! A signal is acknowledged at once, whatever is at work.

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use opshock_tests::coarse;
use opshock_tests::program::program as under_test;

const OPSHOCK: &str = env!("CARGO_BIN_EXE_opshock-under-test");

/// Each run takes longer than the time in question.
const LONG: [&str; 2] = ["--set", "resolution.film_cells=2500"];

fn studies() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies")
}

/// A sweep of two points into `s.opshock` of a folder, by one thread.
fn sweep(folder: &Path, keep_histories: &str) -> Command {
    let mut command = under_test(OPSHOCK);
    command.current_dir(folder).arg("sweep");
    command.arg(studies().join("fig13/study.toml"));
    command.args(["--store", "s.opshock", "-j1", "--progress", "lines"]);
    let sets = coarse::TWO_POINTS.iter().chain(&coarse::SEARCH);
    for set in sets.filter(|set| !set.starts_with("resolution.film_cells")) {
        command.args(["--set", set]);
    }
    command.args(LONG);
    command.args(["--set", &format!("output.keep_histories={keep_histories}")]);
    command
}

/// The share of drives that survive, of the study of that name.
fn population(folder: &Path) -> Command {
    let at = studies().join("yield");
    let mut command = under_test(OPSHOCK);
    command.current_dir(folder).arg("yield");
    command.arg(at.join("study.toml"));
    command.arg("--tolerances").arg(at.join("tolerances.toml"));
    command.arg("--spec").arg(at.join("operating.toml"));
    command.args(["--store", "s.opshock", "-j1"]);
    command.args(LONG);
    command
}

/// Time from a signal, sent when `is_at_work`, to the line that acknowledges it.
fn acknowledged(mut command: Command, is_at_work: impl Fn() -> bool) -> Duration {
    let mut child = command
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts");
    while !is_at_work() {
        assert_eq!(child.try_wait().expect("waits"), None, "ended before");
        std::thread::sleep(Duration::from_millis(2));
    }
    let kill = format!("kill -INT {}", child.id());
    let sent = Command::new("sh").args(["-c", &kill]).status();
    assert!(sent.expect("kill").success());
    let began = Instant::now();
    let lines = BufReader::new(child.stderr.take().expect("piped")).lines();
    let mut lines = lines.map(|line| line.expect("reads"));
    // Where nothing is at work any more, the end is the acknowledgement.
    let is_heard = |line: &str| line.starts_with("stopping: ") || line.starts_with("saved");
    assert!(lines.any(|line| is_heard(&line)));
    let after = began.elapsed();
    child.kill().expect("ends");
    child.wait().expect("waits");
    after
}

/// The shortest of three: other work on the machine may delay any one of them.
fn shortest(what: &str, one: impl Fn() -> Duration) {
    let shortest = (0..3).map(|_| one()).min().expect("three");
    assert!(shortest.as_secs_f64() < 0.2, "{what}: {shortest:?}");
}

#[test]
fn a_signal_is_acknowledged_within_a_fifth_of_a_second() {
    shortest("searches", || {
        let root = tempfile::tempdir().expect("a folder");
        let journal = root.path().join("s.opshock/journal");
        let kept = || std::fs::metadata(&journal).is_ok_and(|file| file.len() > 1000);
        acknowledged(sweep(root.path(), "none"), kept)
    });
    let root = tempfile::tempdir().expect("a folder");
    let done = sweep(root.path(), "none").output().expect("runs");
    assert_eq!(done.status.code(), Some(0), "{done:?}");
    let folder = root.path().join("s.opshock/histories");
    shortest("histories", || {
        let _ = std::fs::remove_dir_all(&folder);
        let recorded = || std::fs::read_dir(&folder).is_ok_and(|mut all| all.next().is_some());
        acknowledged(sweep(root.path(), "all"), recorded)
    });
    shortest("drives", || {
        let root = tempfile::tempdir().expect("a folder");
        let journal = root.path().join("s.opshock/journal");
        let kept = || std::fs::metadata(&journal).is_ok_and(|file| file.len() > 1000);
        acknowledged(population(root.path()), kept)
    });
}
