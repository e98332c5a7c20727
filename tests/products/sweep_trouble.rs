//! Sweeps with simulations that fail: trouble stays in its point, and what is reported is on the disk.

use std::path::PathBuf;
use std::sync::Mutex;

use hdf5::types::VarLenUnicode;
use opshock_study::search::{Flag, Ramp, Status};
use opshock_study::store::summary::{AxisValue, PointSummary};
use opshock_study::store::{Record, RunRecord, Store, folder::session, journal};
use opshock_study::sweep::{Event, Progress, Silent, SweepOptions, SweepPoint, sweep};
use opshock_tests::mock_sweep::{MockSimulator, Poison, Recorder, digest, study};

#[test]
fn hard_f4_poisoned_points_do_not_touch_their_neighbours() {
    let ramps = [Ramp::None, Ramp::Rigid, Ramp::Deformable];
    let input = study(&ramps, &[0.5, 1.0, 2.0]);
    let folder = tempfile::tempdir().expect("folder");
    let options = SweepOptions::with_threads(2);
    let clean = sweep(
        &input,
        &MockSimulator::new(&input),
        &folder.path().join("clean"),
        &options,
        &Silent,
    )
    .expect("sweeps");

    // The last width of each chain in canonical order: nobody takes a hint from them.
    let poisoned = [
        (8, Poison::Panic),
        (9, Poison::NotANumber),
        (15, Poison::NeverConverges),
    ];
    let mut simulator = MockSimulator::new(&input);
    simulator.poison = poisoned
        .iter()
        .map(|&(point, poison)| (input.points[point].coordinates.clone(), poison))
        .collect();
    let sick = sweep(
        &input,
        &simulator,
        &folder.path().join("sick"),
        &options,
        &Silent,
    )
    .expect("sweeps");
    let mut causes = Vec::new();
    for (place, (row, well)) in sick
        .summary
        .points
        .iter()
        .zip(&clean.summary.points)
        .enumerate()
    {
        if poisoned.iter().any(|&(point, _)| point == place) {
            assert_eq!(row.status, Status::Undecided, "{place}");
            assert_eq!(row.failed_g, None);
            causes.push(row.flags.clone());
        } else {
            // A point that learns from a sick one starts its search elsewhere: the same answer
            // from other runs.
            let answer = |row: &PointSummary| PointSummary {
                runs: 0,
                scanned_from_g: None,
                largest_gap_pct: None,
                ..row.clone()
            };
            assert_eq!(answer(row), answer(well));
        }
    }
    assert_eq!(
        causes,
        [
            vec![Flag::UndecidedAmplitude, Flag::Panicked],
            vec![Flag::UndecidedAmplitude, Flag::NotFinite],
            vec![Flag::UndecidedAmplitude, Flag::NotConverged],
        ]
    );

    // A cure: only what had no verdict runs again, and the table is that of a clean sweep.
    let cure = SweepOptions {
        retry_undecided: true,
        ..options
    };
    let cured = sweep(
        &input,
        &MockSimulator::new(&input),
        &folder.path().join("sick"),
        &cure,
        &Silent,
    )
    .expect("sweeps");
    assert_eq!(cured.summary, clean.summary);
    assert!(cured.computed_runs < 60, "{}", cured.computed_runs);
}

/// Looks at the journal at every event.
struct Auditor {
    journal: PathBuf,
    reported: Mutex<usize>,
}

impl Progress for Auditor {
    fn event(&self, event: &Event) {
        if let Event::ProbeDone { .. } = event {
            let mut reported = self.reported.lock().expect("not poisoned");
            *reported += 1;
            let content = journal::read(&self.journal)
                .expect("reads")
                .expect("is there");
            let runs = content
                .records
                .iter()
                .filter(|record| matches!(record, Record::Run(_)))
                .count();
            assert!(content.damage.is_empty());
            assert!(runs >= *reported, "{reported} reported, {runs} on the disk");
        }
    }
}

