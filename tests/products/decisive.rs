//! Sweeps that give uncertainty intervals to decisive points alone: which points, whatever the threads, interruptions and
//! shards, and the same answer as with all intervals.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_solver::scene::discretisation::{Discretisation, Levels};
use opshock_study::qualification::{PointVerdict, Verdict as Found};
use opshock_study::report::answer::Answer;
use opshock_study::report::comparison::Significance;
use opshock_study::search::decisive::Question;
use opshock_study::search::{Flag, MonotonicityScan, Probe, ProbeResult, Ramp, RunCost, Verdict};
use opshock_study::store::{AxisValue, Loaded, Status, Summary, folder, load};
use opshock_study::study::{SetArg, Study};
use opshock_study::sweep::{
    Ending, MergeEnd, Onset, Shard, Silent, Simulator, SweepEnd, SweepInput, SweepOptions,
    UncertaintyPlan, forecast, merge, shard, sweep,
};
use opshock_tests::mock_sweep::{digest, settings, study};
use opshock_tests::tables::failure;

const CLEARANCES_UM: [f64; 5] = [60.0, 80.0, 100.0, 120.0, 140.0];
const WIDTHS_MS: [f64; 2] = [0.5, 2.0];

/// Critical shocks of five clearances at two widths, G: the same for both signs but for 3 % at the longer one.
struct Law<'a> {
    input: &'a SweepInput,
    /// At the shorter width, the worst case, in a film of infinitely many cells.
    worst_g: [f64; 5],
    /// Share that the study's film adds; a quarter of it is left on twice the cells.
    grid_error: f64,
}

impl Law<'_> {
    fn critical_g(&self, point: usize, levels: Levels) -> f64 {
        let at = &self.input.points[point];
        let AxisValue::Number(clearance_um) = at.axes[0] else {
            unreachable!("clearances are numbers")
        };
        let place = CLEARANCES_UM.iter().position(|&um| um == clearance_um);
        let worst_g = self.worst_g[place.expect("a clearance")];
        let longer = if at.coordinates.pulse_ms > 1.0 {
            1.5
        } else {
            1.0
        };
        let sign = 1.0 + 0.03 * (longer - 1.0) * at.coordinates.sign.factor();
        let quarters = -2.0 * f64::from(levels.of(Discretisation::FilmGrid));
        worst_g * longer * sign * (1.0 + self.grid_error * quarters.exp2())
    }
}

impl Simulator for Law<'_> {
    fn simulate(&self, point: usize, probe: Probe, amplitude_m_per_s2: f64) -> ProbeResult {
        let amplitude_g = amplitude_m_per_s2.abs() / STANDARD_GRAVITY_M_PER_S2;
        let fails = amplitude_g >= self.critical_g(point, probe.levels);
        ProbeResult {
            verdict: if fails { failure() } else { Verdict::Survives },
            h_min_m: (!fails).then_some(1e-9),
            t_min_s: (!fails).then_some(5e-3),
            cost: RunCost::default(),
        }
    }

    fn onset(&self, _: usize) -> Onset {
        Onset::At {
            amplitude_m_per_s2: 50.0 * STANDARD_GRAVITY_M_PER_S2,
        }
    }
}

/// Twenty points; `decides`: by their clearances.
fn input(decides: bool) -> SweepInput {
    let mut input = study(&[Ramp::Deformable], &WIDTHS_MS);
    let of_one = std::mem::take(&mut input.points);
    let mut values = Vec::new();
    for (place, clearance_um) in CLEARANCES_UM.into_iter().enumerate() {
        for mut point in of_one.clone() {
            let at = &mut point.coordinates;
            at.axes = vec![format!("{clearance_um:05}")];
            point.digest = digest(&format!("{clearance_um} {} {:?}", at.pulse_ms, at.sign));
            point.axes = vec![AxisValue::Number(clearance_um)];
            point.uncertainty = Some(UncertaintyPlan {
                discretisations: vec![Discretisation::FilmGrid],
                film_halvings: 2,
                mesh_halvings: 0,
                hard_contact: false,
                target: 0.01,
                refinements: 3,
            });
            input.points.push(point);
            values.push(place);
        }
    }
    input.axes = vec!["clearance_um".to_owned()];
    input.settings = settings(MonotonicityScan::Off);
    input.decides = decides.then(|| Question::BestValue(vec![values]));
    input
}

