//! Every class of bad input: one file each under `tests/bad_inputs/`, named after the code it must
//! raise, with a snapshot of every message.

use std::path::{Path, PathBuf};

use crate::cli::{Done, opshock, study};
use opshock_study::study::film_memory::film_bytes;
use opshock_study::study::memory::Demand;
use opshock_study::study::{SetArg, Severity, Study, StudyErrors, check_threads};

/// Files in the order of their names. Paths are relative, so that messages are the same anywhere.
fn cases() -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir("bad_inputs")
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    files.sort();
    files
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap().to_str().unwrap().to_string()
}

/// Everything said about a study, and the codes.
fn said(result: &Result<Study, StudyErrors>) -> (String, Vec<&'static str>) {
    match result {
        Err(errors) => (
            errors.to_string(),
            errors.errors.iter().map(|error| error.code).collect(),
        ),
        Ok(study) => (
            study
                .remarks
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
                .join("\n"),
            study.remarks.iter().map(|remark| remark.code).collect(),
        ),
    }
}

#[test]
fn every_file_gets_its_message() {
    let files = cases();
    assert!(files.len() >= 100, "only {} files", files.len());
    insta::with_settings!({
        snapshot_path => "../bad_inputs/messages",
        prepend_module_to_snapshot => false,
        omit_expression => true,
    }, {
        for path in files {
            let (text, codes) = said(&Study::from_path(&path, &[]));
            let name = stem(&path);
            let code = name.split('_').next().unwrap().to_uppercase();
            if code.len() == 4 && code[1..].bytes().all(|digit| digit.is_ascii_digit()) {
                assert!(codes.iter().any(|found| *found == code), "{name}: {codes:?}\n{text}");
            }
            insta::assert_snapshot!(name, text);
        }
    });
}

#[test]
fn a_file_made_for_one_error_raises_no_other() {
    let several = [
        "many_faults_at_once",
        "more_than_fifty_faults",
        "e130_negative_everything",
        "e156_negative_range",
        "e110_in_the_surface",
        "e103_three_faults",
        "e110_keys_of_format_1",
    ];
    for path in cases() {
        let name = stem(&path);
        let (text, codes) = said(&Study::from_path(&path, &[]));
        if !several.contains(&name.as_str()) {
            assert!(
                codes.windows(2).all(|pair| pair[0] == pair[1]),
                "{name}: {codes:?}\n{text}"
            );
        }
    }
}

#[test]
fn every_error_names_file_and_line_and_says_what_is_allowed() {
    for path in cases() {
        let Err(errors) = Study::from_path(&path, &[]) else {
            continue;
        };
        for error in &errors.errors {
            let whole_file = ["E101", "E104"].contains(&error.code);
            assert!(error.line > 0 || whole_file, "{error}");
            assert!(error.file.starts_with("bad_inputs/"), "{error}");
            assert!(!error.allowed.is_empty() || error.code == "E103", "{error}");
            assert_eq!(error.severity(), Severity::Error);
            let json = error.to_json();
            for field in ["code", "file", "line", "key", "value", "allowed", "hint"] {
                assert!(json.get(field).is_some(), "{field}");
            }
        }
        let lines: Vec<usize> = errors
            .errors
            .iter()
            .filter(|error| error.file == path.to_str().unwrap())
            .map(|error| error.line)
            .collect();
        assert!(lines.is_sorted(), "{}: {lines:?}", path.display());
    }
}

#[test]
fn the_terminal_form_shows_the_line_and_a_caret() {
    let errors =
        Study::from_path(Path::new("bad_inputs/e130_negative_thickness.toml"), &[]).unwrap_err();
    insta::assert_snapshot!(errors.to_terminal(90, false));
    assert!(errors.to_terminal(90, true).contains('\u{1b}'));
}

#[test]
fn json_has_the_fields_of_the_contract() {
    let errors =
        Study::from_path(Path::new("bad_inputs/e113_text_for_number.toml"), &[]).unwrap_err();
    insta::assert_snapshot!(serde_json::to_string_pretty(&errors.to_json()).unwrap());
}