#[test]
fn what_is_reported_is_on_the_disk() {
    let input = study(&[Ramp::None, Ramp::Rigid], &[1.0]);
    let folder = tempfile::tempdir().expect("folder");
    let auditor = Auditor {
        journal: folder.path().join("journal"),
        reported: Mutex::new(0),
    };
    let end = sweep(
        &input,
        &MockSimulator::new(&input),
        folder.path(),
        &SweepOptions::with_threads(2),
        &auditor,
    )
    .expect("sweeps");
    let reported = *auditor.reported.lock().expect("not poisoned") as u64;
    assert_eq!(reported, end.summary.totals.runs);
}

#[test]
fn a_failure_found_outside_the_search_is_reported_and_not_used() {
    let input = study(&[Ramp::None], &[1.0]);
    let folder = tempfile::tempdir().expect("folder");
    let options = SweepOptions::with_threads(1);
    let simulator = MockSimulator::new(&input);
    let first = sweep(&input, &simulator, folder.path(), &options, &Silent).expect("sweeps");

    let (mut store, loaded) = Store::open(folder.path(), &input.texts, &session(1)).expect("opens");
    let failure: &RunRecord = loaded
        .runs
        .values()
        .find(|run| run.result.verdict.as_str() == "fails")
        .expect("a failure");
    let mut lucky = failure.clone();
    let sign = f64::from_bits(lucky.key.amplitude_bits).signum();
    lucky.key.amplitude_bits = (sign * 9.80665 * 100.3).to_bits();
    store.append(&[Record::Run(lucky)]).expect("appends");
    drop(store);

    let recorder = Recorder::default();
    let second = sweep(&input, &simulator, folder.path(), &options, &recorder).expect("sweeps");
    assert_eq!(second.summary, first.summary);
    assert_eq!(recorder.warnings(), ["lucky"]);
}

#[test]
fn the_histories_of_the_bracket_are_kept_once() {
    let input = study(&[Ramp::None, Ramp::Rigid], &[0.5, 2.0]);
    let folder = tempfile::tempdir().expect("folder");
    let mut simulator = MockSimulator::new(&input);
    simulator.records = true;
    let options = SweepOptions::with_threads(2);
    let run = || sweep(&input, &simulator, folder.path(), &options, &Silent).expect("sweeps");
    let end = run();
    let files = || {
        let mut names: Vec<String> = std::fs::read_dir(folder.path().join("histories"))
            .expect("folder")
            .map(|entry| {
                entry
                    .expect("entry")
                    .file_name()
                    .into_string()
                    .expect("text")
            })
            .collect();
        names.sort();
        names
    };
    let kept = files();
    assert_eq!(kept.len(), 2 * end.summary.points.len(), "{kept:?}");
    let failure = end.summary.points[0].failed_g.expect("bracketed");
    let name = kept
        .iter()
        .find(|name| name.starts_with(&format!("none_0.5ms_plus_{failure:.3}g_")))
        .expect("the failure of the first point");
    let file = hdf5::File::open(folder.path().join("histories").join(name)).expect("HDF5");
    let t_fail_s: f64 = file
        .attr("t_fail_s")
        .expect("attribute")
        .read_scalar()
        .expect("number");
    assert!((t_fail_s - (5e-4 + 1e-3 / failure)).abs() < 1e-12);
    let calls = simulator.calls();
    run();
    assert_eq!(simulator.calls(), calls, "nothing is recorded twice");
    assert_eq!(files(), kept);
}

