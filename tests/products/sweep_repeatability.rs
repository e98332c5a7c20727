//! The same table for any number of threads, any order of the study and any interruption.

use std::path::Path;
use std::time::Duration;

use opshock_study::search::Ramp;
use opshock_study::store::results;
use opshock_study::sweep::{Ending, Event, Silent, SweepEnd, SweepInput, SweepOptions, sweep};
use opshock_tests::hdf5_dump::dump;
use opshock_tests::mock_sweep::{MockSimulator, Poison, Recorder, fig13, study};

fn run(input: &SweepInput, folder: &Path, threads: usize) -> SweepEnd {
    let end = sweep(
        input,
        &MockSimulator::new(input),
        folder,
        &SweepOptions::with_threads(threads),
        &Silent,
    )
    .expect("sweeps");
    assert_eq!(end.ending, Ending::Complete);
    end
}

fn json(end: &SweepEnd) -> String {
    serde_json::to_string(&end.summary).expect("table")
}

fn results_of(folder: &Path) -> Vec<String> {
    dump(&folder.join("results.h5"), &["/machine"])
}

#[test]
fn hard_f1_table_and_results_do_not_depend_on_the_threads() {
    let input = fig13();
    let folder = tempfile::tempdir().expect("folder");
    let reference = run(&input, &folder.path().join("1"), 1);
    let content = results_of(&folder.path().join("1"));
    assert!(content.len() > 40, "{content:?}");
    for threads in [2, 3, 8, 64] {
        let other = run(&input, &folder.path().join(threads.to_string()), threads);
        assert_eq!(json(&other), json(&reference), "{threads} threads");
        assert_eq!(
            results_of(&folder.path().join(threads.to_string())),
            content
        );
    }
    let runs = reference.summary.totals.runs;
    assert!(runs <= 36 * 16, "{runs} runs for 36 points");
}

#[test]
fn missing_verdicts_do_not_let_the_threads_show() {
    let input = fig13();
    let folder = tempfile::tempdir().expect("folder");
    let run = |threads: usize| {
        let mut simulator = MockSimulator::new(&input);
        // The first points of their chains: others must do without their hints.
        simulator.poison = [
            (0, Poison::NeverConverges),
            (12, Poison::Panic),
            (35, Poison::NotANumber),
        ]
        .iter()
        .map(|&(point, poison)| (input.points[point].coordinates.clone(), poison))
        .collect();
        let place = folder.path().join(threads.to_string());
        let options = SweepOptions::with_threads(threads);
        let end = sweep(&input, &simulator, &place, &options, &Silent).expect("sweeps");
        (json(&end), results_of(&place))
    };
    let reference = run(1);
    for threads in [2, 8] {
        assert_eq!(run(threads), reference, "{threads} threads");
    }
}

#[test]
fn hard_f3_a_shuffled_study_has_the_same_rows() {
    let input = fig13();
    let mut shuffled = fig13();
    let n = input.points.len();
    // 7 is prime to 36.
    let from: Vec<usize> = (0..n).map(|i| (7 * i + 11) % n).collect();
    shuffled.points = from.iter().map(|&i| input.points[i].clone()).collect();
    let folder = tempfile::tempdir().expect("folder");
    let reference = run(&input, &folder.path().join("a"), 2);
    let other = run(&shuffled, &folder.path().join("b"), 2);
    for (row, &i) in other.summary.points.iter().zip(&from) {
        assert_eq!(row, &reference.summary.points[i]);
    }
}

