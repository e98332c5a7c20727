//! Time series for ParaView: well-formed, and holding what the run computed.

use super::cli::{Done, study};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

const COARSE: [&str; 10] = [
    "--set",
    "pulse.widths_ms=[1.0]",
    "--set",
    "resolution.film_cells=150",
    "--set",
    "resolution.disk_cut_khz=4",
    "--set",
    "pulse.window_ms=1.0",
    "--set",
    "resolution.structure_step_us=4",
];

fn export(folder: &Path, amplitude_g: &str, more: &[&str]) -> Done {
    let path = study("paper-cases");
    let shock = [
        "--ramp",
        "deformable",
        "--pulse-ms",
        "1",
        "--sign",
        "+",
        "--amplitude-g",
        amplitude_g,
    ];
    let start = [
        "export",
        path.to_str().unwrap(),
        "--format",
        "vtu",
        "--frames",
        "3",
    ];
    Done::of(folder, &[&start[..], &shock, &COARSE, more].concat())
}

/// Values of a named array.
pub(super) fn array(text: &str, name: &str) -> Vec<f64> {
    let from = text.find(&format!("Name=\"{name}\"")).expect("the array");
    let start = from + text[from..].find('>').unwrap() + 1;
    let end = start + text[start..].find('<').unwrap();
    text[start..end]
        .split_whitespace()
        .map(|word| word.parse().unwrap())
        .collect()
}

/// Panics when tags do not nest or arrays have the wrong length.
pub(super) fn assert_grid(text: &str) {
    let mut open = Vec::new();
    for tag in text
        .split('<')
        .skip(1)
        .map(|rest| rest.split('>').next().unwrap())
    {
        let name = tag.split([' ', '/']).find(|word| !word.is_empty()).unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') && !tag.starts_with('?') {
            open.push(name);
        }
    }
    assert!(open.is_empty());
    let count = |key: &str| -> usize {
        let start = text.find(key).unwrap() + key.len() + 2;
        text[start..].split('"').next().unwrap().parse().unwrap()
    };
    let (points, cells) = (count("NumberOfPoints"), count("NumberOfCells"));
    assert_eq!(array(text, "points").len(), 3 * points);
    let (offsets, corners) = (array(text, "offsets"), array(text, "connectivity"));
    assert_eq!(offsets.len(), cells);
    assert_eq!(array(text, "types").len(), cells);
    assert_eq!(
        offsets.last().copied().unwrap_or(0.0) as usize,
        corners.len()
    );
    assert!(corners.iter().all(|&corner| (corner as usize) < points));
}

