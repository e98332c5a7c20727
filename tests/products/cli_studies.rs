//! `new`, `check`, `schema`, `modes`: commands that read a study and write nothing.

use super::cli::{Done, files, study};
use std::path::Path;

fn new_study(folder: &Path) {
    let done = Done::of(folder, &["new", "a drive"]);
    assert_eq!(done.code, 0);
    std::fs::write(folder.join("s.toml"), done.stdout).unwrap();
}

#[test]
fn a_new_study_is_valid() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let done = Done::of(folder.path(), &["check", "s.toml"]);
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    assert!(
        done.stdout.starts_with("a drive: valid\n"),
        "{}",
        done.stdout
    );
}

#[test]
fn the_studies_of_the_repository_are_valid() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["fig13", "paper-cases", "drive-2.5in"] {
        let path = study(name);
        let done = Done::of(folder.path(), &["check", path.to_str().unwrap()]);
        assert_eq!(done.code, 0, "{name}: {}", done.stderr);
    }
}

#[test]
fn check_writes_out_every_default_and_that_reads_back_to_the_same_digest() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let resolved = Done::of(folder.path(), &["check", "s.toml", "--resolved"]);
    std::fs::write(folder.path().join("r.toml"), &resolved.stdout).unwrap();
    let digest = |file: &str| {
        let report = Done::of(folder.path(), &["check", file, "--json"]).json();
        report["digest"].as_str().expect("a digest").to_owned()
    };
    assert_eq!(digest("s.toml"), digest("r.toml"));
}

#[test]
fn set_reaches_root_keys_nested_keys_and_lists_and_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let done = Done::of(
        folder.path(),
        &[
            "check",
            "s.toml",
            "--json",
            "--set",
            "disk.rpm=7200",
            "--set",
            "name=another",
            "--set",
            "outputs=[\"disk_displacement\"]",
            "--set",
            "ramp.clearance_um=[60, 80]",
            "--set",
            "ramp.deformable.modes=[{ frequency_hz = 900.0, mass_mg = 50.0, participation = 0.2 }]",
        ],
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let report = done.json();
    assert_eq!(report["study"], "another");
    assert_eq!(
        report["axes"]["ramp.clearance_um"].as_array().map(Vec::len),
        Some(2)
    );
    let resolved = report["resolved"].as_str().unwrap();
    assert!(resolved.contains("rpm = 7200.0") && resolved.contains("frequency_hz = 900.0"));
    assert_eq!(report["overrides"].as_array().map(Vec::len), Some(5));
}

#[test]
fn a_set_that_is_no_assignment_is_exit_2_and_a_wrong_key_or_value_exit_3() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    for (set, code) in [
        ("disk.rpm", 2),
        ("=1", 2),
        ("disk.rpm=", 2),
        ("disk.rpmm=5400", 3),
        ("disk.rpm=fast", 3),
        ("disk.thickness_mm=-1", 3),
    ] {
        let done = Done::of(folder.path(), &["check", "s.toml", "--set", set]);
        assert_eq!(done.code, code, "{set}: {}", done.stderr);
        assert!(
            done.stdout.is_empty() && done.stderr.contains(set.split('=').next().unwrap()),
            "{set}"
        );
    }
}

#[test]
fn faults_are_reported_all_at_once_with_their_place_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let path = folder.path().join("s.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let text = text.replace("rpm = 5400.0", "rpmm = 5400.0\nthickness_mm = -0.5");
    std::fs::write(&path, text).unwrap();
    for command in ["check", "modes"] {
        let done = Done::of(folder.path(), &[command, "s.toml", "--json"]);
        assert_eq!(done.code, 3);
        assert!(done.stdout.is_empty());
        let errors = done.errors();
        let of = |key: &str| errors.iter().find(|e| e["key"] == key).expect(key).clone();
        let unknown = of("disk.rpmm");
        for key in ["code", "file", "line", "key", "value", "allowed", "hint"] {
            assert!(!unknown[key].is_null(), "{key}");
        }
        assert!(unknown["hint"].as_str().unwrap().contains("rpm"));
        assert_eq!(of("disk.thickness_mm")["value"], "-0.5");
        // The same for a person: one line each, with file and line.
        let reported = Done::of(folder.path(), &[command, "s.toml"]);
        assert!(
            reported.stderr.contains("s.toml:") && reported.stderr.contains("did you mean rpm?")
        );
    }
    assert_eq!(files(folder.path()), [path]);
}