#[test]
fn what_is_no_text_file_is_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let refused = |path: &Path| {
        let errors = Study::from_path(path, &[]).unwrap_err();
        assert_eq!(errors.errors.len(), 1);
        errors.errors[0].clone()
    };

    assert_eq!(refused(folder.path()).code, "E105");
    assert!(refused(folder.path()).message.contains("directory"));
    assert_eq!(refused(&at("absent.toml")).code, "E105");
    assert!(refused(&at("absent.toml")).message.contains("no such file"));

    std::fs::write(at("utf16.toml"), [0xFF, 0xFE, b'a', 0, b'=', 0]).unwrap();
    let utf16 = refused(&at("utf16.toml"));
    assert_eq!(
        (utf16.code, utf16.message.as_str()),
        ("E102", "not UTF-8 at byte 0")
    );
    assert!(utf16.hint.contains("UTF-16"));
    std::fs::write(at("latin1.toml"), b"study_format = 2\nname = \"\xb5m\"\n").unwrap();
    let latin = refused(&at("latin1.toml"));
    assert_eq!(
        (latin.code, latin.line, latin.message.as_str()),
        ("E102", 2, "not UTF-8 at byte 25")
    );

    std::fs::File::create(at("huge.toml"))
        .unwrap()
        .set_len(2 << 30)
        .unwrap();
    assert_eq!(refused(&at("huge.toml")).code, "E104");

    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(at("b.toml"), at("a.toml")).unwrap();
        std::os::unix::fs::symlink(at("a.toml"), at("b.toml")).unwrap();
        let looped = refused(&at("a.toml"));
        assert_eq!(looped.code, "E106");
        assert!(looped.hint.contains("a.toml -> "), "{looped}");
        // A FIFO nobody writes to would block a reader that opens it.
        let fifo = at("fifo.toml");
        let made = std::process::Command::new("mkfifo").arg(&fifo).status();
        assert!(made.expect("mkfifo").success());
        assert_eq!(refused(&fifo).code, "E105");
    }
}

const SHORT: &str = "study_format = 2\nname = \"short\"\n[pulse]\nwidths_ms = [2.0]\n[ramp]\nmodels = [\"rigid\"]\n[disk]\nrpm = 5400.0\n";

#[test]
fn set_arguments_are_checked_like_the_file() {
    let cases: [&[&str]; 12] = [
        &["disk.rpm=5400", "disk.rpm=7200"],
        &[
            "disk.damping={ modal_ratio = 0.004 }",
            "disk.damping.modal_ratio=0.005",
        ],
        &["disk.rmp=5400"],
        &["disks.rpm=5400"],
        &["disk.rpm=fast"],
        &["disk.rpm=nan"],
        &["disk.thickness_mm=-1"],
        &["disk.rpm.x=1"],
        &["ramp.radius_mm=50"],
        &["outputs=[\"min_clearance\", \"nothing\"]"],
        &["ramp.deformable.modes=[{ frequency_hz = 888.0 }]"],
        &["pulse.widths_ms=[0.5, 2.0"],
    ];
    let mut text = String::new();
    for case in cases {
        let sets: Vec<SetArg> = case.iter().map(|set| SetArg::parse(set).unwrap()).collect();
        text.push_str(&format!("{}\n", case.join("   ")));
        text.push_str(&format!(
            "    {}\n",
            said(&Study::from_text(SHORT, &sets))
                .0
                .replace('\n', "\n    ")
        ));
    }
    insta::assert_snapshot!(text);
}

#[test]
fn bad_set_syntax_is_a_command_line_error() {
    let mut text = String::new();
    for argument in [
        "disk.rpm",
        "=5400",
        "disk.rpm=",
        "disk..rpm=1",
        "disk rpm=1",
        "modes[x]=1",
        "",
        "\u{b5}m=1",
    ] {
        text.push_str(&format!("{}\n", SetArg::parse(argument).unwrap_err()));
    }
    insta::assert_snapshot!(text);
}

