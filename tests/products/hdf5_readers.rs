//! Readers that are not ours: `h5dump` and h5py read every dataset of what the program writes, and
//! find units and a description on each; the lines of `docs/files.md` go from the table to the histories.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::cli::{Done, study};
use opshock_tests::coarse;
use opshock_tests::hdf5_dump::dump;

/// Prints a line per dataset: path, units, number of entries. Every group has a description.
const H5PY: &str = r#"
import sys, h5py
def reported(name, item):
    assert item.attrs["description"], name
    if isinstance(item, h5py.Dataset):
        units = item.attrs["units"]
        units = units.decode() if isinstance(units, bytes) else units
        values = item[()]
        print("/" + name, repr(units), values.size)
with h5py.File(sys.argv[1], "r") as file:
    assert file.attrs["description"]
    file.visititems(reported)
"#;

/// A small sweep with its histories; its HDF5 files.
fn files(folder: &Path) -> Vec<PathBuf> {
    let file = study("fig13");
    let mut words = vec![
        "sweep",
        file.to_str().unwrap(),
        "--store",
        "s.opshock",
        "--quiet",
    ];
    let swept = [
        "pulse.widths_ms=[0.5]",
        "ramp.models=[\"none\", \"rigid\"]",
        "ramp.clearance_um=[80, 100]",
        "output.keep_histories=\"bracket\"",
    ];
    for set in swept.iter().chain(&coarse::SEARCH) {
        words.extend(["--set", set]);
    }
    let done = Done::of(folder, &words);
    assert!([0, 4].contains(&done.code), "{}", done.stderr);
    let store = folder.join("s.opshock");
    let mut files = vec![store.join("results.h5")];
    let histories = std::fs::read_dir(store.join("histories")).unwrap();
    files.extend(histories.take(2).map(|entry| entry.unwrap().path()));
    assert!(files.len() == 3, "{files:?}");
    files
}

/// A python that has these modules.
fn python(modules: &str) -> PathBuf {
    let venv = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/verify-venv/bin/python");
    let all = [venv, "/usr/bin/python3".into(), "python3".into()];
    let has = |python: &PathBuf| {
        let import = Command::new(python)
            .args(["-c", &format!("import {modules}")])
            .output();
        import.is_ok_and(|output| output.status.success())
    };
    let found = all.into_iter().find(has);
    found.unwrap_or_else(|| panic!("no python with {modules}: scripts/bootstrap --verify"))
}

/// Paths of the datasets that our own reader finds.
fn datasets(file: &Path) -> Vec<String> {
    let mut found: Vec<String> = dump(file, &[])
        .iter()
        .filter_map(|line| line.split(' ').next())
        .filter(|name| !name.contains('@'))
        .map(str::to_owned)
        .collect();
    found.sort();
    found
}

#[test]
#[ignore = "needs h5dump and h5py: make verify-hdf5"]
fn h5dump_and_h5py_read_every_dataset_with_units() {
    let folder = tempfile::tempdir().unwrap();
    let files = files(folder.path());
    let python = python("h5py");
    for file in &files {
        let expected = datasets(file);
        assert!(expected.len() >= 15, "{expected:?}");
        // All values, then the attributes alone.
        let whole = Command::new("h5dump").arg(file).output();
        let whole = whole.expect("h5dump of hdf5-tools");
        assert!(whole.status.success(), "{}", file.display());
        assert!(
            whole.stderr.is_empty(),
            "{}",
            String::from_utf8_lossy(&whole.stderr)
        );
        for name in &expected {
            let output = Command::new("h5dump")
                .args(["-a", &format!("{name}/units")])
                .arg(file)
                .output()
                .unwrap();
            assert!(output.status.success(), "{name} has no units");
        }
        let output = Command::new(&python)
            .args(["-c", H5PY])
            .arg(file)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}: {said}", file.display());
        let reported = String::from_utf8(output.stdout).unwrap();
        let mut found: Vec<&str> = reported
            .lines()
            .filter_map(|line| line.split(' ').next())
            .collect();
        found.sort_unstable();
        assert_eq!(found, expected, "{}", file.display());
    }
}