#[test]
fn schema_is_json_schema_with_the_units() {
    let folder = tempfile::tempdir().unwrap();
    let schema = Done::of(folder.path(), &["schema"]).json();
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
    assert!(schema["properties"]["disk"]["properties"]["rpm"].is_object());
    let units = Done::of(folder.path(), &["schema", "--units"]);
    for unit in ["_ms:", "_g:", "_um:", "_n_per_m:"] {
        assert!(
            units.stdout.lines().any(|line| line.starts_with(unit)),
            "{unit}"
        );
    }
}

#[test]
fn modes_have_the_documented_keys_and_the_waves_of_a_spinning_disk() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let modes = Done::of(folder.path(), &["modes", "s.toml", "--json"]).json();
    let disk = modes["disk"].as_array().unwrap();
    assert!(disk.len() > 10);
    for mode in disk {
        let number = |key: &str| mode[key].as_f64().unwrap_or_else(|| panic!("{key}"));
        let turn = number("nodal_diameters") * 5400.0 / 60.0;
        assert!((number("forward_hz") - number("rotating_frame_hz") - turn).abs() < 1e-9);
        assert!((number("rotating_frame_hz") - number("backward_hz") - turn).abs() < 1e-9);
        assert!(number("damping_ratio") > 0.0 && number("nodal_circles") >= 0.0);
    }
    assert_eq!(
        modes["ramp"].as_array().map(Vec::len),
        Some(4),
        "two modes for each arm"
    );
    let pinned = modes["suspension"]["bending_pinned_hz"][0]
        .as_f64()
        .unwrap();
    assert!((pinned - 2000.0).abs() < 10.0, "{pinned}");

    // Slider free on its film: two modes near 150 kHz as in the reference (142 and 155 kHz on 2162
    // cells) and one at 424 kHz, where fine grids agree (the reference's own has 401).
    let head: Vec<f64> = modes["head"]
        .as_array()
        .unwrap()
        .iter()
        .map(|mode| mode["frequency_hz"].as_f64().unwrap())
        .collect();
    for (found, converged) in head.iter().zip([142e3, 155e3, 424e3]) {
        assert!((found / converged - 1.0).abs() < 0.02, "{head:?}");
    }

    let rigid = Done::of(
        folder.path(),
        &["modes", "s.toml", "--ramp", "rigid", "--json"],
    )
    .json();
    assert_eq!(rigid["ramp"].as_array().map(Vec::len), Some(0));
}

/// A push on the slider: what the film gives back is its printed stiffness times the printed motion; a shock
/// moves every point; sources and frequencies that do not exist are named.
#[test]
fn modes_tell_responses_of_every_point_and_the_film() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let asked = |more: &[&str]| {
        let cells = ["--set", "resolution.film_cells=500", "--json"];
        let all: Vec<&str> = ["modes", "s.toml"]
            .iter()
            .chain(&cells)
            .chain(more)
            .copied()
            .collect();
        Done::of(folder.path(), &all)
    };
    let push = asked(&["--response", "slider", "--hz", "0,20000"]).json();
    let row = &push["response"]["rows"][0];
    let point = |name: &str| {
        row["points"][name][0]
            .as_f64()
            .unwrap_or_else(|| panic!("{name}"))
    };
    let stiffness = numbers(&row["stiffness"], 3);
    let motion = [point("slider"), point("slider.pitch"), point("slider.roll")];
    let back: f64 = stiffness.iter().zip(motion).map(|(k, q)| -k * q).sum();
    assert!((point("film.force") - back).abs() < 1e-9, "{back}");
    assert!(
        (back + 1.0).abs() < 1e-3,
        "the film carries all but what the suspension takes: {back}"
    );
    assert_eq!(point("film.height"), point("slider"));
    assert_eq!(push["response"]["rows"][1]["frequency_hz"], 20000.0);

    let shock = asked(&["--response", "shock", "--hz", "500"]).json();
    let points = shock["response"]["rows"][0]["points"].as_object().unwrap();
    assert_eq!(points.len(), 13);
    for (name, value) in points {
        let size: f64 = numbers(value, 2).iter().map(|part| part * part).sum();
        // Without skew an axisymmetric disk only rolls.
        assert_eq!(size > 0.0, name != "disk.pitch", "{name}");
    }
    for (more, key) in [
        (["--response", "rim", "--hz", "500"], "--response"),
        (["--response", "shock", "--hz=-1", "--quiet"], "--hz"),
    ] {
        let done = asked(&more);
        assert_eq!(done.code, 2, "{}", done.stderr);
        assert_eq!(done.errors()[0]["key"], key);
    }
}

