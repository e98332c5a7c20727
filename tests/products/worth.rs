//! `opshock worth`: changes of critical shocks by tolerances, from the program to its files and exit codes, and against finer scenes.

use std::path::Path;

use opshock_study::population::Tolerances;
use opshock_study::search::AmplitudeGrid;
use opshock_study::study::{SetArg, Study};
use opshock_study::sweep::{Physics, ProgressKind, Silent, SweepInput, SweepOptions, Until, sweep};
use opshock_study::worth::{ENDS, FINENESS, Pair, Worth, open_store};

use crate::cli::{COARSE, Done};

const TOLERANCES: &str = r#"
tolerances_format = 1
name = "line 3"

[[tolerance]]
name = "clearance"
keys = ["ramp.clearance_um"]
normal = { mean = 100.0, sd = 5.0 }
source = "a drawing"

[[tolerance]]
name = "density of the gas"
keys = ["gas.temperature_c"]
choices = [20.0, 20.0]
source = "nothing changes"
"#;

fn done(folder: &Path, more: &[&str]) -> Done {
    let mut all = vec![
        "worth",
        "drive.toml",
        "--tolerances",
        "tolerances.toml",
        "--json",
    ];
    let sets = [
        "ramp.models=[\"rigid\"]",
        "pulse.widths_ms=[1.0]",
        "pulse.signs=[\"-\"]",
    ];
    all.extend(sets.iter().flat_map(|set| ["--set", set]));
    all.extend(COARSE);
    all.extend(more);
    Done::of(folder, &all)
}

#[test]
fn a_tolerance_without_effect_is_worth_nothing_and_clearance_is_worth_most() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("drive.toml"), Study::example("my drive")).expect("written");
    std::fs::write(folder.join("tolerances.toml"), TOLERANCES).expect("written");
    let first = done(folder, &["-j", "3", "--out", "out"]);
    assert_eq!(first.code, 0, "{}", first.stderr);
    let answer = first.json();
    let rows = answer["rows"].as_array().expect("rows");
    let names: Vec<&str> = rows.iter().filter_map(|row| row["name"].as_str()).collect();
    assert_eq!(names, ["clearance", "density of the gas"]);
    let number = |row: usize, key: &str| rows[row]["changes"][0][key].as_f64().expect(key);
    // The same scene at both ends: bit for bit no change.
    assert_eq!(number(1, "change_g"), 0.0);
    assert_eq!(rows[1]["changes"][0]["excludes_zero"], false);
    assert_eq!(rows[0]["changes"][0]["excludes_zero"], true);
    // Touch comes at an amplitude in proportion to the clearance, and failure soon after: 10 % of it are about 10 %.
    let change_g = number(0, "change_g");
    let ends = rows[0]["changes"][0]["critical_g"].as_array().expect("two");
    let ends: Vec<f64> = ends.iter().filter_map(serde_json::Value::as_f64).collect();
    assert!((change_g - (ends[1] - ends[0])).abs() < 1e-9);
    let share = change_g / ends[0];
    assert!((0.04..0.16).contains(&share), "{share}");
    // Run again, with other threads: nothing is simulated, the same answer.
    let again = done(folder, &["-j", "1"]);
    assert_eq!((again.code, &again.stdout), (0, &first.stdout));
    let csv = std::fs::read_to_string(folder.join("out/worth.csv")).expect("written");
    assert_eq!(csv.lines().count(), 3, "{csv}");
    // A key that is an axis of the study has no two values.
    let axis = done(folder, &["--set", "ramp.clearance_um=[90.0, 110.0]"]);
    assert_eq!(axis.code, 3);
    assert_eq!(axis.errors()[0]["code"], "E195");
}

