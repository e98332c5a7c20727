//! Uncertainty intervals of a whole sweep: threads, interruption, coverage, cost.

use std::path::Path;
use std::time::Duration;

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::discretisation::{Discretisation, Levels};
use opshock_study::report::comparison::Significance;
use opshock_study::report::{critical_shock_figure, table};
use opshock_study::search::{Flag, Probe, Purpose, Retry, Status};
use opshock_study::store::results;
use opshock_study::store::summary::{Contribution, PointSummary};
use opshock_study::study::Ramp;
use opshock_study::sweep::{
    Ending, Event, Physics, Silent, Simulator, SweepEnd, SweepInput, SweepOptions, sweep,
};
use opshock_tests::hdf5_dump::dump;
use opshock_tests::mock_sweep::Recorder;
use opshock_tests::mock_uncertainty::{LawSimulator, laws_study};
use opshock_tests::scenes::study;

fn run(input: &SweepInput, laws: &LawSimulator, folder: &Path, threads: usize) -> SweepEnd {
    let options = SweepOptions::with_threads(threads);
    let end = sweep(input, laws, folder, &options, &Silent).expect("sweeps");
    assert_eq!(end.ending, Ending::Complete);
    end
}

fn table(end: &SweepEnd) -> String {
    serde_json::to_string(&end.summary).expect("table")
}

/// Distance of the truth from the reported value and half the interval, both G; whether it is inside.
fn covered(row: &PointSummary, exact_g: f64) -> (f64, f64, bool) {
    let a_crit_g = row.a_crit_g.expect("bracketed");
    let half_g = row.uncertainty_g.expect("an interval");
    let off_g = (a_crit_g - exact_g).abs();
    (off_g, half_g, off_g <= half_g)
}

/// Share of the truths inside their intervals, and the median of half interval over true error.
fn coverage(rows: &[PointSummary], exact_g: impl Iterator<Item = f64>) -> (f64, f64) {
    let all: Vec<_> = rows
        .iter()
        .zip(exact_g)
        .map(|(row, exact_g)| covered(row, exact_g))
        .collect();
    let inside = all.iter().filter(|one| one.2).count() as f64 / all.len() as f64;
    let mut ratios: Vec<f64> = all.iter().map(|one| one.1 / one.0.max(1e-9)).collect();
    ratios.sort_by(f64::total_cmp);
    (inside, ratios[ratios.len() / 2])
}

#[test]
fn uncertainties_do_not_depend_on_threads_nor_on_interruption() {
    let (input, laws) = (laws_study(12), LawSimulator::of(100, 12));
    let folder = tempfile::tempdir().expect("folder");
    let at = |name: &str| folder.path().join(name);
    let reference = run(&input, &laws, &at("1"), 1);
    let content = dump(&at("1").join("results.h5"), &["/machine"]);
    assert!(reference.summary.totals.uncertainty_runs > 50);
    for threads in [2, 8] {
        let name = threads.to_string();
        let other = run(&input, &laws, &at(&name), threads);
        assert_eq!(table(&other), table(&reference));
        assert_eq!(dump(&at(&name).join("results.h5"), &["/machine"]), content);
    }
    // Stopped again and again, and then without its journal.
    let mut options = SweepOptions::with_threads(2);
    options.budget = Some(Duration::from_millis(1));
    let mut sittings = 0;
    loop {
        let end = sweep(&input, &laws, &at("cut"), &options, &Silent).expect("sweeps");
        sittings += 1;
        if end.ending == Ending::Complete {
            assert_eq!(table(&end), table(&reference));
            break;
        }
        options.budget = options.budget.map(|budget| budget.mul_f64(1.3));
    }
    assert!(sittings > 1);
    std::fs::remove_file(at("cut").join("journal")).expect("a journal");
    let again = run(&input, &laws, &at("cut"), 2);
    assert_eq!(again.computed_runs, 0);
    assert_eq!(table(&again), table(&reference));
}