#[test]
fn threads_are_limited() {
    assert_eq!(check_threads(1).unwrap(), 1);
    assert_eq!(check_threads(4096).unwrap(), 4096);
    for threads in [0, -1, 4097, i64::MAX] {
        assert_eq!(check_threads(threads).unwrap_err().code, "E185");
    }
}

/// A film of 10 000 cells, beside what every thread takes, is 75 MB a worker.
#[test]
fn a_sweep_that_does_not_fit_into_the_memory_is_refused_before_it_starts() {
    let demand = Demand {
        film: film_bytes(10_000.0),
        ..Demand::default()
    };
    let worker = demand.bytes(1);
    assert!((worker / 75e6 - 1.0).abs() < 1e-9);
    assert!(demand.check("it", 5, 5.0 * worker).is_ok());
    let fault = demand.check("it", 6, 5.0 * worker).unwrap_err();
    let fault = fault.to_json()["errors"][0].clone();
    assert_eq!(fault["code"], "E186");
    assert_eq!(fault["hint"], "-j 5 fits");
    let folder = tempfile::tempdir().unwrap();
    let path = study("fig13").canonicalize().unwrap();
    let sweep = |gigabytes: &str, refinements: &str| {
        let file = path.to_str().unwrap();
        let size = "resolution.film_cells=10000";
        let refinements = format!("search.max_refinements={refinements}");
        let asked = [
            "sweep",
            file,
            "--set",
            size,
            "--set",
            &refinements,
            "-j",
            "3",
            "--memory-gb",
            gigabytes,
            "--json",
        ];
        Done::of(folder.path(), &asked)
    };
    // Films of twice the cells, 20 000, take 0.14 GB a worker; one refinement may make it 80 000, which take 1.1 GB.
    for (gigabytes, refinements) in [("0.4", "0"), ("0.01", "0"), ("3.3", "1")] {
        let refused = sweep(gigabytes, refinements);
        assert_eq!(refused.code, 3, "{}", refused.stderr);
        assert_eq!(refused.errors()[0]["code"], "E186");
    }
    assert_eq!(sweep("none", "0").code, 2);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn warnings_stop_a_batch_run_until_accepted_by_code() {
    let study = Study::from_path(Path::new("bad_inputs/w201_magnitudes.toml"), &[]).unwrap();
    assert_eq!(study.unaccepted(&[]).len(), 4);
    assert_eq!(study.unaccepted(&["W202".to_string()]).len(), 4);
    assert!(study.unaccepted(&["W201".to_string()]).is_empty());
    let touching =
        Study::from_path(Path::new("bad_inputs/n143_touching_at_rest.toml"), &[]).unwrap();
    assert!(touching.unaccepted(&[]).is_empty());
    assert_eq!(touching.remarks.len(), 1);
}

#[test]
fn the_program_refuses_every_file_with_exit_code_3_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for path in cases().iter().filter(|path| stem(path).starts_with('e')) {
        let study = path.canonicalize().unwrap();
        let done = Done::of(folder.path(), &["check", study.to_str().unwrap(), "--json"]);
        let name = stem(path);
        assert_eq!(done.code, 3, "{name}: {}", done.stderr);
        let code = name.split('_').next().unwrap().to_uppercase();
        assert!(
            done.errors().iter().any(|error| error["code"] == *code),
            "{name}: {}",
            done.stderr
        );
        assert_eq!(done.stdout, "", "{name}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_locale_with_decimal_comma_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = study("fig13").canonicalize().unwrap();
    let said = |locale: &str| {
        let output = opshock(folder.path())
            .args(["check", path.to_str().unwrap(), "--json"])
            .env("LC_ALL", locale)
            .env("LANG", locale)
            .output()
            .unwrap();
        assert!(output.status.success());
        output.stdout
    };
    assert_eq!(said("C"), said("de_DE.UTF-8"));
}
