//! `opshock match`: planted truths are kept, conflicts and shares are right, runs resume, bad input is reported.

use std::path::{Path, PathBuf};

use crate::cli::OPSHOCK;
use opshock_study::study::{Choice, Ramp, Sign, Study};
use opshock_tests::program::program;
use serde_json::Value;

pub(super) fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../studies")
        .join(name)
        .join("study.toml")
}

/// A match file beside its store, small enough for a second.
pub(super) fn small(folder: &Path, observations: &str) -> PathBuf {
    let shock = "shock = { ramp = \"rigid\", pulse_ms = 0.5, sign = \"+\", amplitude_g = 300.0 }";
    let text = format!(
        "match_format = 1\nname = \"small\"\nstudy = {:?}\n[draws]\ndisk_and_ramp = 40\n[waves]\ncount = 1\nsamples = 10\n\
         [refinement]\nevaluations = 12\nstarts = 1\n[numerics]\nprobes = 2\n[settings]\ndisk_and_ramp = \
         [\"resolution.preset=\\\"coarse\\\"\"]\n[[parameter]]\nname = \"gap\"\nkeys = [\"ramp.clearance_um\"]\nuniform = [60.0, \
         140.0]\nsource = \"test\"\n[[parameter]]\nname = \"contact\"\nkeys = [\"ramp.contact_stiffness_n_per_m\"]\n\
         log_uniform = [3e5, 1e7]\nunset_share = 0.5\nsource = \"test\"\n{}",
        shipped("paper-cases"),
        observations.replace("SHOCK", shock)
    );
    let file = folder.join("match.toml");
    std::fs::write(&file, text).expect("written");
    file
}

/// With a wider gap the disk moves farther: both cannot be.
pub(super) const TWO: &str = "[[observation]]\nname = \"near\"\noutput = \"run.disk.ramp_max_m\"\nSHOCK\nrange = [60e-6, 90e-6]\n\
    [[observation]]\nname = \"far\"\noutput = \"run.disk.ramp_max_m\"\nSHOCK\nrange = [110e-6, 130e-6]\n\
    [[observation]]\nname = \"ratio\"\nratio = [\"far\", \"near\"]\nrange = [1.0, 1.0]\n";

pub(super) fn matched(file: &Path, store: &Path, more: &[&str]) -> (Option<i32>, Value, String) {
    let output = program(OPSHOCK)
        .arg("match")
        .arg(file)
        .arg("--json")
        .arg("--store")
        .arg(store)
        .args(more)
        .output()
        .expect("the program runs");
    let json = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    (
        output.status.code(),
        json,
        String::from_utf8_lossy(&output.stderr).into_owned(),
    )
}

#[test]
fn conflicts_are_reported_with_their_bound() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = small(folder.path(), TWO);
    let (code, json, reported) = matched(&file, &folder.path().join("store"), &[]);
    assert_eq!(code, Some(0), "{reported}");
    assert_eq!(json["n_matching"], 0);
    let conflicts = json["conflicts"].as_array().expect("a list");
    let names: Vec<&Value> = conflicts.iter().map(|one| &one["observations"]).collect();
    assert_eq!(names, [&serde_json::json!(["near", "far"])]);
    // 1 - 0.05^(1/40) of 40 draws.
    let bound = conflicts[0]["share"]["interval"][1]
        .as_f64()
        .expect("a number");
    assert!((bound - (1.0 - 0.05_f64.powf(1.0 / 40.0))).abs() < 1e-12);
    // Each alone is had: the disk at the ramp comes some micrometres past the gap.
    for one in json["observations"]
        .as_array()
        .expect("a list")
        .iter()
        .take(2)
    {
        let with = one["share"]["with"].as_u64().expect("a count");
        assert!((5..30).contains(&with), "{one}");
    }
}

