//! `opshock qualify`: specification files, verdicts, and the program from a specification to its files and exit codes.

use std::path::{Path, PathBuf};

use opshock_study::qualification::{Open, PointVerdict, Requirement, Spec, Verdict};
use opshock_study::report::qualified::{Qualified, Tested, csv, json, junit};
use opshock_study::search::{Flag, Sign};
use opshock_study::store::summary::{PointSummary, Status, Summary, Totals};
use opshock_study::store::{AxisValue, load};
use opshock_study::study::{SetArg, Study};

use crate::cli::{COARSE, Done};
use crate::refused::every_file_is_refused;

/// The smallest useful study in a folder.
fn drive(folder: &Path) -> PathBuf {
    let file = folder.join("drive.toml");
    std::fs::write(&file, Study::example("my drive")).expect("written");
    file
}

#[test]
fn every_damaged_specification_gets_its_message() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = drive(folder.path());
    every_file_is_refused("specs", 42, |path| Spec::from_path(path, &study, &[]).err());
}

const GOOD: &str = r#"
spec_format = 1
name = "operating shock"
source = "a data sheet"

[[requirement]]
name = "400 G, 2 ms"
amplitude_g = 400
margin_pct = 10.0
widths_ms = [2.0]
altitude_m = [0, 3000]
clearance_nm = 0.6

[[requirement]]
name = "fast"
amplitude_g = 250
signs = ["-"]
set = ["disk.rpm=7200"]
"#;

fn good(folder: &Path, sets: &[&str]) -> Spec {
    let file = folder.join("spec.toml");
    std::fs::write(&file, GOOD).expect("written");
    let sets: Vec<SetArg> = sets.iter().map(|set| set.parse().expect("a set")).collect();
    Spec::from_path(&file, &drive(folder), &sets).expect("a specification")
}

#[test]
fn a_requirement_is_the_study_with_its_own_pulses_and_a_search_about_its_amplitude() {
    let folder = tempfile::tempdir().expect("a folder");
    let sets = [
        "pulse.widths_ms=[0.7]",
        "ramp.models=[\"rigid\"]",
        "search.added_points.tolerance_pct=5",
        "search.amplitude_g.max=300",
    ];
    let spec = good(folder.path(), &sets);
    let [first, second] = spec.requirements.as_slice() else {
        panic!("{} requirements", spec.requirements.len())
    };
    assert!((first.required_g() - 440.0).abs() < 1e-9);
    let search = |one: &Requirement| {
        let search = &one.study.search;
        let required_g = search.required_amplitude_g.expect("an amplitude");
        [search.amplitude_min_g, required_g, search.amplitude_max_g].map(f64::round)
    };
    // From the study's own start, to four times what is required.
    assert_eq!(search(first), [20.0, 440.0, 1760.0]);
    assert_eq!(search(second), [20.0, 250.0, 1000.0]);
    assert!(first.study.search.added_points.is_none());
    // The requirement's widths and altitudes, both signs, the ramp of the command line.
    assert_eq!(first.study.widths_ms, [2.0]);
    assert_eq!(first.study.points.len(), 4);
    // Pressures of the standard atmosphere (ISO 2533): 101325 and 70109 Pa.
    let pressures = first
        .study
        .points
        .iter()
        .map(|point| point.scene.gas.pressure_pa);
    let mut pressures: Vec<f64> = pressures.map(f64::round).collect();
    pressures.sort_by(f64::total_cmp);
    pressures.dedup();
    assert_eq!(pressures.len(), 2);
    assert!((pressures[0] - 70_109.0).abs() < 20.0, "{pressures:?}");
    // A half-sine changes the velocity by 2 A T / pi.
    for (one, width_s) in [(first, 2e-3), (second, 0.7e-3)] {
        let expected = 2.0 * one.required_g() * 9.80665 * width_s / std::f64::consts::PI;
        for change in one.velocity_changes_m_per_s() {
            assert!(
                (change / expected - 1.0).abs() < 1e-12,
                "{change} {expected}"
            );
        }
    }
    assert_eq!(second.study.widths_ms, [0.7]);
    assert_eq!(second.study.signs, [Sign::Minus]);
    let rpm = second.study.resolved_toml();
    assert!(rpm.contains("rpm = 7200"), "{rpm}");
}