#[test]
fn a_free_axis_is_exit_2_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let arguments = [
        "modes",
        "s.toml",
        "--set",
        "disk.rpm=[5400, 7200]",
        "--json",
    ];
    let done = Done::of(folder.path(), &arguments);
    assert_eq!(done.code, 2, "{}", done.stderr);
    let errors = done.errors();
    assert_eq!(errors[0]["key"], "disk.rpm");
    assert_eq!(errors[0]["allowed"], "5400, 7200");
    assert_eq!(errors[0]["hint"], "choose with --set disk.rpm=VALUE");
}

fn numbers(value: &serde_json::Value, rows: usize) -> Vec<f64> {
    let list = value.as_array().unwrap_or_else(|| panic!("{value}"));
    assert_eq!(list.len(), rows);
    let cells = list
        .iter()
        .flat_map(|row| row.as_array().cloned().unwrap_or(vec![row.clone()]));
    cells.map(|cell| cell.as_f64().expect("a number")).collect()
}

#[test]
fn steady_has_the_documented_keys_and_carries_the_load() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let arguments = ["steady", "s.toml", "--json", "--impedance", "1000,100000"];
    let steady = Done::of(folder.path(), &arguments).json();
    let number = |key: &str| steady[key].as_f64().unwrap_or_else(|| panic!("{key}"));
    // 2.2 gf at the slider's centre.
    let load_n = 2.2 * 9.80665e-3;
    assert!((number("force_n") / load_n - 1.0).abs() < 1e-7);
    let correction_n = steady["correction"]["force_n"]
        .as_f64()
        .expect("a corrected film");
    let sum_n = number("lift_n") + number("suction_n") + correction_n;
    assert!((sum_n - number("force_n")).abs() < 1e-9);
    for key in ["pitch_moment_n_m", "roll_moment_n_m"] {
        assert!(number(key).abs() < 1e-9 * load_n * 1e-3, "{key}");
    }
    for key in [
        "min_clearance_m",
        "centre_height_m",
        "pitch_rad",
        "p_max_pa",
        "p_min_pa",
        "unknowns",
    ] {
        assert!(number(key) > 0.0, "{key}");
    }
    assert_eq!(numbers(&steady["centre_of_pressure"], 2).len(), 2);
    assert_eq!(numbers(&steady["stiffness"], 3).len(), 9);
    assert_eq!(numbers(&steady["damping"], 3).len(), 9);
    assert_eq!(steady["modes"].as_array().map(Vec::len), Some(3));
    let impedance = steady["impedance"].as_array().unwrap();
    assert_eq!(impedance.len(), 2);
    assert_eq!(impedance[1]["frequency_hz"], 100000.0);
    // A squeezed film stiffens with frequency.
    let stiffness = |row: &serde_json::Value| numbers(&row["stiffness"], 3)[0];
    assert!(stiffness(&impedance[1]) > 1.5 * stiffness(&impedance[0]));
}

#[test]
fn holding_the_slider_where_it_flies_gives_the_load_back() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let flying = Done::of(folder.path(), &["steady", "s.toml", "--json"]).json();
    let number = |of: &serde_json::Value, key: &str| of[key].as_f64().expect("a number");
    let attitude = format!(
        "{},{},{}",
        1e9 * number(&flying, "centre_height_m"),
        1e6 * number(&flying, "pitch_rad"),
        1e6 * number(&flying, "roll_rad")
    );
    let held = Done::of(
        folder.path(),
        &["steady", "s.toml", "--json", "--attitude", &attitude],
    )
    .json();
    assert!((number(&held, "force_n") / number(&flying, "force_n") - 1.0).abs() < 1e-6);
    let (held, flying) = (
        numbers(&held["stiffness"], 3),
        numbers(&flying["stiffness"], 3),
    );
    for place in [0, 4, 8] {
        assert!(
            (held[place] / flying[place] - 1.0).abs() < 1e-6,
            "{held:?} {flying:?}"
        );
    }
}

/// What `steady`, `run` and the film's intervals fly on is one film: the same clearance to the last bit.
#[test]
fn steady_and_run_fly_alike() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    for set in [
        "slider.skew_deg=0",
        "slider.skew_deg=-5",
        "resolution.preset=coarse",
    ] {
        let steady = Done::of(folder.path(), &["steady", "s.toml", "--json", "--set", set]).json();
        let shock = "--ramp none --pulse-ms 0.5 --sign + --amplitude-g 1";
        let mut run = vec!["run", "s.toml", "--json", "--set", set];
        run.extend(shock.split(' '));
        let run = Done::of(folder.path(), &run).json();
        for key in ["min_clearance_m", "pitch_rad", "roll_rad"] {
            assert_eq!(steady[key], run["steady"][key], "{set} {key}");
        }
    }
}