fn law(input: &SweepInput, worst_g: [f64; 5]) -> Law<'_> {
    Law {
        input,
        worst_g,
        grid_error: 0.04,
    }
}

fn run(input: &SweepInput, simulator: &Law<'_>, folder: &Path, threads: usize) -> SweepEnd {
    let options = SweepOptions::with_threads(threads);
    let end = sweep(input, simulator, folder, &options, &Silent).expect("sweeps");
    assert_eq!(end.ending, Ending::Complete);
    end
}

/// Clearances and widths of the rows with an interval, with the levels of their answers.
fn intervals(summary: &Summary) -> BTreeMap<(String, String, &str), &str> {
    let rows = summary
        .points
        .iter()
        .filter(|row| row.uncertainty_g.is_some());
    rows.map(|row| {
        let key = (
            row.axes[0].to_string(),
            row.pulse_ms.to_string(),
            row.sign.as_str(),
        );
        (key, row.levels.as_str())
    })
    .collect()
}

fn sentence(summary: &Summary) -> String {
    Answer::of(summary).sentences().remove(0)
}

#[test]
fn distant_values_keep_their_brackets_and_the_best_and_the_next_have_intervals_unrefined() {
    let (some, all) = (input(true), input(false));
    let worst_g = [120.0, 150.0, 185.0, 215.0, 255.0];
    let folder = tempfile::tempdir().expect("folder");
    let at = |name: &str| folder.path().join(name);
    let decided = run(&some, &law(&some, worst_g), &at("some"), 1);
    let found = intervals(&decided.summary);
    let expected = ["120", "140"].map(|um| ["+", "-"].map(|sign| (um, sign)));
    let expected: Vec<_> = expected.as_flattened().to_vec();
    let chosen: Vec<(&str, &str)> = found.keys().map(|key| (key.0.as_str(), key.2)).collect();
    assert_eq!(chosen, expected, "{found:?}");
    assert!(found.keys().all(|key| key.1 == "0.5"), "{found:?}");
    assert!(found.values().all(|levels| levels.is_empty()), "{found:?}");
    for row in &decided.summary.points {
        assert_eq!(row.status, Status::Ok);
        assert!(!row.flags.contains(&Flag::RefinementLimit));
    }
    // With everything: another number within the interval, the same best value and the same significance.
    let every = run(&all, &law(&all, worst_g), &at("all"), 2);
    assert_eq!(intervals(&every.summary).len(), 20);
    let (a, b) = (Answer::of(&decided.summary), Answer::of(&every.summary));
    let best = |answer: &Answer<'_>| answer.axes[0].ranks[0].value.clone();
    assert_eq!(best(&a), AxisValue::Number(140.0));
    assert_eq!(best(&b), best(&a));
    for answer in [&a, &b] {
        let significance = answer.axes[0].significance(1);
        assert_eq!(significance, Significance::BeyondUncertainties);
    }
    let [low_g, high_g] = a.axes[0].ranks[0].worst.interval_g().expect("an interval");
    let refined_g = b.axes[0].ranks[0]
        .worst
        .known_g()
        .expect("a critical shock");
    assert!((low_g..high_g).contains(&refined_g));
    assert!((low_g..high_g).contains(&255.0));
    assert!(sentence(&decided.summary).ends_with("a lead beyond the uncertainty intervals."));
    let said = sentence(&decided.summary);
    assert!(said.contains(", bracket alone) to "), "{said}");
    assert!(
        said.contains("16 of 20 points with a bracket alone"),
        "{said}"
    );
    assert!(!sentence(&every.summary).contains("alone"));
    let [some, all] = [&decided, &every].map(|end| end.summary.totals.uncertainty_runs);
    assert!(4 * some < all, "{some} of {all}");
}