#[test]
fn hard_f2_stopping_and_going_on_ends_the_same() {
    let input = study(&[Ramp::None, Ramp::Deformable], &[0.5, 1.0, 2.0]);
    let folder = tempfile::tempdir().expect("folder");
    let reference = run(&input, &folder.path().join("whole"), 2);
    let content = results_of(&folder.path().join("whole"));

    let parts = folder.path().join("parts");
    let mut computed = 0;
    let mut sittings = 0;
    loop {
        let mut simulator = MockSimulator::new(&input);
        simulator.sleep = Duration::from_millis(3);
        let options = SweepOptions {
            budget: Some(Duration::from_millis(40)),
            ..SweepOptions::with_threads(2)
        };
        let end = sweep(&input, &simulator, &parts, &options, &Silent).expect("sweeps");
        computed += end.computed_runs;
        sittings += 1;
        if end.ending == Ending::Complete {
            assert_eq!(json(&end), json(&reference));
            break;
        }
        assert_eq!(end.ending, Ending::Budget);
    }
    assert!(sittings > 2, "{sittings} sittings");
    assert_eq!(results_of(&parts), content);
    let stored = results::read(&parts.join("results.h5"))
        .expect("reads")
        .expect("is there");
    assert_eq!(
        computed,
        (stored.runs.len() + stored.outside.len()) as u64,
        "nothing is computed twice or lost"
    );
    // Once more: nothing is left to do.
    assert_eq!(run(&input, &parts, 2).computed_runs, 0);
}

#[test]
fn points_of_equal_content_share_their_runs() {
    let mut input = study(&[Ramp::None], &[0.5, 1.0]);
    let mut twins = input.points.clone();
    for twin in &mut twins {
        twin.coordinates.axes = vec!["other".into()];
    }
    let folder = tempfile::tempdir().expect("folder");
    let alone = run(&input, &folder.path().join("a"), 1);
    input.points.extend(twins);
    let simulator = MockSimulator::new(&input);
    let options = SweepOptions {
        speculate: false,
        ..SweepOptions::with_threads(1)
    };
    let both = sweep(
        &input,
        &simulator,
        &folder.path().join("b"),
        &options,
        &Silent,
    )
    .expect("sweeps");
    for (twin, first) in [(4, 0), (5, 1), (6, 2), (7, 3)] {
        assert_eq!(
            both.summary.points[twin].failed_g,
            alone.summary.points[first].failed_g
        );
    }
    assert!(both.computed_runs < both.summary.totals.runs);
}

#[test]
fn a_changed_study_reuses_what_is_still_valid() {
    let folder = tempfile::tempdir().expect("folder");
    let small = study(&[Ramp::None, Ramp::Rigid], &[0.5, 1.0, 2.0]);
    let large = study(&[Ramp::None, Ramp::Rigid], &[0.5, 1.0, 1.5, 2.0]);
    run(&small, &folder.path().join("grown"), 2);
    let grown = run(&large, &folder.path().join("grown"), 2);
    let fresh = run(&large, &folder.path().join("fresh"), 2);
    assert_eq!(json(&grown), json(&fresh));
    assert!(
        grown.computed_runs * 2 < fresh.computed_runs,
        "{} of {}",
        grown.computed_runs,
        fresh.computed_runs
    );
    assert_eq!(
        results_of(&folder.path().join("grown")),
        results_of(&folder.path().join("fresh"))
    );
}

#[test]
fn two_threads_are_kept_busy_in_spite_of_the_hints() {
    let input = fig13();
    let folder = tempfile::tempdir().expect("folder");
    let mut simulator = MockSimulator::new(&input);
    simulator.sleep = Duration::from_millis(25);
    let recorder = Recorder::default();
    let end = sweep(
        &input,
        &simulator,
        folder.path(),
        &SweepOptions::with_threads(2),
        &recorder,
    )
    .expect("sweeps");
    // Counted, not timed: a run that finds the other thread idle at both its ends is a lone one. On an
    // idle machine fewer than one in ten are; other tests that take the cores keep a thread from
    // starting its next run in time, which made it one in seven. With one thread all would be.
    let lone = simulator.calls() - simulator.accompanied();
    assert!(
        lone * 4 <= simulator.calls(),
        "{lone} of {} runs had no other beside them",
        simulator.calls()
    );
    // Speculation may not buy that with work nobody asked for.
    let wasted = end.computed_runs - end.summary.totals.runs.min(end.computed_runs);
    assert!(
        wasted * 20 <= end.computed_runs,
        "{wasted} of {} runs were not asked for",
        end.computed_runs
    );
    assert!(matches!(
        recorder.events().first(),
        Some(Event::Started { .. })
    ));
    assert!(matches!(
        recorder.events().last(),
        Some(Event::Finished { .. })
    ));
}