/// The disk's velocity is uniform under the slider, so that skews of either sign mirror each other on a surface that is
/// its own mirror image.
#[test]
fn skews_of_either_sign_fly_alike() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    for (preset, skew) in [("coarse", "8"), ("standard", "5")] {
        let preset = format!("resolution.preset={preset}");
        let [one, other] = ["", "-"].map(|sign| {
            let skew = format!("slider.skew_deg={sign}{skew}");
            let arguments = [
                "steady", "s.toml", "--json", "--set", &preset, "--set", &skew,
            ];
            let steady = Done::of(folder.path(), &arguments).json();
            let number = |key: &str| steady[key].as_f64().expect("a number");
            [
                number("min_clearance_m"),
                number("pitch_rad"),
                -number("roll_rad"),
            ]
        });
        assert!((one[0] / other[0] - 1.0).abs() < 1e-6, "{one:?} {other:?}");
        assert!((one[1] / other[1] - 1.0).abs() < 1e-6, "{one:?} {other:?}");
        assert!((one[2] / other[2] + 1.0).abs() < 1e-6, "{one:?} {other:?}");
    }
}

#[test]
fn a_slider_that_cannot_fly_is_reported_with_the_load_it_could_carry() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let set = |gf: f64| format!("suspension.gram_load_gf={gf}");
    let heavy = set(10.0);
    let run = "run s.toml --ramp none --pulse-ms 0.5 --sign + --amplitude-g 1 --json --set";
    for command in [
        "steady s.toml --json --set",
        "modes s.toml --json --set",
        run,
    ] {
        let mut arguments: Vec<&str> = command.split(' ').collect();
        arguments.push(&heavy);
        let done = Done::of(folder.path(), &arguments);
        assert_eq!(done.code, 3, "{}", done.stderr);
        let error = &done.errors()[0];
        assert_eq!(error["code"], "E192", "{error}");
        assert_eq!(error["key"], "suspension.gram_load_gf");
        let allowed = error["allowed"].as_str().expect("the load it could carry");
        let carried_gf: f64 = allowed
            .split_whitespace()
            .find_map(|word| word.parse().ok())
            .expect("a load");
        assert!((5.0..7.0).contains(&carried_gf), "{allowed}");
        let lighter = set(0.98 * carried_gf);
        let flown = Done::of(
            folder.path(),
            &["steady", "s.toml", "--json", "--set", &lighter],
        );
        assert_eq!(flown.code, 0, "{}", flown.stderr);
    }
}

/// Continuum gas left Newton's method with a singular matrix at every preload and on nearly every grid.
#[test]
fn continuum_gas_flies_at_every_preload() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    let mut last_nm = f64::INFINITY;
    for load in ["0.3", "1", "2.2", "5"] {
        let load = format!("suspension.gram_load_gf={load}");
        let sets = ["--set", "gas.model=continuum", "--set", &load];
        let arguments = [&["steady", "s.toml", "--json"], &sets[..]].concat();
        let steady = Done::of(folder.path(), &arguments).json();
        let clearance_nm = 1e9 * steady["min_clearance_m"].as_f64().expect("a number");
        assert!(
            clearance_nm > 1.0 && clearance_nm < last_nm,
            "{load}: {clearance_nm}"
        );
        last_nm = clearance_nm;
    }
}

#[test]
fn an_attitude_inside_the_disk_and_a_wrong_count_are_exit_2() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    for attitude in ["5,113,0", "200,113", "200,113,0,0", "nan,0,0"] {
        let done = Done::of(folder.path(), &["steady", "s.toml", "--attitude", attitude]);
        assert_eq!(done.code, 2, "{attitude}: {}", done.stderr);
    }
    let done = Done::of(folder.path(), &["steady", "s.toml", "--impedance", "-5"]);
    assert_eq!(done.code, 2);
}

#[test]
fn no_store_is_exit_6_and_no_study_exit_2() {
    let folder = tempfile::tempdir().unwrap();
    new_study(folder.path());
    for command in ["report", "status"] {
        let done = Done::of(folder.path(), &[command, "s.toml", "--json"]);
        assert_eq!(done.code, 6);
        assert_eq!(done.errors()[0]["code"], "E187");
        assert_eq!(Done::of(folder.path(), &[command, "nothing.toml"]).code, 2);
    }
    assert_eq!(
        files(folder.path()),
        [folder.path().join("s.toml")],
        "nothing was made"
    );
}
