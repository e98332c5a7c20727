//! `opshock compare` on two swept stores.

use super::cli::{Done, study as shipped};
use opshock_study::search::{Probe, ProbeResult, Ramp, Sign};
use opshock_study::sweep::{Onset, Silent, Simulator, SweepOptions, sweep};
use opshock_tests::mock_sweep::{MockSimulator, study};
use std::path::Path;

/// The mock's law with critical amplitudes of positive shocks this many times higher.
struct Stronger<'a> {
    law: MockSimulator<'a>,
    factor: f64,
}

impl Simulator for Stronger<'_> {
    fn simulate(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> ProbeResult {
        let positive = amplitude_m_per_s2 > 0.0;
        let factor = if positive { self.factor } else { 1.0 };
        self.law.simulate(point, probe, amplitude_m_per_s2 / factor)
    }

    fn onset(&self, point: usize) -> Onset {
        self.law.onset(point)
    }
}

fn swept(folder: &Path, widths_ms: &[f64], factor: f64, resolved: &str) {
    let mut input = study(&[Ramp::None], widths_ms);
    input.texts.resolved = resolved.into();
    let law = MockSimulator::new(&input);
    let options = SweepOptions::with_threads(2);
    sweep(&input, &Stronger { law, factor }, folder, &options, &Silent).expect("a sweep");
}

#[test]
fn only_what_differs_is_reported_and_whether_it_is_beyond_the_errors() {
    let folder = tempfile::tempdir().unwrap();
    let store = |name: &str| folder.path().join(name);
    let text =
        |um: f64| format!("name = \"mock\"\n[ramp]\nradius_mm = 32.0\nclearance_um = {um:?}\n");
    swept(&store("a.opshock"), &[0.5, 1.0], 1.0, &text(100.0));
    swept(&store("b.opshock"), &[1.0, 2.0], 1.1, &text(120.0));

    let done = Done::of(
        folder.path(),
        &["compare", "a.opshock", "b.opshock", "--json"],
    );
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    let json = done.json();
    assert_eq!(
        json["settings"],
        serde_json::json!([{"key": "ramp.clearance_um", "a": 100.0, "b": 120.0}])
    );
    // Negative shocks of 1 ms are equal; widths 0.5 and 2 are in one study each, both signs.
    assert_eq!(json["equal_points"], 1);
    let widths = |list: &str| -> Vec<f64> {
        let list = json[list].as_array().unwrap();
        list.iter()
            .map(|p| p["pulse_ms"].as_f64().unwrap())
            .collect()
    };
    assert_eq!(
        (widths("only_a"), widths("only_b")),
        (vec![0.5; 2], vec![2.0; 2])
    );
    let points = json["points"].as_array().unwrap();
    assert_eq!(points.len(), 1);
    let point = &points[0];
    assert_eq!(point["sign"], Sign::Plus.as_str());
    // The mock fails from 500 G on, ten per cent more in B.
    for (side, truth_g) in [("a", 500.0), ("b", 550.0)] {
        let of = |key: &str| point[side][key].as_f64().unwrap();
        assert!(
            of("survived_g") <= truth_g && truth_g <= of("failed_g"),
            "{point}"
        );
    }
    // Neither has uncertainty intervals: what is known of the errors decides nothing.
    assert_eq!(point["significance"], "beyond_brackets");
    assert!(point["a"]["uncertainty_g"].is_null(), "{point}");
    let change_pct = point["change_pct"].as_f64().unwrap();
    assert!((change_pct - 10.0).abs() <= 1.1, "{change_pct}");

    let text = Done::of(folder.path(), &["compare", "a.opshock", "b.opshock"]).stdout;
    for line in [
        "settings that differ: 1\n  ramp.clearance_um: 100.0 | 120.0\n",
        "points of both: 1 differ, 1 equal\n",
        "beyond brackets, no intervals",
        "points of A only: 2\n  none 0.5 ms +\n  none 0.5 ms -\n",
        "points of B only: 2\n",
    ] {
        assert!(text.contains(line), "{text}");
    }

    // A store does not differ from itself.
    let same = Done::of(
        folder.path(),
        &["compare", "a.opshock", "a.opshock", "--json"],
    )
    .json();
    assert_eq!(same["equal_points"], 4);
    for list in ["settings", "points", "only_a", "only_b"] {
        assert_eq!(same[list], serde_json::json!([]), "{list}");
    }
}