#[test]
fn an_interrupted_match_ends_with_the_same_bytes_on_any_threads() {
    let folder = tempfile::tempdir().expect("a folder");
    let one = TWO.split("[[observation]]").nth(1).expect("the first");
    let file = small(folder.path(), &format!("[[observation]]{one}"));
    let store = |name: &str| folder.path().join(name);
    let (code, whole, reported) = matched(&file, &store("whole"), &["-j", "1"]);
    assert_eq!(code, Some(0), "{reported}");
    assert!(whole["n_matching"].as_u64() > Some(0));
    let (code, ..) = matched(&file, &store("parts"), &["--budget", "0s"]);
    assert_eq!(code, Some(5));
    // Killed at several times, each run goes on where the last one ended.
    for milliseconds in [150, 300, 450] {
        let mut child = program(OPSHOCK)
            .arg("match")
            .arg(&file)
            .args(["--quiet", "--store"])
            .arg(store("parts"))
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .expect("started");
        std::thread::sleep(std::time::Duration::from_millis(milliseconds));
        let _ = child.kill();
        let _ = child.wait();
    }
    let (code, parts, reported) = matched(&file, &store("parts"), &["-j", "4"]);
    assert_eq!(code, Some(0), "{reported}");
    assert_eq!(parts, whole);
    // Nothing is left to simulate.
    let (_, again, reported) = matched(&file, &store("parts"), &[]);
    assert_eq!(again, whole);
    assert!(reported.contains("0 simulated"), "{reported}");
}

/// With searches for every conflict instead of a refinement.
pub(super) fn with_searches(file: &Path, searches: &str) {
    let text = std::fs::read_to_string(file).expect("read");
    let text = text.replacen(
        "[refinement]\nevaluations = 12",
        "[refinement]\nevaluations = 0",
        1,
    );
    std::fs::write(
        file,
        text.replacen("[numerics]", &format!("{searches}\n[numerics]"), 1),
    )
    .expect("written");
}

#[test]
fn conflicts_are_searched_for_a_set_that_disproves_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let searches = "[conflicts]\nsearches = 3\nevaluations = 90";
    let file = small(folder.path(), TWO);
    with_searches(&file, searches);
    let (code, json, reported) = matched(&file, &folder.path().join("store"), &[]);
    assert_eq!(code, Some(0), "{reported}");
    let conflict = &json["conflicts"][0];
    assert_eq!(conflict["observations"], serde_json::json!(["near", "far"]));
    // Three populations of six, and 90 children each.
    assert_eq!(
        (&conflict["searches"], &conflict["searched"]),
        (&3.into(), &288.into())
    );

    // A range of which the draws have a thousandth is no conflict: a search finds it.
    let thin = TWO.split("[[observation]]").nth(1).expect("the first");
    let thin = thin.replace("[60e-6, 90e-6]", "[85.00e-6, 85.05e-6]");
    let file = small(folder.path(), &format!("[[observation]]{thin}"));
    with_searches(&file, searches);
    let (code, json, reported) = matched(&file, &folder.path().join("thin"), &[]);
    assert_eq!(code, Some(0), "{reported}");
    assert_eq!(json["observations"][0]["share"]["with"], 0, "{json}");
    assert_eq!(json["conflicts"], serde_json::json!([]), "{reported}");
    assert!(json["n_matching"].as_u64() > Some(0));
}

/// A parameter with choices beside those of [`small`], each of which is refined by itself.
pub(super) fn with_choices(file: &Path, choices: &str, each: &str) {
    let text = std::fs::read_to_string(file).expect("read");
    let of_each = format!("starts = 1\neach = {each:?}\n");
    let text = text.replacen("starts = 1\n", &of_each, 1)
        + &format!("[[parameter]]\nname = \"pads\"\n{choices}\nsource = \"test\"\n");
    std::fs::write(file, text).expect("written");
}

#[test]
fn every_choice_of_a_parameter_has_a_search_of_its_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = small(folder.path(), TWO);
    let speeds = "keys = [\"disk.rpm\"]\nchoices = [4200, 5400, 7200]";
    with_choices(&file, speeds, "pads");
    let (code, json, reported) = matched(&file, &folder.path().join("store"), &[]);
    assert_eq!(code, Some(0), "{reported}");
    let choices = json["best_of_each"]["choices"].as_array().expect("a list");
    assert_eq!(choices.len(), 3);
    let place = json["parameters"].as_array().expect("a list").len() - 1;
    let mut tried = 0;
    for (row, speed) in choices.iter().zip(["4200", "5400", "7200"]) {
        assert_eq!(row[0], speed);
        tried += row[1].as_u64().expect("a count");
        assert_eq!(row[2]["values"][place], speed);
        // One of the two that contradict each other.
        assert_eq!(row[2]["fails"].as_array().map(Vec::len), Some(1), "{row}");
    }
    // 40 draws, 10 of the wave, the study's own values with each speed, and 12 of the refinement, some of which repeat others.
    assert!((57..=50 + 3 + 12).contains(&tried), "{tried}");
    // The study's first point has no ramp: its step is refined all the same.
    let near = &json["observations"][0];
    assert!(near["numerical_uncertainty"].as_f64() > Some(0.0), "{near}");
}