#[test]
fn runs_of_uncertainty_are_labelled_and_switched_off_by_the_plan() {
    let (mut input, laws) = (laws_study(2), LawSimulator::of(3, 2));
    let folder = tempfile::tempdir().expect("folder");
    let with = run(&input, &laws, &folder.path().join("with"), 2);
    let stored = results::read(&folder.path().join("with/results.h5"))
        .expect("reads")
        .expect("is there");
    for row in &stored.runs {
        let is_uncertainty = row.purpose == Purpose::Uncertainty;
        // A interval may narrow the bracket of the scene itself; nothing else changes discretisation parameters.
        assert!(is_uncertainty || row.levels.is_none(), "{row:?}");
    }
    assert_eq!(stored.summary, with.summary);
    for point in &mut input.points {
        point.uncertainty = None;
    }
    let without = run(&input, &laws, &folder.path().join("without"), 2);
    assert_eq!(without.summary.totals.uncertainty_runs, 0);
    for (with, without) in with.summary.points.iter().zip(&without.summary.points) {
        // An interval may narrow the bracket.
        let [bracket, wider] = [with, without].map(|point| point.bracket_g().expect("bracketed"));
        assert!(bracket[0] >= wider[0] && bracket[1] <= wider[1]);
        let sum = |of: fn(&Contribution) -> f64| -> f64 {
            with.contributions.iter().map(|(_, part)| of(part)).sum()
        };
        let [low_g, high_g] = with.interval_g().expect("an interval");
        let survived_g = with.survived_g.expect("bracketed");
        assert!((survived_g - low_g - sum(|part| part.low_g)).abs() < 1e-9 * survived_g);
        assert!((high_g - survived_g - sum(|part| part.high_g)).abs() < 1e-9 * survived_g);
        let [low_g, high_g] = without.bracket_g().expect("bracketed");
        assert_eq!(without.a_crit_g, Some(f64::midpoint(low_g, high_g)));
        // The bracket alone is no error.
        assert_eq!(without.contributions, []);
        assert_eq!(without.uncertainty_g, None);
    }
}

/// A sweep without uncertainty intervals gave `-0.0 +5.0`, the width of the bracket, where the same with them gave `-9.3 +9.4`.
#[test]
fn an_error_that_was_not_computed_is_absent_in_every_product() {
    let (mut input, laws) = (laws_study(1), LawSimulator::of(3, 1));
    let folder = tempfile::tempdir().expect("folder");
    let with = run(&input, &laws, &folder.path().join("with"), 1).summary;
    for point in &mut input.points {
        point.uncertainty = None;
    }
    let store = folder.path().join("without");
    let without = run(&input, &laws, &store, 1).summary;
    let row = &without.points[0];
    assert_eq!(row.status, Status::Ok);

    let csv = table::csv(&without);
    let (header, cells) = csv.split_once('\n').expect("a row");
    let cell = |name: &str| {
        let place = header.split(',').position(|column| column == name);
        cells.split(',').nth(place.expect("a column"))
    };
    assert_eq!(cell("a_crit_g"), Some(&*row.a_crit_g.unwrap().to_string()));
    assert_eq!(cell("uncertainty_g"), Some(""));
    let json = serde_json::to_value(&without).expect("JSON");
    assert!(json["points"][0]["uncertainty_g"].is_null());
    assert_eq!(json["points"][0]["contributions"], serde_json::json!({}));
    for text in [table::terminal(&without), table::markdown(&without, "", "")] {
        assert!(!text.contains("+-"), "{text}");
    }
    let file = hdf5::File::open(store.join("results.h5")).expect("opens");
    let column = |name: &str| {
        let set = file.dataset(&format!("points/{name}")).expect("a column");
        set.read_raw::<f64>().expect("reads")[0]
    };
    assert!(column("uncertainty_g").is_nan());
    drop(file);
    let stored = results::read(&store.join("results.h5")).expect("reads");
    assert_eq!(stored.expect("is there").summary, without);

    let figure = critical_shock_figure(&without, "");
    assert!(
        figure
            .subtitle
            .ends_with("no interval: uncertainty not known")
    );
    let sample = &figure.panels[0].series[0].samples[0];
    assert!(
        sample.note.contains("uncertainty not known"),
        "{}",
        sample.note
    );

    // Two grid points apart: beyond the brackets, which decides nothing about errors.
    let mut other = row.clone();
    for value in [
        &mut other.a_crit_g,
        &mut other.survived_g,
        &mut other.failed_g,
    ] {
        *value = value.map(|g| 1.05 * g);
    }
    assert_eq!(Significance::of(row, &other), Significance::BeyondBrackets);
    assert_eq!(
        Significance::of(&with.points[0], &other),
        Significance::BeyondBrackets
    );
}