/// Negative shocks are survived as before, positive ones ten times as far: a difference of the signs of one store.
#[test]
fn points_of_one_store_are_compared_with_one_another() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("a.opshock");
    swept(&store, &[0.5, 1.0], 1.1, "name = \"mock\"\n");
    let compared = |more: &[&str]| {
        let done = Done::of(folder.path(), &[&["compare", "a.opshock"], more].concat());
        assert_eq!(done.code, 0, "{}", done.stderr);
        done
    };
    let sides = ["--points", "sign=+", "--with", "sign=-", "--json"];
    let json = compared(&sides).json();
    assert_eq!(json["a"]["source"], "sign=+");
    assert_eq!(json["settings"], serde_json::json!([]));
    let points = json["points"].as_array().unwrap();
    let found = points.len() + json["equal_points"].as_u64().unwrap() as usize;
    assert_eq!(found, 2, "each width once: {json}");
    for point in points {
        let of = |side: &str| point[side]["a_crit_g"].as_f64().unwrap();
        let change_pct = 100.0 * (of("b") / of("a") - 1.0);
        assert!((point["change_pct"].as_f64().unwrap() - change_pct).abs() < 1e-9);
    }
    let table = Done::of(folder.path(), &["report", "a.opshock", "--json"]).json();
    let rows = table["points"].as_array().unwrap();
    let crit = rows.iter().filter_map(|row| row["a_crit_g"].as_f64());
    let lowest = crit.fold(f64::INFINITY, f64::min);
    let answer = compared(&["--json"]).json()["answer"].clone();
    let wanted = format!("Critical shocks range from {lowest:.1} G (the worst case: no ramp, ");
    assert!(answer.as_str().unwrap().starts_with(&wanted), "{answer}");
    assert_eq!(table["answer"], answer);
}

#[test]
fn what_cannot_be_compared_is_refused_with_its_code() {
    let folder = tempfile::tempdir().unwrap();
    swept(
        &folder.path().join("a.opshock"),
        &[1.0],
        1.0,
        "name = \"mock\"\n",
    );
    std::fs::create_dir(folder.path().join("empty.opshock")).unwrap();
    std::fs::write(
        folder.path().join("bad.toml"),
        "study_format = 2\nnme = 3\n",
    )
    .unwrap();
    let fig13 = shipped("fig13").display().to_string();
    for (arguments, code) in [
        (&["a.opshock", "none.opshock"][..], 2),
        (&["a.opshock", "--points", "sign=+"], 2),
        (&["a.opshock", "--points", "sign=+", "--with", "sign=up"], 2),
        (
            &["a.opshock", "--points", "sign=+", "--with", "pulse_ms=1"],
            2,
        ),
        (&["bad.toml", "a.opshock"], 3),
        (&["a.opshock", "empty.opshock"], 6),
        (&[&fig13, &fig13, "--store", "a.opshock"], 2),
    ] {
        let done = Done::of(folder.path(), &[&["compare"], arguments].concat());
        assert_eq!(done.code, code, "{arguments:?}: {}", done.stderr);
        assert!(done.stdout.is_empty() && !done.stderr.is_empty());
    }
    // A study file stands for its own results alone.
    let done = Done::of(
        folder.path(),
        &[
            "compare",
            &fig13,
            "a.opshock",
            "--store",
            "a.opshock",
            "--json",
        ],
    );
    assert_eq!(done.code, 6, "{}", done.stderr);
    assert!(done.stderr.contains("E188") && done.stdout.is_empty());
}