/// Names of histories carry the study's further axes, points of equal content share one, and files named without the
/// axes, as earlier programs did, are used.
#[test]
fn histories_are_named_by_their_place_and_by_the_runs_that_they_are_of() {
    let mut input = study(&[Ramp::None, Ramp::Rigid], &[0.5]);
    let points = input.points.clone();
    input.axes = vec!["clearance_um".into(), "head".into()];
    let place = |clearance_um: f64, point: &SweepPoint| SweepPoint {
        axes: vec![
            AxisValue::Number(clearance_um),
            AxisValue::Text("0 up".into()),
        ],
        ..point.clone()
    };
    // Without a ramp the clearance changes nothing.
    let far = points.iter().map(|point| {
        let mut point = place(100.5, point);
        point.coordinates.axes = vec!["far".into()];
        if point.coordinates.ramp != Ramp::None {
            point.digest = digest(&format!("far {}", point.digest.hex()));
        }
        point
    });
    input.points = points
        .iter()
        .map(|point| place(80.0, point))
        .chain(far)
        .collect();
    let folder = tempfile::tempdir().expect("folder");
    let mut simulator = MockSimulator::new(&input);
    simulator.records = true;
    let options = SweepOptions::with_threads(1);
    let run = || sweep(&input, &simulator, folder.path(), &options, &Silent).expect("sweeps");
    let end = run();
    let column = || -> Vec<(u64, f64, String)> {
        let file = hdf5::File::open(folder.path().join("results.h5")).expect("opens");
        let place: Vec<u64> = file.dataset("runs/point").unwrap().read_raw().unwrap();
        let amplitude: Vec<f64> = file
            .dataset("runs/amplitude_g")
            .unwrap()
            .read_raw()
            .unwrap();
        let history = file.dataset("runs/history").unwrap();
        let history = history.read_raw::<VarLenUnicode>().unwrap();
        let rows = place.into_iter().zip(amplitude).zip(history);
        rows.map(|((place, amplitude), name)| (place, amplitude, name.to_string()))
            .collect()
    };
    for (place, row) in (0..).zip(&end.summary.points) {
        let clearance = match (row.ramp.as_str(), &row.axes[0]) {
            ("none", _) => "80",
            (_, AxisValue::Number(number)) if *number == 80.0 => "80",
            _ => "100.5",
        };
        let sign = if row.sign.as_str() == "+" {
            "plus"
        } else {
            "minus"
        };
        for amplitude_g in [row.survived_g.unwrap(), row.failed_g.unwrap()] {
            let rows = column();
            let named = rows
                .iter()
                .filter(|run| (run.0, run.1) == (place, amplitude_g));
            let start = format!(
                "histories/{}_0.5ms_{sign}_clearance_um={clearance}_head=0-up_{amplitude_g:.3}g_",
                row.ramp
            );
            let named: Vec<&String> = named
                .map(|run| &run.2)
                .filter(|name| !name.is_empty())
                .collect();
            assert!(!named.is_empty(), "{place} {amplitude_g}");
            for name in named {
                assert!(name.starts_with(&start), "{name} {start}");
                assert!(folder.path().join(name).is_file(), "{name}");
            }
        }
    }
    let kept: std::collections::BTreeSet<String> = column().into_iter().map(|run| run.2).collect();
    // Both ends of two points without a ramp and of four with one, and the runs without a file.
    assert_eq!(kept.len(), 2 * (2 + 4) + 1, "{kept:?}");

    let calls = simulator.calls();
    for name in kept.iter().filter(|name| !name.is_empty()) {
        let (start, rest) = name.split_once("_clearance_um=").unwrap();
        let (_, end) = rest.split_once("_head=0-up").unwrap();
        std::fs::rename(
            folder.path().join(name),
            folder.path().join(format!("{start}{end}")),
        )
        .unwrap();
    }
    run();
    assert_eq!(simulator.calls(), calls, "nothing is recorded twice");
    let names: Vec<String> = column().into_iter().map(|run| run.2).collect();
    assert!(names.iter().all(|name| !name.contains("clearance")));
    assert_eq!(
        names
            .iter()
            .collect::<std::collections::BTreeSet<_>>()
            .len(),
        kept.len()
    );
}