/// Pairs of the study at a preset, and its tolerances.
fn pairs(preset: &str) -> (Tolerances, Vec<[Study; 2]>, Vec<Vec<Pair>>) {
    let sets = [
        "search.uncertainty=false".to_owned(),
        format!("resolution.preset=\"{preset}\""),
    ];
    let sets: Vec<SetArg> = sets.iter().map(|set| set.parse().expect("a set")).collect();
    let [study, file] =
        ["study.toml", "tolerances.toml"].map(|name| Path::new("../studies/worth").join(name));
    let nominal = Study::from_path(&study, &sets).expect("a study");
    let tolerances = Tolerances::from_path(&file, &study, &sets).expect("tolerances");
    let places = 0..tolerances.parameters.len();
    let ends = places.map(|place| tolerances.studies_at(place, ENDS).expect("studies"));
    let ends: Vec<[Study; 2]> = ends.collect();
    let folder = tempfile::tempdir().expect("a folder");
    let (worth, until) = (Worth::new(&nominal, &ends), Until::default());
    let starts = worth.starts(folder.path(), 2, &until, ProgressKind::Warnings);
    let starts = starts.unwrap_or_else(|why| panic!("{why:?}"));
    let mut store = open_store(folder.path(), &tolerances).expect("a store");
    let found = worth.simulate(&starts, &mut store, 2, &until, |_, _| {});
    (
        tolerances,
        ends.clone(),
        found.unwrap_or_else(|why| panic!("{why:?}")),
    )
}

#[test]
#[ignore = "slow: 30 pairs at two presets and 60 separate intervals, make verify-worth"]
fn worth_slow_changes_hold_those_of_finer_scenes_and_are_narrower_than_separate_ones() {
    let grid = AmplitudeGrid::for_tolerance(FINENESS).expect("a grid");
    let amplitude_g = |step: i32| grid.amplitude_g(step);
    let (tolerances, _, coarse) = pairs("coarse");
    let (_, _, finer) = pairs("standard");
    let sets: Vec<SetArg> = vec!["resolution.preset=\"coarse\"".parse().expect("a set")];
    let [study, file] =
        ["study.toml", "tolerances.toml"].map(|name| Path::new("../studies/worth").join(name));
    let separate = Tolerances::from_path(&file, &study, &sets).expect("tolerances");
    let (mut held, mut known, mut ratios) = (0, 0, Vec::new());
    for (place, (coarse, finer)) in coarse.iter().zip(&finer).enumerate() {
        let ends = separate.studies_at(place, ENDS).expect("studies");
        let intervals: Vec<Vec<Option<f64>>> = ends
            .iter()
            .map(|study| {
                let folder = tempfile::tempdir().expect("a folder");
                let input = SweepInput::of(study).expect("input");
                let options = SweepOptions::with_threads(2);
                let end = sweep(
                    &input,
                    &Physics::of(study),
                    folder.path(),
                    &options,
                    &Silent,
                );
                let rows = end.expect("sweeps").summary.points;
                rows.iter().map(|row| row.uncertainty_g).collect()
            })
            .collect();
        for (point, (coarse, finer)) in coarse.iter().zip(finer).enumerate() {
            let [found, truth] = [coarse, finer].map(|pair| pair.change_g(&amplitude_g));
            let both = intervals[0][point].zip(intervals[1][point]);
            let separate_g = both.map(|(low_g, high_g)| low_g + high_g);
            let name = &tolerances.parameters[place].name;
            println!(
                "{name}, point {point}: coarse {found:.2?}, standard {truth:.2?}, separate {separate_g:.2?} G"
            );
            if let (Some([change_g, half_g]), Some([truth_g, truth_half_g])) = (found, truth) {
                known += 1;
                // What the finer answer lacks itself is no fault of the coarser.
                held += u32::from((change_g - truth_g).abs() <= half_g + truth_half_g);
                ratios.extend(separate_g.map(|separate_g| separate_g / half_g));
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    println!(
        "{held} of {known} hold the finer change; separate intervals are {:.1} times as wide (median of {})",
        ratios[ratios.len() / 2],
        ratios.len()
    );
    assert!(known >= 20 && 100 * held >= 89 * known, "{held} of {known}");
    assert!(ratios[ratios.len() / 2] >= 3.0);
}