/// 250 and 260 G with errors of 4 % and factors of safety overlap until the film is refined; 215 G does not reach them.
#[test]
fn values_whose_intervals_overlap_are_refined_until_they_do_not() {
    let some = input(true);
    let folder = tempfile::tempdir().expect("folder");
    let end = run(
        &some,
        &law(&some, [120.0, 150.0, 260.0, 215.0, 250.0]),
        folder.path(),
        2,
    );
    let found = intervals(&end.summary);
    for ((clearance_um, pulse_ms, _), levels) in &found {
        assert_eq!(pulse_ms, "0.5");
        assert!(["100", "140"].contains(&clearance_um.as_str()), "{found:?}");
        assert!(
            clearance_um == "140" || levels.contains("film_grid"),
            "{found:?}"
        );
    }
    let answer = Answer::of(&end.summary);
    assert_eq!(answer.axes[0].ranks[0].value, AxisValue::Number(100.0));
    let significance = answer.axes[0].significance(1);
    assert_eq!(significance, Significance::BeyondUncertainties);
    // Nothing parts equal values: they are refined as far as the study allows.
    let folder = tempfile::tempdir().expect("folder");
    let equal = run(
        &some,
        &law(&some, [120.0, 150.0, 250.0, 215.0, 250.0]),
        folder.path(),
        2,
    );
    let said = sentence(&equal.summary);
    assert!(
        said.contains("the best clearance_um is 100") && said.contains("140"),
        "{said}"
    );
    assert!(!said.contains("beyond"), "{said}");
}

#[test]
fn threads_interruptions_and_shards_choose_the_same_points_and_give_the_same_store() {
    let some = input(true);
    let laws = law(&some, [120.0, 150.0, 260.0, 215.0, 250.0]);
    let folder = tempfile::tempdir().expect("folder");
    let at = |name: &str| folder.path().join(name);
    let reference = run(&some, &laws, &at("1"), 1);
    let other = run(&some, &laws, &at("4"), 4);
    assert_eq!(other.summary, reference.summary);

    let mut options = SweepOptions::with_threads(2);
    options.budget = Some(Duration::from_millis(1));
    let mut sittings = 0;
    loop {
        let end = sweep(&some, &laws, &at("cut"), &options, &Silent).expect("sweeps");
        sittings += 1;
        if end.ending == Ending::Complete {
            break;
        }
        // Brackets until the last round has ended.
        assert!([0, 20].contains(&end.summary.totals.open));
        options.budget = options.budget.map(|budget| budget.mul_f64(1.3));
    }
    assert!(sittings > 1);
    std::fs::remove_file(at("cut").join("journal")).expect("a journal");
    let again = run(&some, &laws, &at("cut"), 2);
    assert_eq!(
        (again.computed_runs, &again.summary),
        (0, &reference.summary)
    );

    // Shards one after another: the first simulates what its points depend on; and at the same time.
    let part = |name: &str, part: &str| {
        let part: Shard = part.parse().expect("a shard");
        let options = SweepOptions {
            shard: Some(part),
            ..SweepOptions::with_threads(1)
        };
        let end = sweep(&some, &laws, &at(name), &options, &Silent).expect("sweeps");
        assert_eq!(end.ending, Ending::Complete);
    };
    part("after", "1/2");
    part("after", "2/2");
    std::thread::scope(|scope| {
        for one in ["1/2", "2/2"] {
            let part = &part;
            scope.spawn(move || part("beside", one));
        }
    });
    for name in ["after", "beside"] {
        let stores = shard::stores(&at(name)).expect("stores");
        let merged = merge(&some, &at(name), &stores, &folder::session(1)).expect("merges");
        let MergeEnd::Merged(merged) = merged else {
            panic!("shards disagree");
        };
        assert_eq!(merged.results.summary, reference.summary);
    }
}

#[test]
fn the_forecast_leaves_out_what_the_sweep_leaves_out() {
    let worst_g = [120.0, 150.0, 185.0, 215.0, 255.0];
    let runs = |input: &SweepInput, loaded: Loaded| {
        let forecast = forecast::forecast(input, &law(input, worst_g), loaded, 2, 1e3);
        (forecast.uncertainty_runs, forecast.answered)
    };
    let (some, all) = (input(true), input(false));
    let (of_some, _) = runs(&some, Loaded::default());
    let (of_all, _) = runs(&all, Loaded::default());
    assert!(of_some.likely > 0.0 && of_some.likely < of_all.likely);
    let folder = tempfile::tempdir().expect("folder");
    let end = run(&some, &law(&some, worst_g), folder.path(), 2);
    let took = end.summary.totals.uncertainty_runs as f64;
    assert!(took <= of_some.max, "{took} of {of_some:?}");
    let (left, answered) = runs(&some, load(folder.path()).expect("a store").0);
    assert_eq!((left.max, answered), (0.0, 20));
}