#[test]
fn a_shock_becomes_three_series_that_hold_its_motion() {
    let folder = tempfile::tempdir().unwrap();
    let done = export(folder.path(), "400", &["--out", "v"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let read = |name: &str| std::fs::read_to_string(folder.path().join("v").join(name)).unwrap();
    // 400 G for 1 ms is too much: the film ends at touch, which is reported; disk and ramp go on.
    let film = read("film.pvd").matches("<DataSet ").count();
    assert!(film < 3);
    assert!(
        done.stderr.contains(&format!("{film} of 3 film fields")),
        "{}",
        done.stderr
    );
    for (part, frames) in [("disk", 3), ("ramp", 3), ("film", film)] {
        let list = read(&format!("{part}.pvd"));
        assert_eq!(list.matches("<DataSet ").count(), frames);
        // The pulse starts at 0.5 ms, the frames are 0.5 ms apart.
        for time in ["5e-4", "1e-3", "1.5e-3"].iter().take(frames) {
            assert!(
                list.contains(&format!("timestep=\"{time}\"")),
                "{part}: {list}"
            );
        }
        for frame in 0..frames {
            assert_grid(&read(&format!("{part}_{frame:04}.vtu")));
        }
    }
    // Before the shock nothing has moved and the film carries the steady load.
    assert!(
        array(&read("disk_0000.vtu"), "deflection_m")
            .iter()
            .all(|&w| w == 0.0)
    );
    // At the end of the window the rim under the ramp is where the run says, the clamp at rest.
    let path = study("paper-cases");
    let shock = [
        "run",
        path.to_str().unwrap(),
        "--ramp",
        "deformable",
        "--pulse-ms",
        "1",
    ];
    let more = ["--sign", "+", "--amplitude-g", "400", "--history", "h.csv"];
    let run = Done::of(folder.path(), &[&shock[..], &more, &COARSE].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    let history = std::fs::read_to_string(folder.path().join("h.csv")).unwrap();
    let header: Vec<&str> = history.lines().next().unwrap().split(',').collect();
    let last: Vec<&str> = history.lines().last().unwrap().split(',').collect();
    let of = |name: &str| -> f64 {
        let column = header.iter().position(|word| *word == name).unwrap();
        last[column].parse().unwrap()
    };
    let disk = array(&read("disk_0002.vtu"), "deflection_m");
    let around = 48;
    assert!(disk[..around].iter().all(|&w| w == 0.0));
    let rim = disk[disk.len() - around];
    // Contact bends the disk along its circumference, which the free motion does not.
    let across = disk[disk.len() - around / 2];
    assert!((rim - across).abs() > 1e-3 * rim.abs());
    assert!(
        (rim - of("disk_rim_m")).abs() < 1e-12 * rim.abs(),
        "{rim} {}",
        of("disk_rim_m")
    );
    let arms = array(&read("ramp_0002.vtu"), "displacement_m");
    assert!((arms[2] - of("ramp_top_m")).abs() <= 1e-12 * arms[2].abs());
    let pressure = array(&read("film_0000.vtu"), "pressure_pa");
    assert!(pressure.iter().any(|&p| p > 5e5) && pressure.iter().all(|&p| p > 0.0));

    assert_eq!(
        export(folder.path(), "400", &["--out", "w", "-j", "1"]).code,
        0
    );
    for name in ["disk_0001.vtu", "ramp_0001.vtu", "film_0000.vtu"] {
        let other = std::fs::read_to_string(folder.path().join("w").join(name)).unwrap();
        assert!(read(name) == other, "{name} differs");
    }
}

#[test]
fn a_series_needs_a_folder_and_a_store_no_shock() {
    let folder = tempfile::tempdir().unwrap();
    let done = export(folder.path(), "400", &[]);
    assert_eq!(done.code, 2);
    assert!(done.stderr.contains("--out"), "{}", done.stderr);
    let path = study("paper-cases");
    let done = Done::of(
        folder.path(),
        &["export", path.to_str().unwrap(), "--ramp", "rigid"],
    );
    assert_eq!(done.code, 2);
    assert!(done.stderr.contains("--format vtu"), "{}", done.stderr);
}

#[test]
#[ignore = "needs VTK: make verify-series"]
fn series_slow_vtk_reads_every_series() {
    let python = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/verify-venv/bin/python");
    assert!(
        python.is_file(),
        "scripts/bootstrap --verify makes {}",
        python.display()
    );
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(export(folder.path(), "150", &["--out", "v"]).code, 0);
    let script = r#"
import json, sys, vtk
reported = {}
for part in ("disk", "ramp", "film"):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(f"{sys.argv[1]}/{part}_0002.vtu")
    reader.Update()
    grid = reader.GetOutput()
    size = vtk.vtkCellSizeFilter()
    size.SetInputData(grid)
    size.Update()
    out = size.GetOutput().GetCellData()
    name = "Volume" if part == "ramp" else "Area"
    reported[part] = {
        "error": reader.GetErrorCode(),
        "cells": grid.GetNumberOfCells(),
        "size": sum(out.GetArray(name).GetValue(k) for k in range(grid.GetNumberOfCells())),
        "arrays": sorted([grid.GetPointData().GetArrayName(k) for k in range(grid.GetPointData().GetNumberOfArrays())]
                         + [grid.GetCellData().GetArrayName(k) for k in range(grid.GetCellData().GetNumberOfArrays())]),
    }
print(json.dumps(reported))
"#;
    let output = Command::new(python)
        .args(["-c", script])
        .arg(folder.path().join("v"))
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let reported: Value = serde_json::from_slice(&output.stdout).unwrap();
    for part in ["disk", "ramp", "film"] {
        assert_eq!(reported[part]["error"], 0, "{reported}");
    }
    assert_eq!(reported["disk"]["cells"], 12 * 48);
    assert_eq!(
        reported["disk"]["arrays"],
        serde_json::json!(["deflection_m", "displacement_m"])
    );
    assert_eq!(
        reported["ramp"]["arrays"],
        serde_json::json!(["contact_force_n", "displacement_m"])
    );
    assert_eq!(
        reported["film"]["arrays"],
        serde_json::json!(["gap_m", "pressure_pa"])
    );
    // The slider's face, 0.85 mm by 0.70 mm.
    let face = reported["film"]["size"].as_f64().unwrap();
    assert!((face / (0.85e-3 * 0.70e-3) - 1.0).abs() < 1e-9, "{face}");
    assert_eq!(reported["ramp"]["cells"], 2);
}
