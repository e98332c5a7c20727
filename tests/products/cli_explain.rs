//! `explain`, and studies whose outputs need only a part of the drive.

use super::cli::{Done, files, study};
use serde_json::Value;
use std::path::Path;

fn program(folder: &Path, command: &str, more: &[&str]) -> Done {
    let path = study("fig13");
    Done::of(folder, &[&[command, path.to_str().unwrap()], more].concat())
}

fn applied(scene: &Value) -> Vec<&str> {
    let rules = scene["rules"].as_array().unwrap();
    assert_eq!(rules.len(), 10);
    for (i, rule) in rules.iter().enumerate() {
        assert_eq!(rule["rule"], format!("R{}", i + 1));
        for key in ["condition", "value", "what"] {
            assert!(!rule[key].as_str().unwrap().is_empty(), "{rule}");
        }
    }
    let is_applied = |rule: &&Value| rule["applied"] == true;
    let applied = rules.iter().filter(is_applied);
    applied.map(|rule| rule["rule"].as_str().unwrap()).collect()
}

fn state<'a>(scene: &'a Value, effect: &str) -> &'a str {
    let effects = scene["effects"].as_array().unwrap();
    let row = effects.iter().find(|row| row["effect"] == effect);
    row.unwrap()["state"].as_str().unwrap()
}

#[test]
fn explain_lists_every_rule_for_every_scene() {
    let folder = tempfile::tempdir().unwrap();
    let json = program(folder.path(), "explain", &["--json"]).json();
    assert_eq!(json["scenes"].as_array().unwrap().len(), 36);
    let shock = ["--json", "--pulse-ms", "0.5", "--amplitude-g", "190"];
    let json = program(folder.path(), "explain", &shock).json();
    let scenes = json["scenes"].as_array().unwrap();
    assert_eq!(scenes.len(), 6);
    for scene in scenes {
        // 190 G lies below the rigid ramp's first touch (195 G), above the deformable one's (180).
        let clear = scene["ramp"] != "deformable";
        assert_eq!(applied(scene).contains(&"R4"), clear, "{scene:#}");
        let waves = match scene["ramp"] == "none" {
            true => "off",
            false => "inactive",
        };
        assert_eq!(state(scene, "disk.travelling_waves"), waves);
        assert_eq!(state(scene, "head.film"), "on");
        assert!(scene["unknowns"]["film_cells"].as_u64().unwrap() > 900);
    }
    let full = [&shock[..], &["--set", "solver.effects=full"]].concat();
    let json = program(folder.path(), "explain", &full).json();
    for scene in json["scenes"].as_array().unwrap() {
        assert_eq!(applied(scene), ["R8", "R10"]);
        assert_eq!(state(scene, "disk.travelling_waves"), "on");
    }
    let text = program(folder.path(), "explain", &[]).stdout;
    assert!(text.contains("inactive R2") && text.contains("R10  yes"));
    assert_eq!(files(folder.path()).len(), 0);
}

#[test]
fn explain_measures_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [
        "--json",
        "--measure",
        "--amplitude-g",
        "100",
        "--pulse-ms",
        "0.5",
        "--ramp",
        "rigid",
        "--sign",
        "+",
        "--set",
        "outputs=[\"contact_force\"]",
        "--set",
        "resolution.film_cells=300",
        "--set",
        "pulse.window_ms=1.5",
        "--set",
        "pulse.widths_ms=[0.5]",
    ];
    let json = program(folder.path(), "explain", &arguments).json();
    let cost = &json["scenes"][0]["cost"];
    let number = |key: &str| cost[key].as_f64().unwrap();
    let saved = 1.0 - number("reduced_s") / number("full_s");
    assert!((number("saved_share") - saved).abs() < 1e-12, "{cost}");
    let done = program(folder.path(), "explain", &["--measure"]);
    assert_eq!(done.code, 2, "a measurement needs a shock");
}

#[test]
fn a_sweep_of_touch_thresholds_runs_no_search() {
    let folder = tempfile::tempdir().unwrap();
    let asks = ["--json", "--set", "outputs=[\"touch_threshold\"]"];
    let done = program(folder.path(), "sweep", &asks);
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    let json = done.json();
    let points = json["points"].as_array().unwrap();
    assert_eq!(points.len(), 36);
    for point in points {
        let onset = point["onset_g"].as_f64();
        assert_eq!(onset.is_none(), point["ramp"] == "none", "{point}");
    }
    assert_eq!(files(folder.path()).len(), 0, "no store");
}

#[test]
fn a_sweep_refuses_an_output_it_does_not_answer() {
    let folder = tempfile::tempdir().unwrap();
    let asks = ["--json", "--set", "outputs=[\"disk_displacement\"]"];
    let done = program(folder.path(), "sweep", &asks);
    assert_eq!(done.code, 3);
    let error = &done.errors()[0];
    assert_eq!(error["code"], "E158");
    assert!(
        error["message"]
            .as_str()
            .unwrap()
            .contains("disk_displacement")
    );
}

#[test]
fn a_steady_attitude_needs_no_moving_head() {
    let folder = tempfile::tempdir().unwrap();
    let shock = [
        "--ramp",
        "none",
        "--pulse-ms",
        "0.5",
        "--sign",
        "+",
        "--amplitude-g",
        "10",
    ];
    let asks = [
        "--json",
        "--set",
        "outputs=[\"steady_attitude\"]",
        "--set",
        "resolution.film_cells=300",
    ];
    let json = program(folder.path(), "run", &[&shock[..], &asks].concat()).json();
    assert!(json["steady"]["pitch_rad"].as_f64().unwrap() > 1e-5);
    assert!(json["min_clearance_m"].is_null() && json["dimple"].is_null());
    let rules = json["rules"].as_array().unwrap();
    assert!(rules.contains(&Value::from("R1")) && rules.contains(&Value::from("R4")));
}

#[test]
fn the_full_model_gives_the_critical_shocks_of_the_reduced_one() {
    let folder = tempfile::tempdir().unwrap();
    let sweep = |effects: &str| {
        let store = format!("{effects}.opshock");
        let effects = format!("solver.effects={effects}");
        let mut arguments = vec!["--json", "--store", &store];
        for set in [
            effects.as_str(),
            "ramp.models=[\"none\", \"rigid\"]",
            "pulse.signs=[\"+\"]",
            "pulse.widths_ms=[0.5]",
            "pulse.window_ms=1",
            "search.tolerance_pct=20",
            "search.monotonicity_scan=off",
            "search.max_refinements=0",
            "resolution.film_cells=200",
            "resolution.disk_cut_khz=10",
        ] {
            arguments.extend(["--set", set]);
        }
        let done = program(folder.path(), "sweep", &arguments);
        assert!([0, 4].contains(&done.code), "{}", done.stderr);
        done.json()["points"].clone()
    };
    let (planned, full) = (sweep("auto"), sweep("full"));
    for (a, b) in planned
        .as_array()
        .unwrap()
        .iter()
        .zip(full.as_array().unwrap())
    {
        for key in ["ramp", "survived_g", "failed_g", "status"] {
            assert_eq!(a[key], b[key], "{key}\n{planned:#}\n{full:#}");
        }
    }
    // The rigid ramp takes nothing from the answers without ramp.
    assert!(full[1]["runs"].as_u64() >= planned[1]["runs"].as_u64());
    assert!(full[1]["onset_g"].is_null() && planned[1]["onset_g"].is_number());
}
