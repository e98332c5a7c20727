//! The program under signals, with a reader that goes away, and as two processes on one store.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use opshock_study::store::{Status, results};
use opshock_study::sweep::{Silent, SweepOptions, stored, sweep};
use opshock_tests::coarse;
use opshock_tests::mock_sweep::{MockSimulator, fig13};
use opshock_tests::program::program as under_test;

const MOCK: &str = env!("CARGO_BIN_EXE_sweep-mock");
const OPSHOCK: &str = env!("CARGO_BIN_EXE_opshock-under-test");

fn study() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies/fig13/study.toml")
}

/// `opshock sweep` of the fast study into `s.opshock` of a folder.
fn program(folder: &Path) -> Command {
    let mut command = under_test(OPSHOCK);
    command.current_dir(folder).arg("sweep").arg(study());
    command.args(["--store", "s.opshock", "-j1"]);
    for set in coarse::TWO_POINTS.iter().chain(&coarse::SEARCH) {
        command.args(["--set", set]);
    }
    command
}

fn shell(text: &str, command: &Command) -> Output {
    Command::new("sh")
        .args(["-c", text])
        .arg(command.get_program())
        .args(command.get_args())
        .current_dir(command.get_current_dir().expect("a folder"))
        .output()
        .expect("runs")
}

fn send(child: &Child, signal: &str) {
    // The shell's own `kill`: the program of that name is not on every machine.
    let status = Command::new("sh")
        .args(["-c", &format!("kill {signal} {}", child.id())])
        .status()
        .expect("kill");
    assert!(status.success());
}

/// Starts the mock and waits until it has reported `runs` simulations.
fn start(
    folder: &Path,
    sleep_ms: &str,
    runs: usize,
) -> (Child, BufReader<std::process::ChildStdout>) {
    let mut child = under_test(MOCK)
        .arg(folder)
        .args(["2", sleep_ms])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts");
    let mut lines = BufReader::new(child.stdout.take().expect("piped"));
    let mut line = String::new();
    for _ in 0..=runs {
        line.clear();
        lines.read_line(&mut line).expect("a line");
        assert!(!line.is_empty(), "ended too early");
    }
    (child, lines)
}

#[test]
fn a_signal_saves_and_ends_with_128_and_its_number() {
    let root = tempfile::tempdir().expect("folder");
    for (signal, code) in [("-INT", 130), ("-TERM", 143), ("-HUP", 129)] {
        let folder = root.path().join(signal);
        let (mut child, _lines) = start(&folder, "3", 20);
        send(&child, signal);
        assert_eq!(child.wait().expect("waits").code(), Some(code), "{signal}");
        let saved = results::read(&folder.join("results.h5"))
            .expect("reads")
            .expect("is there");
        assert!(saved.summary.totals.runs >= 20, "{signal}");
        assert!(saved.summary.totals.open > 0, "{signal}");
    }
}

#[test]
fn a_second_signal_ends_at_once_and_loses_nothing() {
    let root = tempfile::tempdir().expect("folder");
    let whole = root.path().join("whole");
    let input = fig13();
    let options = SweepOptions::with_threads(1);
    let simulator = MockSimulator::new(&input);
    let reference = sweep(&input, &simulator, &whole, &options, &Silent).expect("sweeps");
    for (signal, code) in [("-INT", 130), ("-TERM", 143), ("-HUP", 129)] {
        let folder = root.path().join(signal);
        // Store what takes no time, then start runs that take minutes.
        let (mut child, _lines) = start(&folder, "3", 30);
        send(&child, "-KILL");
        child.wait().expect("waits");
        let known = stored(&input, &folder).expect("reads").summary.totals.runs;
        let (mut child, lines) = start(&folder, "300000", 0);
        let mut lines = lines.lines().map(|line| line.expect("reads"));
        assert!(lines.any(|line| line == "begun"), "{signal}");
        send(&child, signal);
        // The first waits for the runs at hand.
        let moment = std::time::Duration::from_millis(200);
        std::thread::sleep(moment);
        assert!(child.try_wait().expect("waits").is_none(), "{signal}");
        // One that comes before the first was seen is one with it: a machine may be as busy as that.
        let ended = (0..300).find_map(|_| {
            send(&child, signal);
            std::thread::sleep(moment);
            child.try_wait().expect("waits")
        });
        assert_eq!(ended.expect("ends").code(), Some(code), "{signal}");
        let after = stored(&input, &folder).expect("reads").summary;
        assert_eq!(after.totals.runs, known, "{signal}");
        let end = sweep(&input, &simulator, &folder, &options, &Silent).expect("sweeps");
        assert_eq!(end.summary, reference.summary, "{signal}");
    }
}