/// A row at 2 ms: status, reported value and half-width, bracket, flags.
fn row(status: Status, found: [Option<f64>; 4], flags: &[Flag], sign: Sign) -> PointSummary {
    let [a_crit_g, uncertainty_g, survived_g, failed_g] = found;
    PointSummary {
        ramp: "rigid".into(),
        pulse_ms: 2.0,
        sign,
        axes: vec![AxisValue::Number(0.0)],
        a_crit_g,
        uncertainty_g,
        half_min_height_g: None,
        survived_g,
        failed_g,
        contributions: vec![],
        levels: String::new(),
        onset_g: None,
        runs: 7,
        status,
        flags: flags.to_vec(),
        brackets_g: vec![],
        scanned_from_g: None,
        largest_gap_pct: None,
    }
}

#[test]
fn a_point_passes_or_fails_only_where_its_whole_interval_does() {
    let ok = |value_g: f64, half_g: Option<f64>, flags: &[Flag]| {
        let bracket = [0.99, 1.01].map(|share| Some(share * value_g));
        let found = [Some(value_g), half_g, bracket[0], bracket[1]];
        row(Status::Ok, found, flags, Sign::Plus)
    };
    let half = Some(10.0);
    let (passes, fails, undecided) = (Verdict::Passes, Verdict::Fails, Verdict::Undecided);
    let cases = [
        (ok(430.0, half, &[]), passes, None),
        // The lower end survives, the upper end fails.
        (ok(410.0, half, &[]), passes, None),
        (ok(409.9, half, &[]), undecided, Some(Open::Interval)),
        (ok(390.1, half, &[]), undecided, Some(Open::Interval)),
        (ok(390.0, half, &[]), fails, None),
        // A longer time can only find an earlier failure.
        (
            ok(430.0, half, &[Flag::Window]),
            undecided,
            Some(Open::Window),
        ),
        (
            ok(430.0, half, &[Flag::WindowUndecided]),
            undecided,
            Some(Open::Window),
        ),
        (ok(370.0, half, &[Flag::Window]), fails, None),
        (
            ok(700.0, half, &[Flag::ContributionMissing]),
            undecided,
            Some(Open::Contribution),
        ),
        (
            ok(430.0, half, &[Flag::SafetyFactor3, Flag::TargetNotMet]),
            passes,
            None,
        ),
        // Flags that take nothing from the verdict, and one that does.
        (
            ok(
                430.0,
                half,
                &[Flag::NonMonotone, Flag::Retry, Flag::NoTouch],
            ),
            passes,
            None,
        ),
        (
            ok(430.0, half, &[Flag::UndecidedAmplitude]),
            undecided,
            Some(Open::Amplitude),
        ),
        (ok(370.0, half, &[Flag::UndecidedAmplitude]), fails, None),
        // A bracket alone is no interval, and enough at a quarter of what is required or less.
        (ok(430.0, None, &[]), undecided, Some(Open::NoInterval)),
        (ok(105.0, None, &[]), undecided, Some(Open::NoInterval)),
        (ok(95.0, None, &[]), fails, None),
        (
            row(
                Status::AboveRange,
                [None, None, Some(799.0), None],
                &[],
                Sign::Plus,
            ),
            passes,
            None,
        ),
        (
            row(
                Status::BelowRange,
                [None, None, None, Some(201.0)],
                &[],
                Sign::Plus,
            ),
            fails,
            None,
        ),
        (
            row(
                Status::Undecided,
                [None, None, Some(300.0), Some(500.0)],
                &[],
                Sign::Plus,
            ),
            undecided,
            Some(Open::NoAnswer),
        ),
        (
            row(Status::Open, [None; 4], &[], Sign::Plus),
            undecided,
            Some(Open::NoAnswer),
        ),
    ];
    for (row, verdict, open) in cases {
        let found = PointVerdict::of(&row, 400.0);
        assert_eq!((found.verdict, found.open), (verdict, open), "{row:?}");
    }
    assert_eq!(Verdict::of_all([passes, undecided, fails]), fails);
    assert_eq!(Verdict::of_all([passes, undecided]), undecided);
    assert_eq!(Verdict::of_all([]), undecided);
}