#[test]
fn what_is_left_counts_the_runs_of_uncertainty() {
    let (mut input, laws) = (laws_study(6), LawSimulator::of(40, 6));
    for point in &mut input.points {
        point.uncertainty.as_mut().expect("a interval").refinements = 2;
    }
    let folder = tempfile::tempdir().expect("folder");
    let recorder = Recorder::default();
    let options = SweepOptions::with_threads(1);
    let end = sweep(&input, &laws, folder.path(), &options, &recorder).expect("sweeps");
    let totals = &end.summary.totals;
    assert!(totals.uncertainty_runs > totals.runs / 2, "{totals:?}");
    let (mut all, mut reported) = (0, Vec::new());
    for event in recorder.events() {
        match event {
            Event::ProbeDone { .. } => all += 1,
            Event::Estimated(estimate) => reported.push((all, estimate)),
            _ => {}
        }
    }
    // Estimates rest from time to time; the first and the last come in any case.
    for (done, estimate) in [reported.first(), reported.last()].into_iter().flatten() {
        assert_eq!(
            estimate.runs_left.max == 0.0,
            *done == all,
            "{done} of {all}: {estimate:?}"
        );
    }
    assert_eq!(reported.last().map(|last| last.0), Some(all));
}

#[test]
fn a_retry_of_a_refined_scene_keeps_its_discretisations_and_takes_finer_steps() {
    let sets = [
        ("ramp.models", "[\"none\"]"),
        ("pulse.signs", "[\"+\"]"),
        ("pulse.widths_ms", "[0.5]"),
        ("pulse.window_ms", "1.0"),
        ("resolution.film_cells", "240"),
    ];
    let study = study("fig13-stiffness", &sets);
    let physics = Physics::of(&study);
    let cost = |film: i8, retry: Retry| {
        let probe = Probe {
            is_fine: true,
            levels: Levels::NONE.changed(Discretisation::FilmGrid, film),
            retry,
            ..Probe::at(0)
        };
        physics.simulate(0, probe, m_per_s2_from_g(200.0)).cost
    };
    let (plain, changed) = (cost(0, Retry::None), cost(-1, Retry::None));
    let retried = cost(-1, Retry::HalfStep);
    assert!(changed.film_unknowns < plain.film_unknowns);
    assert_eq!(retried.film_unknowns, changed.film_unknowns);
    // Half the step of the structure, an eighth of the head's local error: twice the steps of either.
    assert_eq!(retried.structure_steps, 2 * changed.structure_steps);
    let ratio = retried.steps as f64 / changed.steps as f64;
    assert!((1.5..2.6).contains(&ratio), "{ratio}");
}

