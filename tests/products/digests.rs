//! What the program computes, bit for bit: shocks, steady flights, modes, and the committed Fig. 13.

use opshock_tests::digests::{assert_digest, numbers};
use serde_json::Value;

use super::cli::{self, Done};

fn study(name: &str) -> String {
    cli::study(name).display().to_string()
}

fn answered(words: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let done = Done::of(folder.path(), &[words, &["--json", "--quiet"]].concat());
    assert_eq!(done.code, 0, "{words:?}: {}", done.stderr);
    serde_json::from_str(&done.stdout).expect("JSON")
}

#[test]
fn digests_of_shocks_flights_and_modes() {
    let fig13 = study("fig13");
    for ramp in ["none", "rigid", "deformable"] {
        for (sign, width_ms, amplitude_g) in [("+", "2", "200"), ("-", "0.5", "400")] {
            let run = ["run", &fig13, "--ramp", ramp, "--pulse-ms", width_ms];
            let shock = ["--sign", sign, "--amplitude-g", amplitude_g];
            let answer = answered(&[&run[..], &shock].concat());
            let name = format!("fig13 {ramp} {width_ms} ms {sign}{amplitude_g} G");
            assert_digest(&name, &numbers(&answer, &["cost"]));
        }
    }
    for (command, name) in [
        ("steady", "fig13"),
        ("modes", "fig13"),
        ("steady", "drive-2.5in"),
        ("modes", "drive-2.5in"),
    ] {
        let answer = answered(&[command, &study(name)]);
        assert_digest(&format!("{name} {command}"), &numbers(&answer, &["cost"]));
    }
}

/// Numbers of a table of critical shocks: answers, intervals, first touches, runs.
fn of_table(text: &str) -> Vec<f64> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let first = header.iter().position(|name| *name == "a_crit_g").unwrap();
    lines
        .flat_map(|line| line.split(',').skip(first).take(6))
        .map(|cell| cell.parse().unwrap_or(f64::NAN))
        .collect()
}

#[test]
fn digests_of_the_committed_fig13() {
    let results = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../results");
    for name in ["fig13", "fig13-stiffness", "fig13-converged"] {
        let table = std::fs::read_to_string(results.join(name).join("table.csv")).unwrap();
        assert_digest(&format!("{name} table"), &of_table(&table));
    }
}

#[test]
#[ignore = "slow: sweeps Fig. 13, 2 minutes; make verify-digests"]
fn digests_slow_fig13_swept_anew() {
    let folder = tempfile::tempdir().unwrap();
    let at = |words: &[&str]| Done::of(folder.path(), words);
    let done = at(&["sweep", &study("fig13"), "--store", "s.opshock", "--quiet"]);
    assert!([0, 4].contains(&done.code), "{}", done.stderr);
    let table = at(&["report", "s.opshock", "--format", "csv"]).stdout;
    assert_digest("fig13 table", &of_table(&table));
}