pub(super) fn with_weights(file: &Path, weights: &str) {
    let text = std::fs::read_to_string(file).expect("read");
    let text = text.replacen(
        "starts = 1\n",
        &format!("starts = 1\nweights = {weights}\n"),
        1,
    );
    std::fs::write(file, text).expect("written");
}

#[test]
fn of_two_that_contradict_each_other_the_one_with_more_weight_holds() {
    for (weights, lacks) in [("{ near = 3 }", "far"), ("{ far = 3 }", "near")] {
        let folder = tempfile::tempdir().expect("a folder");
        let file = small(folder.path(), TWO);
        with_weights(&file, weights);
        let (code, json, reported) = matched(&file, &folder.path().join("store"), &[]);
        assert_eq!(code, Some(0), "{reported}");
        assert_eq!(json["nearest"]["fails"], serde_json::json!([lacks]));
    }
}

#[test]
fn matching_studies_have_the_values_and_say_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let one = TWO.split("[[observation]]").nth(1).expect("the first");
    let file = small(folder.path(), &format!("[[observation]]{one}"));
    let out = folder.path().join("out");
    std::fs::create_dir(&out).expect("made");
    let of_before = |name: &str, text: &str| {
        let path = out.join(name);
        std::fs::write(&path, text).expect("written");
        path
    };
    let old = of_before(
        "matching-99.toml",
        "# match \"small\": every observation holds\n",
    );
    let own = of_before("matching-98.toml", "study_format = 2\n");
    let (code, json, reported) = matched(
        &file,
        &folder.path().join("store"),
        &["--out", out.to_str().expect("a path")],
    );
    assert_eq!(code, Some(0), "{reported}");
    // What an earlier match wrote goes, what somebody wrote stays.
    assert!(!old.exists() && own.exists());
    let first = out.join("matching-1.toml");
    let study = Study::from_path(&first, &[]).expect("a study");
    let text = std::fs::read_to_string(&first).expect("read");
    assert!(
        text.contains("# matched: gap = ") && text.contains("physics versions"),
        "{text}"
    );
    let shot = Choice {
        ramp: Some(Ramp::Rigid),
        pulse_ms: Some(0.5),
        sign: Some(Sign::Plus),
        amplitude_g: Some(200.0),
    };
    let scene = study.select(&shot).expect("a shock").point.scene;
    let gap_um: f64 = json["matching"][0]["values"][0]
        .as_str()
        .expect("text")
        .parse()
        .expect("a number");
    assert!((1e6 * scene.ramp.clearance_top_m - gap_um).abs() < 1e-9);
    for name in [
        "match.md",
        "match.html",
        "samples.csv",
        "ranges.svg",
        "ranges.png",
    ] {
        assert!(out.join(name).is_file(), "{name}");
    }
}

#[test]
fn a_store_of_another_match_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let one = TWO.split("[[observation]]").nth(1).expect("the first");
    let file = small(folder.path(), &format!("[[observation]]{one}"));
    let store = folder.path().join("store");
    assert_eq!(matched(&file, &store, &["--budget", "0s"]).0, Some(5));
    let other = folder.path().join("other.toml");
    std::fs::copy(&file, &other).expect("copied");
    let (code, _, reported) = matched(&other, &store, &[]);
    assert_eq!(code, Some(6));
    assert!(
        reported.contains("E188") && reported.contains("match.toml"),
        "{reported}"
    );
}