/// A coarser mesh of the ramp is the study with elements of twice the size: the same motion, bit by bit.
#[test]
fn a_coarsened_ramp_is_the_study_with_larger_elements() {
    let simulated = |size_mm: &str, mesh: i8| {
        let sets = [
            ("ramp.models", "[\"deformable\"]"),
            ("ramp.deformable.geometry.mesh_size_mm", size_mm),
            ("pulse.signs", "[\"+\"]"),
            ("pulse.widths_ms", "[1.0]"),
            ("pulse.window_ms", "1.5"),
            ("resolution.film_cells", "240"),
            ("resolution.disk_cut_khz", "10"),
        ];
        let study = study("fig13-geometry", &sets);
        let probe = Probe {
            is_fine: true,
            levels: Levels::NONE.changed(Discretisation::RampMesh, mesh),
            ..Probe::at(0)
        };
        Physics::of(&study).simulate(0, probe, m_per_s2_from_g(330.0))
    };
    let own = simulated("1.5", 0);
    let coarser = simulated("1.5", -1);
    assert_eq!(coarser, simulated("3.0", 0));
    assert_ne!(coarser.h_min_m, own.h_min_m);
}

/// A store keeps the runs of a point: another mesh is another point, also where both ramps move alike.
#[test]
fn what_a_ramp_is_remeshed_from_is_content_of_its_points() {
    let of = |size_mm: &str| {
        let sets = [
            ("ramp.models", "[\"rigid\", \"deformable\"]"),
            ("ramp.deformable.geometry.mesh_size_mm", size_mm),
            ("pulse.signs", "[\"+\"]"),
            ("pulse.widths_ms", "[1.0]"),
        ];
        let study = study("fig13-geometry", &sets);
        let input = SweepInput::of(&study).expect("a sweep");
        let scenes: Vec<_> = study
            .table_order()
            .into_iter()
            .map(|place| study.points[place].scene.clone())
            .collect();
        let digests: Vec<_> = input.points.iter().map(|point| point.digest).collect();
        (scenes, digests)
    };
    let (one, other) = (of("3.0"), of("2.99"));
    assert_eq!(one, of("3.0"));
    // As many elements, so the same oscillators; halved again they would not be.
    assert_eq!(one.0, other.0);
    assert_eq!(one.1[0], other.1[0], "rigid");
    assert_ne!(one.1[1], other.1[1], "deformable");
}

/// Only a deformable ramp from geometry has a mesh to turn.
#[test]
fn the_mesh_is_a_discretisation_of_ramps_from_geometry_alone() {
    for (name, has_mesh) in [("fig13-stiffness", false), ("fig13-geometry", true)] {
        let study = study(name, &[]);
        let input = SweepInput::of(&study).expect("a sweep");
        for (place, point) in study.table_order().into_iter().zip(&input.points) {
            let ramp = study.points[place].ramp;
            let discretisations = &point
                .uncertainty
                .as_ref()
                .expect("intervals")
                .discretisations;
            let expected = has_mesh && ramp == Ramp::Deformable;
            assert_eq!(
                discretisations.contains(&Discretisation::RampMesh),
                expected,
                "{name} {ramp}"
            );
        }
    }
}

fn known_laws(first: u64, n: usize) -> (f64, f64) {
    let (input, laws) = (laws_study(n), LawSimulator::of(first, n));
    let folder = tempfile::tempdir().expect("folder");
    let end = run(&input, &laws, folder.path(), 2);
    for (row, law) in end.summary.points.iter().zip(&laws.0) {
        let (error_g, half_g, inside) = covered(row, law.exact_g);
        if !inside {
            println!(
                "{error_g:.3} G off, half interval {half_g:.3} G: {law:?} {:?}",
                row.contributions
            );
        }
        assert!(!row.flags.contains(&Flag::ContributionMissing), "{row:?}");
    }
    coverage(&end.summary.points, laws.0.iter().map(|law| law.exact_g))
}

#[test]
fn the_truth_lies_inside_the_uncertainty_of_known_laws() {
    let (inside, median) = known_laws(1, 60);
    println!(
        "60 laws: {:.1} % inside, median interval {median:.2} times the error",
        100.0 * inside
    );
    assert!(inside >= 0.95, "{inside}");
    assert!(median <= 10.0, "{median}");
}

mod coverage;
mod fig13_truths;
mod hard_contact;
mod random_drives;
mod truths;
mod verify;
