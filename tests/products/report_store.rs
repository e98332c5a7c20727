//! `report`, `status` and `export` on a swept store.

use super::cli::{Done, files};
use opshock_study::sweep::{Silent, SweepOptions, sweep};
use opshock_tests::hdf5_dump::open_rw;
use opshock_tests::mock_sweep::{MockSimulator, fig13};
use std::path::Path;

/// Sweeps the paper's 36 points with the mock's law of failure.
fn swept(folder: &Path) {
    let input = fig13();
    let simulator = MockSimulator::new(&input);
    let end = sweep(
        &input,
        &simulator,
        folder,
        &SweepOptions::with_threads(2),
        &Silent,
    )
    .expect("a sweep");
    assert!(end.summary.totals.runs > 100);
}

#[test]
fn report_prints_table_csv_markdown_and_json_that_agree() {
    let folder = tempfile::tempdir().unwrap();
    swept(&folder.path().join("s.opshock"));
    let report = |more: &[&str]| {
        let done = Done::of(folder.path(), &[&["report", "s.opshock"], more].concat());
        assert!([0, 4].contains(&done.code), "{}", done.stderr);
        done
    };
    let json = report(&["--format", "json"]).json();
    let points = json["points"].as_array().unwrap();
    assert_eq!(points.len(), 36);
    assert_eq!(json, report(&["--json"]).json());
    let mut without = json.clone();
    assert!(without.as_object_mut().unwrap().remove("answer").is_some());
    assert_eq!(
        without,
        Done::of(folder.path(), &["status", "s.opshock", "--json"]).json()
    );

    let csv = report(&["--format", "csv"]).stdout;
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(
        lines[0].join(","),
        "ramp,pulse_ms,sign,a_crit_g,uncertainty_g,half_min_height_g,survived_g,failed_g,onset_g,runs,status,flags"
    );
    assert_eq!(lines.len(), 37);
    for (line, point) in lines[1..].iter().zip(points) {
        for (cell, key) in line.iter().zip(&lines[0]) {
            match &point[*key] {
                serde_json::Value::Null => assert_eq!(*cell, ""),
                // serde_json reads numbers to the last bit but one; the file itself has all digits.
                serde_json::Value::Number(number) => {
                    let (cell, number) = (cell.parse::<f64>().unwrap(), number.as_f64().unwrap());
                    assert!((cell - number).abs() <= 2e-16 * number.abs(), "{key}");
                }
                serde_json::Value::String(text) => assert_eq!(cell, text),
                _ => {}
            }
        }
    }
    // Widths ascend within a ramp and sign.
    let widths: Vec<f64> = points[..6]
        .iter()
        .map(|p| p["pulse_ms"].as_f64().unwrap())
        .collect();
    assert!(widths.is_sorted(), "{widths:?}");
    assert_eq!(
        report(&["--format", "md"])
            .stdout
            .lines()
            .filter(|l| l.starts_with('|'))
            .count(),
        38
    );
    assert!(report(&[]).stdout.contains("36 points:"));
}

#[test]
fn report_out_writes_the_six_files_and_tells_them_on_stderr_only() {
    let folder = tempfile::tempdir().unwrap();
    swept(&folder.path().join("s.opshock"));
    let done = Done::of(folder.path(), &["report", "s.opshock", "--out", "out/r"]);
    let names: Vec<String> = files(&folder.path().join("out/r"))
        .iter()
        .map(|path| path.file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    assert_eq!(
        names,
        [
            "critical_shock.png",
            "critical_shock.svg",
            "report.html",
            "results.h5",
            "table.csv",
            "table.md"
        ]
    );
    assert_eq!(done.stderr.matches("wrote ").count(), 6);
    assert!(!done.stdout.contains("wrote "));
    let h5 = hdf5::File::open(folder.path().join("out/r/results.h5")).unwrap();
    assert_eq!(h5.dataset("points/survived_g").unwrap().size(), 36);
    let page = std::fs::read_to_string(folder.path().join("out/r/report.html")).unwrap();
    assert_eq!(page.matches("<tr data-point").count(), 36);

    // An axis with one value less than the widths, on the abscissa; its word is checked.
    let over = |key: &str| {
        Done::of(
            folder.path(),
            &["report", "s.opshock", "--out", "out/x", "--x", key],
        )
    };
    assert!([0, 4].contains(&over("ramp.models").code));
    let svg = std::fs::read_to_string(folder.path().join("out/x/critical_shock.svg")).unwrap();
    assert!(svg.contains("Ramp model") && !svg.contains("Pulse width (ms)"));
    let wrong = over("clearance_um");
    assert_eq!(wrong.code, 2, "{}", wrong.stderr);
    assert!(
        wrong
            .stderr
            .contains("--x = \"clearance_um\" must be one of ramp, pulse_ms, sign"),
        "{}",
        wrong.stderr
    );

    let quiet = Done::of(
        folder.path(),
        &["report", "s.opshock", "--out", "out/q", "--quiet"],
    );
    assert_eq!(quiet.stderr, "");
}

#[test]
fn the_same_results_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.opshock", "b.opshock"] {
        swept(&folder.path().join(name));
    }
    for format in ["csv", "json", "md"] {
        let of = |name: &str| Done::of(folder.path(), &["report", name, "--format", format]).stdout;
        assert_eq!(of("a.opshock"), of("b.opshock"), "{format}");
    }
}

#[test]
fn export_lists_every_simulation_behind_the_table() {
    let folder = tempfile::tempdir().unwrap();
    swept(&folder.path().join("s.opshock"));
    let report = Done::of(folder.path(), &["report", "s.opshock", "--json"]).json();
    let runs = report["totals"]["runs"].as_u64().unwrap() as usize;
    let csv = Done::of(folder.path(), &["export", "s.opshock"]);
    assert_eq!(csv.code, 0);
    assert!(
        csv.stdout
            .starts_with("ramp,pulse_ms,sign,sequence,purpose,amplitude_g,")
    );
    assert_eq!(csv.stdout.lines().count(), 1 + runs);
    let json = Done::of(folder.path(), &["export", "s.opshock", "--format", "json"]).json();
    assert_eq!(json["runs"].as_array().map(Vec::len), Some(runs));
    // The evidence holds the answer: the reported survivor and failure are among the runs.
    let point = &report["points"][0];
    for (key, verdict) in [("survived_g", "survives"), ("failed_g", "fails")] {
        let Some(amplitude) = point[key].as_f64() else {
            continue;
        };
        assert!(json["runs"].as_array().unwrap().iter().any(|run| {
            run["ramp"] == point["ramp"]
                && run["pulse_ms"] == point["pulse_ms"]
                && run["sign"] == point["sign"]
                && run["verdict"] == verdict
                && run["amplitude_g"].as_f64() == Some(amplitude)
        }));
    }
}

#[test]
fn a_store_of_a_newer_format_is_refused_by_name_with_exit_6() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("s.opshock");
    swept(&store);
    std::fs::remove_file(store.join("journal")).unwrap();
    let file = open_rw(store.join("results.h5"));
    file.attr("format_version")
        .unwrap()
        .write_scalar(&99u32)
        .unwrap();
    file.close().unwrap();
    let done = Done::of(folder.path(), &["report", "s.opshock", "--json"]);
    assert_eq!(done.code, 6, "{}", done.stderr);
    assert_eq!(done.errors()[0]["code"], "E181");
}