#[test]
fn an_ignored_hangup_stays_ignored() {
    let root = tempfile::tempdir().expect("folder");
    let folder = root.path().join("nohup");
    let mut child = Command::new("sh")
        .args(["-c", "trap '' HUP; exec \"$0\" \"$1\" 2 1"])
        .arg(MOCK)
        .arg(&folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts");
    let mut lines = BufReader::new(child.stdout.take().expect("piped")).lines();
    for _ in 0..20 {
        lines.next().expect("a line").expect("reads");
    }
    send(&child, "-HUP");
    lines.for_each(drop);
    assert_eq!(child.wait().expect("waits").code(), Some(0));
}

#[test]
fn a_second_process_is_refused_and_disturbs_nothing() {
    let root = tempfile::tempdir().expect("folder");
    let folder = root.path().join("store");
    let (mut first, lines) = start(&folder, "3", 10);
    let second = under_test(MOCK)
        .arg(&folder)
        .args(["2", "3"])
        .output()
        .expect("runs");
    let said = String::from_utf8(second.stderr).expect("UTF-8");
    assert_eq!(second.status.code(), Some(6), "{said}");
    let holder = format!("in use by process {} on ", first.id());
    assert!(said.starts_with("E184") && said.contains(&holder), "{said}");
    // Reading is allowed meanwhile, and sees answers or open points.
    let partial = stored(&fig13(), &folder).expect("reads").summary;
    assert!(partial.points.iter().any(|row| row.status == Status::Open));
    drop(lines);
    assert_eq!(first.wait().expect("waits").code(), Some(0));
    let end = stored(&fig13(), &folder).expect("reads").summary;
    assert_eq!(end.totals.open, 0);
}

#[test]
fn the_program_tells_how_to_go_on_after_a_signal() {
    let root = tempfile::tempdir().expect("folder");
    let mut command = program(root.path());
    command
        .args(["--set", "search.tolerance_pct=1"])
        .args(["--progress", "lines"]);
    let words: Vec<_> = command
        .get_args()
        .filter(|word| *word != "search.tolerance_pct=20")
        .map(std::ffi::OsStr::to_owned)
        .collect();
    // The same key twice is an error: the tolerance given first is taken out with its `--set`.
    let place = words
        .windows(2)
        .position(|two| two[0] == "--set" && two[1] == "--set");
    let mut words = words;
    words.remove(place.expect("two in a row"));
    let mut child = Command::new(command.get_program())
        .current_dir(root.path())
        .args(&words)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts");
    let mut lines = BufReader::new(child.stderr.take().expect("piped")).lines();
    // Remarks about the study come first; the numbers come when the sweep has begun.
    while !lines
        .next()
        .expect("a line")
        .expect("reads")
        .contains(" threads, ")
    {}
    send(&child, "-INT");
    let said: Vec<String> = lines.map(|line| line.expect("reads")).collect();
    assert_eq!(child.wait().expect("waits").code(), Some(130), "{said:?}");
    let is_reported = |line: &String| line.starts_with("stopping");
    assert!(said.iter().any(is_reported), "{said:?}");
    let resume = said.last().expect("a line");
    let line = resume
        .strip_prefix("saved; resume with: opshock ")
        .expect("the resume line");
    assert!(line.contains("--store s.opshock"), "{line}");
    let done = Command::new("sh")
        .args(["-c", &format!("\"$0\" {line} --no-cache --quiet"), OPSHOCK])
        .current_dir(root.path())
        .output()
        .expect("runs");
    assert_eq!(done.status.code(), Some(0), "{done:?}");
}

#[test]
fn an_output_that_nobody_takes_costs_no_result() {
    let root = tempfile::tempdir().expect("folder");
    // A reader that is gone before the first word is no failure: the store has it all.
    for (text, code, name) in [
        (
            "{ \"$0\" \"$@\"; echo $? >code; } | true; exit $(cat code)",
            0,
            "gone",
        ),
        ("exec \"$0\" \"$@\" >&-", 0, "closed"),
        ("exec \"$0\" \"$@\" >&- 2>&-", 0, "both closed"),
        ("exec \"$0\" \"$@\" >/dev/full", 1, "full"),
    ] {
        let folder = root.path().join(name);
        std::fs::create_dir(&folder).expect("folder");
        let done = shell(text, &program(&folder));
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(code), "{name}: {said}");
        assert!(!said.contains("panicked"), "{name}: {said}");
        let saved = results::read(&folder.join("s.opshock/results.h5"))
            .expect("reads")
            .expect("is there");
        assert_eq!(saved.summary.totals.open, 0, "{name}");
    }
}

#[test]
fn the_first_line_comes_within_a_tenth_of_a_second() {
    let root = tempfile::tempdir().expect("folder");
    // The best of five: other work on the machine may delay any one of them.
    let shortest = (0..5)
        .map(|i| {
            let folder = root.path().join(i.to_string());
            std::fs::create_dir(&folder).expect("folder");
            let began = std::time::Instant::now();
            let mut child = program(&folder)
                .stdout(Stdio::null())
                .stderr(Stdio::piped())
                .spawn()
                .expect("starts");
            let mut line = String::new();
            BufReader::new(child.stderr.take().expect("piped"))
                .read_line(&mut line)
                .expect("a line");
            let took = began.elapsed();
            assert!(!line.is_empty());
            child.kill().expect("kills");
            child.wait().expect("waits");
            took
        })
        .min()
        .expect("five");
    assert!(shortest.as_millis() < 100, "{shortest:?}");
}
