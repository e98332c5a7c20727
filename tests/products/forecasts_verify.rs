//! Forecasts of real studies against what they took: `make verify-forecast`.

use std::sync::Mutex;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use opshock_study::store::{self, Loaded};
use opshock_study::study::{KeepHistories, SetArg, Study};
use opshock_study::sweep::forecast::forecast;
use opshock_study::sweep::spread::Spread;
use opshock_study::sweep::{Ending, Event, Physics, Progress, SweepInput, SweepOptions, sweep};
use opshock_tests::mock_uncertainty::Random;
use opshock_tests::seeded::seeds;

/// Seeds: those below were looked at while the factors of the forecast were chosen.
const STUDIES: std::ops::Range<u64> = 112..132;
/// Share of the studies whose time lies in the range, at least.
const HOLDING: f64 = 0.85;
const THREADS: usize = 2;

/// A study of a seed, with 4 to 36 points; every third one refines its answers.
fn seeded(seed: u64) -> (String, Study) {
    let mut random = Random(seed.wrapping_mul(0x9e6c_63d0_876a_68ee));
    let mut pick = |words: &[&'static str]| words[(random.unit() * words.len() as f64) as usize];
    let ramps = pick(&[
        "[\"none\"]",
        "[\"rigid\"]",
        "[\"deformable\"]",
        "[\"none\", \"rigid\"]",
        "[\"none\", \"rigid\", \"deformable\"]",
    ]);
    let widths = pick(&[
        "[0.5, 1.0, 1.5, 2.0]",
        "[0.4, 0.6, 0.8, 1.0]",
        "[0.5, 0.7, 1.0, 1.5, 2.0, 3.0]",
        "[1.0, 1.5, 2.0, 3.0]",
    ]);
    let signs = pick(&["[\"+\"]", "[\"-\"]", "[\"+\", \"-\"]"]);
    let preset = pick(&["\"coarse\"", "\"standard\""]);
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

/// An estimate of a running sweep, when it came, and what it was.
struct Passed {
    unix_s: f64,
    wall_s: f64,
    core_left: Spread,
    wall_left: Spread,
}

/// Every estimate of a sweep.
struct Estimates {
    began: Instant,
    seen: Mutex<Vec<Passed>>,
}

impl Progress for Estimates {
    fn event(&self, event: &Event) {
        let Event::Estimated(estimate) = event else {
            return;
        };
        if let (Some(core_left), Some(wall_left)) = (estimate.core_s, estimate.left_s) {
            let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH);
            self.seen.lock().expect("sound").push(Passed {
                unix_s: since_1970.expect("a clock").as_secs_f64(),
                wall_s: self.began.elapsed().as_secs_f64(),
                core_left,
                wall_left,
            });
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
        let passed_s = |at: &Passed| -> f64 {
            let runs = stored.runs.values().map(|run| run.machine);
            let finished = runs.filter(|run| run.finished_unix_s <= at.unix_s);
            finished.map(|run| run.wall_s).sum()
        };
        let seen = estimates.seen.into_inner().expect("sound");
        let at = seen.iter().find(|at| passed_s(at) >= 0.1 * core_s);
        let at = at.expect("an estimate after a tenth");
        let passed_s = passed_s(at);
        let seconds = |hours: Spread| Spread {
            min: 3600.0 * hours.min,
            likely: 3600.0 * hours.likely,
            max: 3600.0 * hours.max,
        };
        let planned = Range::of(0.0, seconds(plan.wall_h), wall_s);
        let planned_core = Range::of(0.0, seconds(plan.core_h), core_s);
        let later = Range::of(at.wall_s, at.wall_left, wall_s);
        let later_core = Range::of(passed_s, at.core_left, core_s);
        before += usize::from(planned.holds());
        tenth += usize::from(later.holds());
        narrow += usize::from(later.holds() && later.factor() <= 2.0);
        core_before += usize::from(planned_core.holds());
        core_tenth += usize::from(later_core.holds() && later_core.factor() <= 2.0);
        println!(
            "{seed:2}: {runs:4} runs, {wall_s:5.1} s, {core_s:5.1} s of one core; in these units planned {planned}, of one core \
             {planned_core}; after {:.0} % {later}, factor {:.2}, of one core {later_core}; {sets}",
            100.0 * passed_s / core_s,
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
