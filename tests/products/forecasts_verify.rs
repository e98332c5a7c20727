//! Forecasts of real studies against what they took: `make verify-forecast`.

use std::sync::Mutex;
use std::time::Instant;

use opshock_study::store::{self, Loaded};
use opshock_study::study::{KeepHistories, SetArg, Study};
use opshock_study::sweep::forecast::forecast;
use opshock_study::sweep::spread::Spread;
use opshock_study::sweep::{Ending, Event, Physics, Progress, SweepInput, SweepOptions, sweep};
use opshock_tests::mock_uncertainty::Random;
use opshock_tests::seeded::seeds;

/// Seeds: those below were used to choose the factors of the forecast.
const STUDIES: std::ops::Range<u64> = 21..41;
/// Share of the studies whose time lies in the range, at least.
const HOLDING: f64 = 0.85;
const THREADS: usize = 2;

/// A small study of a seed; every third one refines its answers.
fn seeded(seed: u64) -> (String, Study) {
    let mut random = Random(seed.wrapping_mul(0x9e6c_63d0_876a_68ee));
    let mut pick = |words: &[&'static str]| words[(random.unit() * words.len() as f64) as usize];
    let ramps = pick(&[
        "[\"none\"]",
        "[\"rigid\"]",
        "[\"deformable\"]",
        "[\"none\", \"rigid\"]",
    ]);
    let widths = pick(&["[0.5, 2.0]", "[0.7, 1.0]", "[1.0, 1.5, 3.0]", "[0.5, 0.8]"]);
    let signs = pick(&["[\"+\"]", "[\"-\"]"]);
    let preset = pick(&["\"coarse\"", "\"coarse\"", "\"standard\""]);
    let clearance = pick(&["60.0", "100.0", "140.0"]);
    let refinements = if seed.is_multiple_of(3) { "1" } else { "0" };
    let sets: Vec<String> = [
        ("ramp.models", ramps),
        ("pulse.widths_ms", widths),
        ("pulse.signs", signs),
        ("resolution.preset", preset),
        ("ramp.clearance_um", clearance),
        ("search.max_refinements", refinements),
    ]
    .iter()
    .map(|(key, value)| format!("{key}={value}"))
    .collect();
    let arguments: Vec<SetArg> = sets
        .iter()
        .map(|set| set.parse().expect("a set argument"))
        .collect();
    let study = Study::from_text(&Study::example("forecast"), &arguments).expect("a study");
    (sets.join(" "), study)
}

/// An estimate of a running sweep with what had passed: seconds of simulations and of the sweep.
struct Passed {
    core_s: f64,
    wall_s: f64,
    core_left: Spread,
    wall_left: Spread,
}

/// Every estimate of a sweep.
struct Estimates {
    began: Instant,
    seen: Mutex<(f64, Vec<Passed>)>,
}

impl Progress for Estimates {
    fn event(&self, event: &Event) {
        let mut seen = self.seen.lock().expect("sound");
        match event {
            Event::ProbeDone {
                wall_s: Some(wall_s),
                ..
            } => seen.0 += wall_s,
            Event::Estimated(estimate) => {
                if let (Some(core_left), Some(wall_left)) = (estimate.core_s, estimate.left_s) {
                    let core_s = seen.0;
                    seen.1.push(Passed {
                        core_s,
                        wall_s: self.began.elapsed().as_secs_f64(),
                        core_left,
                        wall_left,
                    });
                }
            }
            _ => {}
        }
    }
}

/// A stated range and what came.
struct Range {
    low: f64,
    high: f64,
    actual: f64,
}

impl Range {
    fn of(passed: f64, left: Spread, actual: f64) -> Range {
        let (low, high) = (passed + left.min, passed + left.max);
        Range { low, high, actual }
    }

    fn holds(&self) -> bool {
        (self.low..=self.high).contains(&self.actual)
    }

    fn factor(&self) -> f64 {
        self.high / self.low
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [low, high] = [self.low, self.high].map(|end| end / self.actual);
        let word = if self.holds() { "holds" } else { "fails" };
        write!(f, "{low:.2} to {high:.2} {word}")
    }
}

#[test]
#[ignore = "slow: 20 sweeps, make verify-forecast"]
fn forecast_slow_ranges_hold_the_time_that_sweeps_take() {
    let range = seeds(STUDIES);
    let n = range.clone().count();
    let [
        mut before,
        mut tenth,
        mut narrow,
        mut core_before,
        mut core_tenth,
    ] = [0; 5];
    for seed in range {
        let (sets, study) = seeded(seed);
        let mut input = SweepInput::of(&study).expect("input");
        input.keep_histories = KeepHistories::None;
        // Models of its own, as a process of its own has.
        let planner = Physics::of(&study);
        let plan = forecast(&input, &planner, Loaded::default(), THREADS, 0.0);
        let folder = tempfile::tempdir().expect("folder");
        let estimates = Estimates {
            began: Instant::now(),
            seen: Mutex::default(),
        };
        let options = SweepOptions::with_threads(THREADS);
        let end = sweep(
            &input,
            &Physics::of(&study),
            folder.path(),
            &options,
            &estimates,
        );
        let end = end.expect("sweeps");
        let wall_s = estimates.began.elapsed().as_secs_f64();
        assert_eq!(end.ending, Ending::Complete);
        let (stored, _) = store::load(folder.path()).expect("a store");
        let runs = stored.runs.len();
        let core_s: f64 = stored.runs.values().map(|run| run.machine.wall_s).sum();
        let (_, seen) = estimates.seen.into_inner().expect("sound");
        let at = seen
            .iter()
            .find(|passed| passed.core_s >= 0.1 * core_s)
            .expect("an estimate after a tenth");
        let seconds = |hours: Spread| Spread {
            min: 3600.0 * hours.min,
            likely: 3600.0 * hours.likely,
            max: 3600.0 * hours.max,
        };
        let planned = Range::of(0.0, seconds(plan.wall_h), wall_s);
        let planned_core = Range::of(0.0, seconds(plan.core_h), core_s);
        let later = Range::of(at.wall_s, at.wall_left, wall_s);
        let later_core = Range::of(at.core_s, at.core_left, core_s);
        before += usize::from(planned.holds());
        tenth += usize::from(later.holds());
        narrow += usize::from(later.holds() && later.factor() <= 2.0);
        core_before += usize::from(planned_core.holds());
        core_tenth += usize::from(later_core.holds() && later_core.factor() <= 2.0);
        println!(
            "{seed:2}: {runs:4} runs, {wall_s:5.1} s, {core_s:5.1} s of one core; in these units planned {planned}, of one core \
             {planned_core}; after {:.0} % {later}, factor {:.2}, of one core {later_core}; {sets}",
            100.0 * at.core_s / core_s,
            later.factor(),
        );
    }
    println!(
        "of {n}: {before} inside the planned range; after a tenth {tenth} inside the stated range, {narrow} of them no wider \
         than a factor 2; of the time of one core {core_before} and {core_tenth}"
    );
    let needed = (HOLDING * n as f64).ceil() as usize;
    let all = [before, narrow, core_before, core_tenth];
    assert!(all.iter().all(|&held| held >= needed), "{all:?} of {n}");
}
