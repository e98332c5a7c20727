//! The mechanism of a point's lowest failure in its history and on the page of a report is that of `opshock run`.

use std::path::Path;

use hdf5::types::VarLenUnicode;

use crate::cli::{Done, study};
use opshock_tests::coarse;

#[test]
fn a_sweep_names_the_mechanisms_that_run_names() {
    let folder = tempfile::tempdir().unwrap();
    let file = study("fig13");
    let file = file.to_str().unwrap();
    let mut sets = vec![
        "pulse.widths_ms=[0.5]",
        "ramp.models=[\"none\", \"rigid\"]",
        "output.keep_histories=\"bracket\"",
    ];
    sets.extend(coarse::SEARCH);
    let sets: Vec<&str> = sets.into_iter().flat_map(|set| ["--set", set]).collect();
    let at = |words: &[&str]| Done::of(folder.path(), &[words, &sets].concat());
    let done = at(&["sweep", file, "--store", "s.opshock", "--quiet"]);
    assert!([0, 4].contains(&done.code), "{}", done.stderr);
    Done::of(folder.path(), &["report", "s.opshock", "--out", "out"]);
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).unwrap();

    let results = hdf5::File::open(Path::new(folder.path()).join("out/results.h5")).unwrap();
    let words = |name: &str| -> Vec<String> {
        let column: Vec<VarLenUnicode> = results.dataset(name).unwrap().read_raw().unwrap();
        column.iter().map(ToString::to_string).collect()
    };
    let points: Vec<u64> = results.dataset("runs/point").unwrap().read_raw().unwrap();
    let amplitudes: Vec<f64> = results
        .dataset("runs/amplitude_g")
        .unwrap()
        .read_raw()
        .unwrap();
    let [ramps, signs, histories] = ["points/ramp", "points/sign", "runs/history"].map(words);
    let mut named = 0;
    for (place, file_of_run) in histories.iter().enumerate() {
        if file_of_run.is_empty() {
            continue;
        }
        let history = hdf5::File::open(folder.path().join("s.opshock").join(file_of_run)).unwrap();
        let mechanism: VarLenUnicode = history.attr("mechanism").unwrap().read_scalar().unwrap();
        let mechanism = mechanism.to_string();
        if mechanism.is_empty() {
            continue;
        }
        named += 1;
        let point = points[place] as usize;
        let amplitude_g = amplitudes[place].to_string();
        let run = [
            "run",
            file,
            "--json",
            "--ramp",
            &ramps[point],
            "--pulse-ms",
            "0.5",
            "--sign",
            &signs[point],
            "--amplitude-g",
            &amplitude_g,
        ];
        let shown = at(&run).json();
        assert_eq!(shown["mechanism"]["name"], mechanism.as_str(), "{run:?}");
        let name = mechanism.replace('_', " ");
        assert!(page.contains(&format!("<td>{name}</td>")), "{name}");
        assert!(page.contains(&format!("fails: {name}")), "{name}");
    }
    // The lowest failure of every point.
    assert_eq!(named, 4);
}
