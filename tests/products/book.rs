//! Pages of the book that a reader follows command by command: each is replayed in an empty folder, and every line shown
//! behind a command must be in its output.

use crate::cli::OPSHOCK;
use opshock_tests::program::program;
use std::collections::BTreeSet;
use std::path::Path;

/// The program's path as pages write it.
const PROGRAM: &str = "target/release/opshock ";

/// Standard output of a page's command in `folder`, by a shell.
fn printed(folder: &Path, command: &str) -> String {
    let command = command.replace(PROGRAM, &format!("{OPSHOCK} "));
    let mut shell = program("sh");
    let done = shell.args(["-ec", &command]).current_dir(folder);
    let done = done.env_remove("COLUMNS").output().unwrap();
    // Exit code 4: some points are open, which the output says.
    let errors = String::from_utf8(done.stderr).unwrap();
    assert!(
        [Some(0), Some(4)].contains(&done.status.code()),
        "{command}\n{errors}"
    );
    String::from_utf8(done.stdout).unwrap()
}

/// Replays a page; the number of its commands.
fn replay(name: &str) -> usize {
    let page = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../docs")
        .join(name);
    let page = std::fs::read_to_string(page).unwrap();
    let at = tempfile::tempdir().unwrap();
    // Later lessons go on with the drive of the first.
    printed(at.path(), &format!("{PROGRAM}new > my-drive.toml"));
    let mut output = String::new();
    let mut n_commands = 0;
    for block in page.split("```").skip(1).step_by(2) {
        let (kind, text) = block.split_once('\n').unwrap();
        match kind {
            "sh" if text.starts_with(PROGRAM) => {
                output = printed(at.path(), text);
                n_commands += 1;
            }
            "text" => {
                let lines: BTreeSet<&str> = output.lines().map(str::trim_end).collect();
                for line in text.lines().map(str::trim_end) {
                    assert!(lines.contains(line), "{name}: {line}\n{output}");
                }
            }
            "toml" => std::fs::write(at.path().join("tolerances.toml"), text).unwrap(),
            _ => {}
        }
    }
    n_commands
}

#[test]
fn the_first_shock_is_as_its_page_shows_it() {
    assert_eq!(replay("first-shock.md"), 7);
}

/// The five lessons: some ten minutes of a core.
#[test]
#[ignore = "make verify-book"]
fn lessons_are_as_their_pages_show_them() {
    for (name, n_commands) in [
        ("disk-and-ramp", 8),
        ("air-film", 9),
        ("critical-shock", 8),
        ("trusting-the-number", 7),
        ("design-decision", 8),
    ] {
        assert_eq!(replay(&format!("lessons/{name}.md")), n_commands, "{name}");
        println!("{name}: {n_commands} commands print what the page shows");
    }
}
