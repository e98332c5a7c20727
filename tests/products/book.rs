//! Commands of the book. Pages that a reader follows line by line are replayed, and every line shown behind a command must be in
//! its output; the commands of all others run.

use crate::cli::OPSHOCK;
use crate::documents::{blocks, drive_of, page, root};
use opshock_tests::program::program;
use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};

/// A folder as a reader has it: the source tree's documents and studies, programs, the drive of the first lesson.
struct Reader(tempfile::TempDir);

impl Reader {
    /// With these lines the program is run.
    fn new(opshock: &str) -> Reader {
        let at = tempfile::tempdir().unwrap();
        symlink(root().join("tests"), at.path().join("tests")).unwrap();
        // Commands write beside a study.
        for folder in ["docs", "studies"] {
            let mut copy = program("cp");
            let done = copy.arg("-r").arg(root().join(folder)).arg(at.path());
            assert!(done.status().unwrap().success());
        }
        let bin = at.path().join("target/release");
        fs::create_dir_all(&bin).unwrap();
        for (name, text) in [("opshock", opshock), ("make", MAKE), ("sbatch", SBATCH)] {
            let text = format!(
                "#!/bin/bash\nPROGRAM=\"{OPSHOCK}\" ROOT=\"{}\"\n{text}",
                root().display()
            );
            fs::write(bin.join(name), text).unwrap();
            let executable = fs::Permissions::from_mode(0o755);
            fs::set_permissions(bin.join(name), executable).unwrap();
        }
        let reader = Reader(at);
        reader.printed("opshock new > my-drive.toml");
        reader
    }

    /// Standard output of commands, by a shell.
    fn printed(&self, commands: &str) -> String {
        let path = format!(
            "{}/target/release:{}",
            self.0.path().display(),
            std::env::var("PATH").unwrap()
        );
        let mut shell = program("bash");
        let done = shell.args(["-ec", commands]).current_dir(self.0.path());
        let done = done
            .env("PATH", path)
            .env_remove("COLUMNS")
            .output()
            .unwrap();
        let errors = String::from_utf8(done.stderr).unwrap();
        assert!(done.status.success(), "{commands}\n{errors}");
        String::from_utf8(done.stdout).unwrap()
    }
}

/// As it is called. Exit code 4: some points are open, which the output says.
const AS_CALLED: &str = r#""$PROGRAM" "$@" || { code=$?; [ $code = 4 ] || exit $code; }"#;

/// What can take hours ends after a minute (exit code 5) unless it is done; a requirement may be failed (8).
const A_MINUTE: &str = r#"budget= allowed=4
case "$1" in
  sweep | match | worth | yield) budget="--budget 1m" allowed="4 5" ;;
  qualify) budget="--budget 1m" allowed="4 5 8" ;;
esac
case "$*" in *--budget*) set -- "${@/#7h30m/1m}" && set -- "${@/#8h/1m}" && budget= ;; esac
"$PROGRAM" "$@" $budget || { code=$?; case " $allowed " in *" $code "*) ;; *) exit $code ;; esac; }"#;

/// Whether the target is there: what it does has a time of its own.
const MAKE: &str = r#"exec env PATH="${PATH#*:}" make -n -C "$ROOT" "$@""#;

/// The tasks of an array job one after the other; `slurm.rs` submits to a Slurm.
const SBATCH: &str = r#"sed -i "s|$PROGRAM sweep|& --budget 1m|" "$1"
grep -q -- "--budget 1m" "$1" || exit 1
for task in 1 2 3 4; do SLURM_ARRAY_TASK_ID=$task bash "$1" || [ $? = 5 ] || exit 1; done"#;

