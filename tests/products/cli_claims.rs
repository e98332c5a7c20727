//! `claims`: numbers come from runs and tables, answers from numbers, and always the same.

use super::cli::{Done, files, study};
use serde_json::Value;
use std::path::Path;

/// The paper's drive on a coarse film with few disk modes.
const COARSE: [&str; 6] = [
    "--set",
    "resolution.film_cells=200",
    "--set",
    "resolution.disk_cut_khz=8",
    "--set",
    "resolution.suspension_modes=4",
];
/// A table made up so that the answers are known: none rises with signs apart, with a dip at 0.75 ms, +; rigid falls between
/// its widths with sign + and rises with sign -; deformable is below rigid at 0.5 ms, above at 2 ms.
const TABLE: &str = "ramp,pulse_ms,sign,a_crit_g,uncertainty_g,half_min_height_g,survived_g,failed_g,onset_g,runs,status,flags\n\
    none,0.5,+,400,4,,400,404,,9,ok,\nnone,0.75,+,380,4,,380,384,,9,ok,\nnone,2,+,500,5,,500,505,,9,ok,\n\
    none,0.5,-,600,6,,600,606,,9,ok,\nnone,0.75,-,650,6,,650,655,,9,ok,\nnone,2,-,700,7,,700,707,,9,ok,\n\
    rigid,0.5,+,220,2,,220,222,195,9,ok,\nrigid,2,+,200,2,,200,202,255,9,ok,\n\
    rigid,0.5,-,210,2,,210,212,195,9,ok,\nrigid,2,-,398.5,101.5,,300,303,255,9,ok,\n\
    deformable,0.5,+,190,2,,190,192,180,9,ok,\ndeformable,2,+,400,4,,400,404,320,9,ok,\n\
    deformable,0.5,-,191,2,,191,193,180,9,ok,\ndeformable,2,-,,,,410,,320,9,above_range,\n";

fn claims(folder: &Path, more: &[&str]) -> Done {
    let path = study("paper-cases");
    let start = ["claims", path.to_str().unwrap(), "--critical", "table.csv"];
    Done::of(folder, &[&start[..], &COARSE, more].concat())
}

fn claim<'a>(table: &'a Value, id: &str) -> &'a Value {
    let rows = table["claims"].as_array().unwrap();
    rows.iter().find(|row| row["id"] == id).unwrap()
}

#[test]
fn statements_are_judged_by_numbers_of_runs_and_of_the_table() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("table.csv"), TABLE).unwrap();
    let done = claims(folder.path(), &["--json", "--out", "a"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let table: Value = serde_json::from_str(&done.stdout).unwrap();

    // The free motion has a closed form and the disk's first contact follows from it alone.
    let touch = &claim(&table, "rigid_touch")["finding"]["value"];
    let path = study("paper-cases");
    let shock = ["run", path.to_str().unwrap(), "--json", "--pulse-ms", "2"];
    let run = |ramp: &str| {
        let chosen = ["--ramp", ramp, "--sign", "+", "--amplitude-g", "400"];
        let done = Done::of(folder.path(), &[&shock[..], &chosen, &COARSE].concat());
        serde_json::from_str::<Value>(&done.stdout).unwrap()
    };
    let rigid = run("rigid");
    let same = |a: &Value, b: &Value, scale: f64| {
        let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap() * scale);
        assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} against {b}");
    };
    same(touch, &rigid["contact"]["top"]["first_touch_s"], 1e3);
    let peak = &claim(&table, "rigid_slider")["finding"]["value"];
    same(peak, &rigid["disk"]["slider_max_m"], 1e6);
    let survivor = &claim(&table, "free_survives")["finding"]["value"];
    same(survivor, &run("none")["min_clearance_m"], 1e9);

    // The table is made up, so its answers are known.
    let answer = |id: &str| claim(&table, id)["answer"].as_str().unwrap().to_owned();
    assert_eq!(answer("rises_none"), "holds");
    // 380 over 400 is a prediction and decides nothing.
    assert_eq!(
        claim(&table, "rises_none")["finding"]["note"],
        "holds at 2 of 2 places; prediction, not judged: 0.75 ms, +: 380.0 G, a dip 5.0 % below 0.5 and 2 ms; \
         0.75 ms, -: 650.0 G, no dip between 0.5 and 2 ms"
    );
    assert_eq!(answer("rises_rigid"), "does_not");
    assert_eq!(
        claim(&table, "rises_rigid")["depends_on"][0],
        "pulse: holds at 0.5 to 2 ms, -; not at 0.5 to 2 ms, +"
    );
    assert_eq!(answer("signs_apart_none"), "holds");
    assert_eq!(answer("signs_close_rigid"), "does_not");
    assert_eq!(answer("deformable_below_rigid"), "holds");
    // A point without a bracket is no evidence; the other one stands.
    let above = claim(&table, "deformable_above_rigid");
    assert_eq!(above["finding"]["parts"].as_array().unwrap().len(), 1);
    same(&above["finding"]["value"], &serde_json::json!(2.0), 1.0);
    // 500 over 208 and 297 over 212: rising beyond the intervals; 202 over 218 and 198 over 222: falling.
    assert_eq!(
        claim(&table, "rises_rigid")["beyond_the_uncertainties"],
        serde_json::json!([2, 2])
    );

    assert_eq!(claims(folder.path(), &["--out", "b", "-j", "1"]).code, 0);
    let (first, second) = (
        files(&folder.path().join("a")),
        files(&folder.path().join("b")),
    );
    assert_eq!(first.len(), 3);
    for (one, other) in first.iter().zip(&second) {
        assert!(std::fs::read(one).unwrap() == std::fs::read(other).unwrap());
    }
}

#[test]
fn what_cannot_be_judged_is_said_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("table.csv"), "ramp\n").unwrap();
    let done = claims(folder.path(), &["--out", "a"]);
    assert_eq!(done.code, 2);
    assert!(done.stderr.contains("table.csv, line 1"), "{}", done.stderr);
    let done = claims(folder.path(), &["--sensitivity", "kept"]);
    assert_eq!(done.code, 2);
    assert!(done.stderr.contains("--out DIR"), "{}", done.stderr);
    assert!(!folder.path().join("a").exists());
}