/// Prints what the lines of the page have read, and compares every run with its history.
const FROM_TABLE_TO_HISTORIES: &str = r#"
import json
kept = runs[runs.history != ""].join(points, on="point", rsuffix="_of_point")
for run in kept.itertuples():
    about = h5py.File("my-drive.opshock/" + run.history).attrs
    assert about["verdict"] == run.verdict and about["amplitude_g"] == run.amplitude_g, run
    assert about["point_ramp"] == run.ramp and about["point_sign"] == run.sign, run
    assert about["point_pulse_ms"] == run.pulse_ms and about["point_pulse_ms"].dtype.kind == "f", run
    if run.ramp != "none":
        assert about["point_clearance_um"] == run.clearance_um, run
        assert f"_clearance_um={run.clearance_um:g}_" in run.history, run
least = [table(h5py.File("my-drive.opshock/" + name)["head"]).min_clearance_m.min() for name in kept.history]
brackets = table(results["brackets"])
print(json.dumps({
    "columns": list(points), "a_crit_g": points.a_crit_g.tolist(), "clearance_um": points.clearance_um.tolist(),
    "axis": [results["points/axes/clearance_um"].attrs[name] for name in ("units", "description")],
    "kept": len(kept), "survivors": (kept.verdict == "survives").tolist(), "least_m": least, "h_min_m": kept.h_min_m.tolist(),
    "first": list(history), "rows": len(history), "brackets": brackets.lower_g.tolist(),
}))
"#;

#[test]
#[ignore = "needs h5py and pandas: make verify-hdf5"]
fn the_lines_of_the_page_go_from_the_table_to_the_histories() {
    let folder = tempfile::tempdir().unwrap();
    files(folder.path());
    let [from, to] = ["s.opshock", "my-drive.opshock"].map(|name| folder.path().join(name));
    std::fs::rename(&from, &to).unwrap();
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/files.md");
    let page = std::fs::read_to_string(page).unwrap();
    let blocks = page.split("```python\n").skip(1);
    let mut blocks = blocks.filter_map(|rest| rest.split("```").next());
    let lines = blocks.find(|block| block.contains("pandas")).unwrap();
    assert_eq!(lines.lines().count(), 6, "{lines}");
    let output = Command::new(python("h5py, pandas"))
        .args(["-c", &(lines.to_owned() + FROM_TABLE_TO_HISTORIES)])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let read: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();

    let shown = Done::of(folder.path(), &["report", "my-drive.opshock", "--json"]).json();
    let points = shown["points"].as_array().unwrap();
    assert_eq!(points.len(), 8);
    for (place, point) in points.iter().enumerate() {
        for name in ["a_crit_g", "clearance_um"] {
            assert_eq!(read[name][place], point[name], "{name}");
        }
        assert_eq!(read["brackets"][place], point["brackets_g"][0][0]);
    }
    assert_eq!(read["axis"][0], "µm");
    let described = read["axis"][1].as_str().unwrap();
    assert!(described.starts_with("ramp.clearance_um: "), "{described}");
    // Failures of every point, and survivors without a ramp; with one they are below the first touch and not run again.
    assert_eq!(read["kept"], 12);
    let survivors = read["survivors"].as_array().unwrap();
    let survived = survivors.iter().filter(|survives| **survives == true);
    assert_eq!(survived.count(), 4);
    // A survivor's smallest clearance is located within a step, its history has it at the ends of steps.
    for (place, survives) in survivors.iter().enumerate() {
        let [least, stored] =
            ["least_m", "h_min_m"].map(|name| read[name][place].as_f64().unwrap());
        if *survives == true {
            assert!(
                stored <= least && least < stored + 0.2e-9,
                "{least} {stored}"
            );
        }
    }
    let columns = read["first"].as_array().unwrap();
    assert!(
        columns.iter().any(|name| name == "min_clearance_m"),
        "{columns:?}"
    );
    assert!(read["rows"].as_u64().unwrap() > 100);
}