#[test]
fn margins_reasons_and_counts_are_those_of_the_rows_in_every_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = good(folder.path(), &["ramp.models=[\"rigid\"]"]);
    let table = |points: Vec<PointSummary>| Summary {
        study: "s".into(),
        digest: "d".into(),
        axes: vec!["gas.altitude_m".into()],
        totals: Totals::of(&points, []),
        points,
    };
    let found = [Some(451.0), Some(11.0), Some(449.0), Some(453.0)];
    let close = [Some(435.0), Some(11.0), Some(433.0), Some(437.0)];
    let first = table(vec![
        row(Status::Ok, found, &[], Sign::Plus),
        row(Status::Ok, close, &[Flag::TargetNotMet], Sign::Minus),
    ]);
    let low = [None, None, None, Some(126.0)];
    let second = table(vec![row(Status::BelowRange, low, &[], Sign::Minus)]);
    let qualified = Qualified {
        study: "my <drive>",
        drive: "drive.toml",
        program: "opshock",
        spec: &spec,
        tested: vec![
            Tested::of(&spec.requirements[0], &first),
            Tested::of(&spec.requirements[1], &second),
        ],
        boundary: None,
    };
    assert_eq!(qualified.verdict(), Verdict::Fails);
    let sentences = qualified.sentences();
    assert_eq!(
        sentences,
        [
            "my <drive> fails \"operating shock\": 1 of 3 points does not survive, the numerical uncertainty included; 1 more left undecided.",
            "The point that decides is rigid ramp, 2 ms, sign \u{2212}, gas.altitude_m = 0 at \"fast\": a critical shock of less than 126.0 G \
             where 250.0 G are required, a reserve of less than -124.0 G, -49.6 %.",
            "The verdict on 1 point rests on a bound of four times or a quarter of what is required, without an uncertainty interval.",
        ]
    );
    let json = json(&qualified);
    assert_eq!(json["verdict"], "fails");
    let points = &json["requirements"][0]["points"];
    assert_eq!(points[0]["verdict"], "passes");
    assert_eq!(points[0]["interval_g"], serde_json::json!([440.0, 462.0]));
    assert_eq!(points[1]["reason"], "interval");
    let margin = points[1]["reserve_pct"].as_f64().expect("a number");
    assert!((margin + 100.0 * 5.0 / 440.0).abs() < 1e-9, "{margin}");
    // Below the range the interval begins at zero; above it, it has no end.
    assert_eq!(
        json["requirements"][1]["points"][0]["interval_g"],
        serde_json::json!([0.0, 126.0])
    );
    // Without the one that fails: what is open, and why.
    let open = Qualified {
        tested: qualified.tested[..1].to_vec(),
        ..qualified.clone()
    };
    assert_eq!(open.verdict(), Verdict::Undecided);
    // 435 +- 11 G where 440 are required.
    let said = &open.sentences()[1];
    assert!(
        said.ends_with("a reserve of -5.0 G, -1.1 % (-3.6 to +1.4 %)."),
        "{said}"
    );
    assert_eq!(
        open.sentences()[2..],
        [
            "Undecided at \"400 G, 2 ms\", rigid ramp, 2 ms, sign \u{2212}, gas.altitude_m = 0: its uncertainty interval contains the required \
          amplitude."
        ]
    );
    insta::assert_snapshot!("qualification_junit", junit(&qualified));
    insta::assert_snapshot!("qualification_csv", csv(&qualified));
}

fn qualify(folder: &Path, spec: &str, more: &[&str]) -> Done {
    std::fs::write(folder.join("spec.toml"), spec).expect("written");
    let mut words = vec!["qualify", "drive.toml", "--spec", "spec.toml", "--json"];
    words.extend(["--quiet", "--set", "ramp.models=[\"rigid\"]"]);
    words.extend([
        "--set",
        "pulse.widths_ms=[0.5]",
        "--set",
        "pulse.signs=[\"+\"]",
    ]);
    words.extend(["--set", "search.tolerance_pct=5"]);
    words.extend(COARSE);
    words.extend(more);
    Done::of(folder, &words)
}

