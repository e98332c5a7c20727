//! Sweeps over several clearances called failure: their searches share runs, and the answers are those of each alone.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_study::search::{Probe, ProbeResult, Verdict};
use opshock_study::store::{Flag, Summary, load};
use opshock_study::study::Study;
use opshock_study::sweep::{
    Ending, Onset, Physics, Silent, Simulator, SweepInput, SweepOptions, sweep,
};
use opshock_tests::scenes;

/// Physics that counts its simulations.
struct Counted {
    physics: Physics,
    runs: AtomicUsize,
}

impl Simulator for Counted {
    fn simulate(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> ProbeResult {
        self.runs.fetch_add(1, Ordering::Relaxed);
        self.physics.simulate(point, probe, amplitude_m_per_s2)
    }

    fn onset(&self, point: usize) -> Onset {
        self.physics.onset(point)
    }
}

/// No ramp and, without intervals, a rigid one, both signs, for these clearances, nm.
fn study_of(clearances: &str, intervals: bool) -> Study {
    let ramps = if intervals {
        "[\"none\"]"
    } else {
        "[\"none\", \"rigid\"]"
    };
    scenes::study(
        "fig13",
        &[
            ("pulse.widths_ms", "[2.0]"),
            ("ramp.models", ramps),
            ("failure.clearance_nm", clearances),
            ("resolution.preset", "\"coarse\""),
            ("resolution.film_cells", "200"),
            ("resolution.disk_cut_khz", "10"),
            ("search.uncertainty", &intervals.to_string()),
            ("search.max_refinements", "0"),
        ],
    )
}

/// Rows of a sweep, and the number of simulations it made.
fn swept(study: &Study, folder: &Path, threads: usize) -> (Summary, usize) {
    let input = SweepInput::of(study).expect("input");
    let simulator = Counted {
        physics: Physics::of(study),
        runs: AtomicUsize::new(0),
    };
    let mut options = SweepOptions::with_threads(threads);
    options.speculate = false;
    let end = sweep(&input, &simulator, folder, &options, &Silent).expect("sweeps");
    assert_eq!(end.ending, Ending::Complete);
    (end.summary, simulator.runs.into_inner())
}

#[test]
fn four_clearances_take_few_more_runs_than_one_and_have_the_answers_of_each_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let clearances = ["0.0", "0.3", "0.6", "1.0"];
    let study = study_of(&format!("[{}]", clearances.join(", ")), false);
    let shared = folder.path().join("shared.opshock");
    let (together, runs) = swept(&study, &shared, 1);
    let (on_three, _) = swept(&study, &folder.path().join("three.opshock"), 3);
    assert_eq!(together.points, on_three.points);
    assert_eq!(together.points.len(), 16);
    let mut alone = Vec::new();
    let mut runs_alone = Vec::new();
    for clearance in clearances {
        let one = study_of(&format!("[{clearance}]"), false);
        let (summary, runs) = swept(&one, &folder.path().join(clearance), 1);
        alone.extend(summary.points);
        runs_alone.push(runs);
    }
    let mut lower = 0;
    for row in &together.points {
        let key = |row: &opshock_study::store::PointSummary| {
            (row.ramp.clone(), row.sign, row.axes.clone())
        };
        let own = alone
            .iter()
            .find(|own| key(own) == key(row))
            .expect("a row");
        assert_eq!(
            (row.survived_g, row.failed_g, row.status),
            (own.survived_g, own.failed_g, own.status),
            "{:?}",
            key(row)
        );
        assert_eq!(
            row.flags.contains(&Flag::Window),
            own.flags.contains(&Flag::Window)
        );
        lower += usize::from(row.runs < own.runs);
    }
    println!("{runs} simulations together, {runs_alone:?} alone; {lower} rows with fewer probes");
    assert!(
        2 * runs <= 5 * runs_alone[0],
        "{runs} simulations for four clearances, {runs_alone:?} for each"
    );

    // Every run in the store, those taken from another clearance included, is what a simulation of the point gives.
    let input = SweepInput::of(&study).expect("input");
    let physics = Physics::of(&study);
    let (loaded, _) = load(&shared).expect("loads");
    let mut taken = 0;
    for (key, record) in &loaded.runs {
        let is_of = |point: &opshock_study::sweep::SweepPoint| point.digest == key.point;
        let point = input.points.iter().position(is_of).expect("a point");
        let amplitude_m_per_s2 = f64::from_bits(key.amplitude_bits);
        let probe = Probe {
            window_factor: key.window_factor,
            ..Probe::at(0)
        };
        let again = physics.simulate(point, probe, amplitude_m_per_s2);
        let at = format!(
            "{point} at {} G",
            amplitude_m_per_s2 / STANDARD_GRAVITY_M_PER_S2
        );
        assert_eq!(record.result, again, "{at}");
        taken += usize::from(matches!(record.result.verdict, Verdict::Survives));
    }
    println!(
        "{} runs in the store, {taken} of them survivors",
        loaded.runs.len()
    );
    assert!(
        loaded.runs.len() > runs,
        "nothing was taken from another clearance"
    );
}

#[test]
fn intervals_of_four_clearances_are_those_of_each_alone_and_share_what_survives() {
    let folder = tempfile::tempdir().expect("a folder");
    let clearances = ["0.0", "0.3", "0.6", "1.0"];
    let study = study_of(&format!("[{}]", clearances.join(", ")), true);
    let shared = |threads: usize| {
        let store = folder.path().join(format!("{threads}.opshock"));
        let (summary, runs) = swept(&study, &store, threads);
        let (_, results) = load(&store).expect("loads");
        (summary, runs, results.expect("written").content_digest())
    };
    let (together, runs, digest) = shared(1);
    let (on_three, _, digest_of_three) = shared(3);
    assert_eq!(together, on_three);
    assert_eq!(digest, digest_of_three);

    let (mut alone, mut runs_alone) = (Vec::new(), 0);
    for clearance in clearances {
        let one = study_of(&format!("[{clearance}]"), true);
        let (summary, runs) = swept(&one, &folder.path().join(clearance), 1);
        alone.extend(summary.points);
        runs_alone += runs;
    }
    let mut with_interval = 0;
    for row in &together.points {
        let place = |row: &opshock_study::store::PointSummary| {
            (row.ramp.clone(), row.sign, row.axes.clone())
        };
        let mut own = alone.iter().filter(|own| place(own) == place(row));
        let own = own.next().expect("a row").clone();
        with_interval += usize::from(row.uncertainty_g.is_some());
        // How many runs a row takes, and what a search scanned beside its bracket, is its own affair.
        let numbers = |row: &opshock_study::store::PointSummary| {
            (
                [row.a_crit_g, row.uncertainty_g, row.half_min_height_g],
                [row.survived_g, row.failed_g],
                row.contributions.clone(),
            )
        };
        assert_eq!(numbers(row), numbers(&own), "{:?}", place(row));
    }
    println!("{runs} simulations together, {runs_alone} alone; {with_interval} intervals");
    assert_eq!(with_interval, 8);
    assert!(6 * runs < 5 * runs_alone, "{runs} of {runs_alone}");
}