/// Replays a page; the number of its commands.
fn replay(name: &str) -> usize {
    let page = page(name);
    let reader = Reader::new(AS_CALLED);
    let mut output = String::new();
    let mut n_commands = 0;
    for (kind, text) in blocks(&page) {
        match kind {
            "sh" if text.starts_with("target/release/opshock ") => {
                output = reader.printed(text);
                n_commands += 1;
            }
            "text" => {
                let lines: BTreeSet<&str> = output.lines().map(str::trim_end).collect();
                for line in text.lines().map(str::trim_end) {
                    assert!(lines.contains(line), "{name}: {line}\n{output}");
                }
            }
            "toml" => fs::write(reader.0.path().join("tolerances.toml"), text).unwrap(),
            _ => {}
        }
    }
    n_commands
}

/// What a reader has before a page's first command.
fn prepared(name: &str) -> &'static str {
    match name {
        "docs/import.md" => {
            "cp tests/reference/cml_decks/susp_* tests/reference/calculix/arm.* .
             cp tests/reference/cml_decks/rail_own_rectangular_abs.dat rail.dat
             cp tests/reference/cml_decks/dynluls_shock_400G_2ms_rigid.def DynLULS.def
             cp tests/bad_inputs/imports/cmlair/sound.run.dat run.dat
             for file in M K cords; do cp tests/bad_inputs/imports/dense/sound.$file.dat $file.dat; done
             opshock import matrices --mass arm.mas --stiffness arm.sti --dof arm.dof --units mm_n --contact 12.3 --out arm-si
             cp arm-si/mass.mtx arm.mass.mtx
             cp arm-si/stiffness.mtx arm.stiffness.mtx"
        }
        "docs/match.md" => "sed s:../fig13:studies/fig13: studies/paper-cases/study.toml > study.toml\ncp studies/paper-cases/match.toml ramp.match.toml",
        _ => "",
    }
}

/// The wheel in place of the path that stands for it.
fn with_wheel(text: &str) -> String {
    let Some((before, behind)) = text.split_once("/path/to/") else {
        return text.to_owned();
    };
    let wheel = fs::read_dir(root().join("target/wheels"))
        .expect("make wheel")
        .next();
    let (_, behind) = behind.split_once(".whl").unwrap();
    format!(
        "{before}{}{behind}",
        wheel.unwrap().unwrap().path().display()
    )
}

/// Runs the commands of a page; the number of its blocks.
fn run(name: &str) -> usize {
    let page = page(name);
    let reader = Reader::new(A_MINUTE);
    reader.printed(prepared(name));
    let mut n_blocks = 0;
    for (kind, text) in blocks(&page) {
        match kind {
            "toml" if text.starts_with("spec_format") => {
                fs::write(reader.0.path().join("spec.toml"), text).unwrap();
            }
            // The address is the reader's.
            "sh" if !text.starts_with("git clone URL") => {
                let text = with_wheel(text);
                reader.printed(&format!(
                    "{text}\nfor job in $(jobs -p); do wait $job; done"
                ));
                if name == "docs/your-own-drive.md" && text.contains("> my-drive.toml") {
                    drive_of(&page, reader.0.path());
                }
                n_blocks += 1;
            }
            _ => {}
        }
    }
    n_blocks
}

#[test]
fn the_first_shock_is_as_its_page_shows_it() {
    assert_eq!(replay("docs/first-shock.md"), 7);
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
        assert_eq!(
            replay(&format!("docs/lessons/{name}.md")),
            n_commands,
            "{name}"
        );
        println!("{name}: {n_commands} commands print what the page shows");
    }
}

/// README and all other pages of docs/, each for itself: some twenty minutes of two cores.
#[test]
#[ignore = "make verify-book"]
fn commands_of_all_pages_run() {
    let mut pages = vec!["README.md".to_string()];
    for file in fs::read_dir(root().join("docs")).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        if name.ends_with(".md") && !["first-shock.md", "commands.md"].contains(&name.as_str()) {
            pages.push(format!("docs/{name}"));
        }
    }
    pages.sort();
    let mut n_blocks = 0;
    for name in pages {
        let own = run(&name);
        n_blocks += own;
        if own > 0 {
            println!("{name}: the commands of {own} blocks run");
        }
    }
    assert_eq!(n_blocks, 56);
}