#[test]
fn the_program_passes_fails_or_leaves_open_by_its_exit_code_and_goes_on_where_it_stopped() {
    let root = tempfile::tempdir().expect("a folder");
    let folder = root.path();
    drive(folder);
    let spec = |name: &str, amplitude_g: f64| {
        format!(
            "spec_format = 1\nname = \"s\"\n[[requirement]]\nname = \"{name}\"\namplitude_g = {amplitude_g:?}\n"
        )
    };
    let done = qualify(folder, &spec("low", 50.0), &["--out", "out"]);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    let low = done.json();
    assert_eq!(low["verdict"], "passes");
    assert_eq!(low["requirements"][0]["points"][0]["status"], "above_range");
    for file in ["md", "csv", "json", "xml", "html"] {
        assert!(
            folder.join(format!("out/qualification.{file}")).is_file(),
            "{file}"
        );
    }
    // Its store is one as any other.
    let report = Done::of(folder, &["report", "drive.qualify/s/low", "--json"]);
    assert_eq!(report.json()["points"], {
        let mut points = low["requirements"][0]["points"].clone();
        for point in points.as_array_mut().expect("points") {
            let point = point.as_object_mut().expect("a point");
            for key in ["verdict", "reason", "interval_g", "reserve_pct"] {
                point.remove(key);
            }
        }
        points
    });
    let runs = || {
        let (loaded, _) = load(&folder.join("drive.qualify/s/low")).expect("a store");
        loaded.runs.len()
    };
    let before = runs();
    let again = qualify(folder, &spec("low", 50.0), &[]);
    assert_eq!(again.json()["requirements"], low["requirements"]);
    assert_eq!(runs(), before);

    let done = qualify(folder, &spec("high", 20_000.0), &[]);
    assert_eq!(done.code, 8, "{}{}", done.stdout, done.stderr);
    assert_eq!(done.json()["requirements"][0]["failing_points"], 1);

    // At the critical shock itself nothing can be said.
    let none = ["--max-refinements", "0"];
    let mut amplitudes_g = (0..5).map(|k| 300.0 * 2f64.powi(k));
    let near = amplitudes_g.find_map(|amplitude_g| {
        let name = format!("{amplitude_g} G");
        let found = qualify(folder, &spec(&name, amplitude_g), &none).json();
        let point = found["requirements"][0]["points"][0].clone();
        point["uncertainty_g"].is_number().then_some(point)
    });
    let near = near.expect("a critical shock below 9600 G");
    let critical_g = near["a_crit_g"].as_f64().expect("a critical shock");
    let done = qualify(folder, &spec("at it", critical_g), &none);
    assert_eq!(done.code, 4, "{}{}", done.stdout, done.stderr);
    assert_eq!(done.json()["requirements"][0]["undecided_points"], 1);

    // A damage boundary beside it: critical shocks of its own, short pulses up to far higher amplitudes.
    let boundary = "\n[damage_boundary]\nwidths_ms = [0.05, 0.2, 0.8]\n";
    let both = spec("low", 50.0) + boundary;
    let done = qualify(folder, &both, &["--max-refinements", "0", "--out", "both"]);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    let found = &done.json()["damage_boundary"];
    let points = found["points"].as_array().expect("points");
    assert_eq!(points.len(), 3);
    for point in points {
        let end = |key: &str| point[key][1].as_f64().expect(key);
        let width_s = 1e-3 * point["pulse_ms"].as_f64().expect("a width");
        let per_g = 9.80665 * 2.0 * width_s / std::f64::consts::PI;
        let ratio = end("velocity_change_m_per_s") / (per_g * end("amplitude_g"));
        assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
    }
    let critical = found["critical_velocity_change_m_per_s"]["interval"][1].as_f64();
    let critical = critical.expect("a velocity change");
    assert!(points.iter().all(|point| {
        point["velocity_change_m_per_s"][1]
            .as_f64()
            .expect("an end")
            >= critical
    }));
    let csv = std::fs::read_to_string(folder.join("both/damage_boundary.csv")).expect("written");
    assert_eq!(csv.lines().count(), 4, "{csv}");

    // A store of a sweep is no folder of stores.
    let inside = ["--store", "drive.qualify/s/low"];
    let done = qualify(folder, &spec("x", 50.0), &inside);
    assert_eq!(done.code, 2, "{}{}", done.stdout, done.stderr);
    assert_eq!(done.errors()[0]["key"], "--store");

    // A fault of the specification is found before anything is written.
    let done = qualify(folder, &spec("../x", 50.0), &[]);
    assert_eq!(done.code, 3, "{}{}", done.stdout, done.stderr);
    assert_eq!(done.errors()[0]["code"], "E194");
    assert!(!folder.join("x").exists());
}
