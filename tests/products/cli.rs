//! Runs the program: what every test of the command line shares, and rules that every command keeps.

use assert_cmd::Command;
use opshock_tests::program::program;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The program itself.
pub const OPSHOCK: &str = env!("CARGO_BIN_EXE_opshock-under-test");

/// The program in `folder`, without the caller's terminal settings.
pub fn opshock(folder: &Path) -> Command {
    let mut command = Command::from_std(program(OPSHOCK));
    command
        .current_dir(folder)
        .env_remove("NO_COLOR")
        .env_remove("COLUMNS");
    command
}

/// What a command did.
pub struct Done {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Done {
    /// Runs the program with `arguments` in `folder`.
    pub fn of(folder: &Path, arguments: &[&str]) -> Self {
        let output = opshock(folder)
            .args(arguments)
            .output()
            .expect("the program starts");
        Self {
            code: output.status.code().expect("an exit code"),
            stdout: String::from_utf8(output.stdout).expect("UTF-8"),
            stderr: String::from_utf8(output.stderr).expect("UTF-8"),
        }
    }

    /// Standard output as JSON.
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout)
            .unwrap_or_else(|error| panic!("{error}\n{}\n{}", self.stdout, self.stderr))
    }

    /// `errors` of the JSON on standard error.
    pub fn errors(&self) -> Vec<Value> {
        let reported: Value = serde_json::from_str(&self.stderr)
            .unwrap_or_else(|error| panic!("{error}\n{}", self.stderr));
        reported["errors"].as_array().expect("a list").clone()
    }
}

/// A coarse film and disk and a short window: milliseconds, and the same paths.
pub const COARSE: [&str; 6] = [
    "--set",
    "resolution.film_cells=300",
    "--set",
    "pulse.window_ms=1.5",
    "--set",
    "resolution.disk_cut_khz=10",
];

/// A study of the repository.
pub fn study(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../studies")
        .join(name)
        .join("study.toml")
}

/// Files below `folder`.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    found.sort();
    found
}

#[test]
fn version_names_the_commit_and_help_the_exit_codes() {
    let folder = tempfile::tempdir().unwrap();
    for option in ["--version", "-V"] {
        let version = Done::of(folder.path(), &[option]);
        assert_eq!(version.code, 0);
        let (name, rest) = version
            .stdout
            .trim()
            .split_once(' ')
            .expect("name and version");
        assert_eq!(name, "opshock");
        assert!(
            rest.starts_with("0.") && rest.contains('(') && rest.ends_with(')'),
            "{rest}"
        );
    }
    let help = Done::of(folder.path(), &["--help"]);
    assert_eq!(help.code, 0);
    assert!(help.stdout.contains("Exit codes:") && help.stderr.is_empty());
}

#[test]
fn a_wrong_command_line_is_exit_2_on_stderr_also_as_json() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &[][..],
        &["fly"],
        &["check"],
        &["check", "s.toml", "--frobnicate"],
    ] {
        let reported = Done::of(folder.path(), arguments);
        assert_eq!(reported.code, 2, "{arguments:?}");
        assert!(
            reported.stdout.is_empty() && !reported.stderr.is_empty(),
            "{arguments:?}"
        );
        let mut with_json = arguments.to_vec();
        with_json.push("--json");
        let reported = Done::of(folder.path(), &with_json);
        assert_eq!(reported.code, 2, "{arguments:?}");
        if !arguments.is_empty() {
            assert_eq!(reported.errors()[0]["code"], "usage", "{arguments:?}");
        }
    }
}

#[test]
fn a_reader_that_goes_away_ends_the_program_quietly() {
    use std::io::Read as _;
    use std::process::Stdio;
    let mut child = program(OPSHOCK)
        .arg("schema")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // More than a pipe holds is written: closing after the first byte breaks it.
    let mut first = [0];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn completions_are_printed_for_the_shells() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish"] {
        let done = Done::of(folder.path(), &["completions", shell]);
        assert_eq!(done.code, 0);
        assert!(done.stdout.contains("opshock"), "{shell}");
    }
}

#[test]
fn manual_pages_are_written_for_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let done = Done::of(folder.path(), &["completions", "--man", "man1"]);
    assert_eq!((done.code, done.stdout.as_str()), (0, ""));
    let page = |name: &str| std::fs::read_to_string(folder.path().join("man1").join(name)).unwrap();
    let named = page("opshock.1").matches("opshock\\-").count();
    let written = std::fs::read_dir(folder.path().join("man1"))
        .unwrap()
        .count();
    // The program's own page, and those of three imports.
    assert!(named > 20 && written > named, "{named} {written}");
    let sweep = page("opshock-sweep.1");
    assert!(
        sweep.starts_with(".ie") && sweep.contains(".TH opshock-sweep 1"),
        "{sweep}"
    );
    assert!(sweep.contains("save and end with exit code 5"), "{sweep}");
    let both = Done::of(folder.path(), &["completions", "bash", "--man", "man1"]);
    assert_eq!(both.code, 2);
    assert_eq!(Done::of(folder.path(), &["completions"]).code, 2);
}

/// A load in another unit: `check` warns, `sweep` starts nothing unless it is accepted.
#[test]
fn a_sweep_stops_on_what_is_outside_the_usual_range_unless_it_is_accepted() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("d.toml"), Done::of(at, &["new"]).stdout).unwrap();
    let heavy = ["--set", "suspension.gram_load_gf=20"];
    let checked = Done::of(at, &[&["check", "d.toml"], &heavy[..]].concat());
    assert_eq!(checked.code, 0, "{}", checked.stderr);
    let is_labelled = |line: &str| line.starts_with("warning: ") && line.contains(" W201 ");
    assert!(
        checked.stderr.lines().any(is_labelled),
        "{}",
        checked.stderr
    );
    assert!(
        checked
            .stdout
            .starts_with("my drive: valid, with a warning that stops a sweep"),
        "{}",
        checked.stdout
    );
    let sweep = [
        &["sweep", "d.toml", "--store", "s", "--budget", "0s"],
        &heavy[..],
    ]
    .concat();
    let stopped = Done::of(at, &sweep);
    assert_eq!(stopped.code, 3, "{}", stopped.stderr);
    let hint = "--accept W201 starts all the same";
    assert!(stopped.stderr.contains(hint), "{}", stopped.stderr);
    assert!(!at.join("s").exists());
    let accepted = Done::of(at, &[&sweep[..], &["--accept", "W201"]].concat());
    assert_eq!(accepted.code, 5, "{}", accepted.stderr);
    assert!(at.join("s").exists());
}