/// Every kind of output of a drive whose one free parameter does not touch it, against the commands that print it.
#[test]
fn outputs_are_those_of_the_commands() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let study = shipped("paper-cases").display().to_string();
    let coarse = [
        "resolution.film_cells=250",
        "resolution.film_correction_cells=0",
        "ramp.models=[\"none\"]",
        "pulse.widths_ms=[2.0]",
        "outputs=[\"critical_shock\", \"disk_displacement\"]",
        "search.tolerance_pct=5.0",
        "search.monotonicity_scan=\"off\"",
        "search.uncertainty=false",
    ];
    let run = |words: &[&str]| {
        let sets = coarse.iter().flat_map(|set| ["--set", set]);
        let output = program(OPSHOCK)
            .args(words)
            .args(sets)
            .arg("--json")
            .output()
            .expect("the program runs");
        let reported = String::from_utf8_lossy(&output.stderr).into_owned();
        serde_json::from_slice::<Value>(&output.stdout)
            .unwrap_or_else(|_| panic!("{words:?}: {reported}"))
    };
    let shock = [
        "--ramp",
        "none",
        "--pulse-ms",
        "2",
        "--sign",
        "+",
        "--amplitude-g",
        "400",
    ];
    let history = path("history.csv");
    run(&[&["run", &study, "--history", &history][..], &shock].concat());
    let measured: String = std::fs::read_to_string(&history)
        .expect("a history")
        .lines()
        .fold(String::new(), |all, line| {
            let cells: Vec<&str> = line.split(',').take(3).collect();
            all + &format!("{},{}\n", cells[0], cells[2])
        });
    assert!(
        measured.starts_with("time_s,disk_slider_m\n"),
        "{}",
        &measured[..60]
    );
    std::fs::write(path("tower.csv"), measured).expect("written");
    let (modes, steady) = (run(&["modes", &study]), run(&["steady", &study]));
    let swept = run(&["sweep", &study, "--store", &path("sweep")]);
    let wanted = [
        modes["disk"][1]["rotating_frame_hz"].as_f64(),
        steady["stiffness"][0][0].as_f64(),
        Some(0.0),
        swept["points"][0]["a_crit_g"].as_f64(),
    ];
    let own = "shock = { ramp = \"none\", pulse_ms = 2.0, sign = \"+\"";
    let text = format!(
        "match_format = 1\nname = \"outputs\"\nstudy = {study:?}\n[draws]\ndisk_and_ramp = 1\n[waves]\ncount = 0\n[refinement]\n\
         evaluations = 0\n[numerics]\nprobes = 0\n[settings]\ndisk_and_ramp = {coarse:?}\nsingle_shocks = {coarse:?}\n\
         critical_shocks = {coarse:?}\n[[parameter]]\nkeys = [\"ramp.clearance_um\"]\nuniform = [90.0, 110.0]\nsource = \
         \"test\"\n[[observation]]\nname = \"modes\"\noutput = \"modes.disk.1.rotating_frame_hz\"\n[[observation]]\nname = \
         \"steady\"\noutput = \"steady.stiffness.0.0\"\n[[observation]]\nname = \"history\"\nhistory = \"disk_slider_m\"\nfile = \
         \"tower.csv\"\n{own}, amplitude_g = 400.0 }}\nrange = [0.0, 1e-9]\n[[observation]]\nname = \"critical\"\n\
         critical_shock = true\n{own} }}\n"
    );
    let file = folder.path().join("match.toml");
    std::fs::write(&file, text).expect("written");
    let out = folder.path().join("out");
    let (code, json, reported) = matched(
        &file,
        &folder.path().join("store"),
        &["--out", out.to_str().expect("a path")],
    );
    assert_eq!(
        (code, &json["n_matching"]),
        (Some(0), &1.into()),
        "{reported}"
    );
    let samples = std::fs::read_to_string(out.join("samples.csv")).expect("samples");
    let last: Vec<&str> = samples
        .lines()
        .nth(1)
        .expect("a sample")
        .split(',')
        .collect();
    let found: Vec<Option<f64>> = last[2..].iter().map(|cell| cell.parse().ok()).collect();
    for (k, (found, wanted)) in found.iter().zip(wanted).enumerate() {
        let (found, wanted) = (found.expect("a number"), wanted.expect("a number"));
        // The command prints the history with as many digits as read back to the same bits.
        assert!(
            (found - wanted).abs() <= 1e-12 * wanted.abs() + 1e-20 * f64::from(u8::from(k == 2)),
            "{k}: {found} {wanted}"
        );
    }
}