/// 200 G are required and the film's grid adds 4 %: verdicts on 198 and 203 G need its refinement, and none of the others do.
/// Where one point fails for certain, nothing needs it.
#[test]
fn a_required_amplitude_is_decided_by_refining_what_lies_near_it() {
    let mut some = input(true);
    some.decides = Some(Question::Survives(200.0));
    let folder = tempfile::tempdir().expect("folder");
    let none: [&str; 0] = [];
    let cases = [
        (
            [230.0, 240.0, 203.0, 260.0, 255.0],
            vec!["100"],
            Found::Passes,
        ),
        (
            [230.0, 240.0, 255.0, 198.0, 203.0],
            vec!["120", "140"],
            Found::Fails,
        ),
        (
            [120.0, 240.0, 255.0, 198.0, 203.0],
            none.to_vec(),
            Found::Fails,
        ),
    ];
    for (k, (worst_g, refined, verdict)) in cases.into_iter().enumerate() {
        let end = run(
            &some,
            &law(&some, worst_g),
            &folder.path().join(format!("{k}")),
            1,
        );
        let found = intervals(&end.summary);
        assert_eq!(found.len(), 20, "every bracket near 200 G has its interval");
        let levels = found.iter().filter(|(_, levels)| !levels.is_empty());
        let mut of: Vec<&str> = levels.map(|((um, ..), _)| um.as_str()).collect();
        of.dedup();
        assert_eq!(of, refined, "{found:?}");
        let points = end.summary.points.iter();
        let verdicts: Vec<Found> = points
            .map(|row| PointVerdict::of(row, 200.0).verdict)
            .collect();
        assert_eq!(Found::of_all(verdicts.iter().copied()), verdict);
        for ((row, point), found) in end.summary.points.iter().zip(&some.points).zip(verdicts) {
            let AxisValue::Number(clearance_um) = point.axes[0] else {
                unreachable!("clearances are numbers")
            };
            let place = CLEARANCES_UM.iter().position(|&um| um == clearance_um);
            let is_longer = point.coordinates.pulse_ms > 1.0;
            let truth_g = worst_g[place.expect("a clearance")] * if is_longer { 1.5 } else { 1.0 };
            let truth = match truth_g > 200.0 {
                true => Found::Passes,
                false => Found::Fails,
            };
            // Undecided is what was not refined.
            assert!(
                found == truth || (found == Found::Undecided && k == 2),
                "{row:?}"
            );
        }
        let again = run(
            &some,
            &law(&some, worst_g),
            &folder.path().join(format!("{k} again")),
            2,
        );
        assert_eq!(again.summary, end.summary);
    }
}

#[test]
fn axes_to_choose_from_decide_and_without_any_the_worst_case() {
    let decides = |sets: &[&str]| {
        let sets: Vec<SetArg> = sets.iter().map(|set| set.parse().expect("a set")).collect();
        let study = Study::from_text(&Study::example("decides"), &sets).expect("a study");
        SweepInput::of(&study).expect("input").decides
    };
    let decisive = "search.uncertainty_of=decisive";
    assert_eq!(decides(&[]), None);
    assert_eq!(decides(&["search.uncertainty_of=all"]), None);
    assert_eq!(decides(&[decisive, "search.uncertainty=false"]), None);
    let one = "ramp.models=[\"rigid\"]";
    assert_eq!(
        decides(&[decisive, one]),
        Some(Question::BestValue(vec![vec![0; 6]]))
    );
    let required = "search.required_amplitude_g=400";
    assert_eq!(
        decides(&[decisive, one, required]),
        Some(Question::Survives(400.0))
    );
    let two = decides(&[
        decisive,
        "ramp.models=[\"rigid\", \"deformable\"]",
        "pulse.widths_ms=1.0",
        "pulse.signs=[\"+\"]",
        "ramp.clearance_um=[60, 100]",
    ]);
    assert_eq!(
        two,
        Some(Question::BestValue(vec![
            vec![0, 1, 0, 1],
            vec![0, 0, 1, 1]
        ]))
    );
}
