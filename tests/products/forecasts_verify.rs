//! Forecasts of real studies against what they took: `make verify-forecast`.

use std::sync::Mutex;

use opshock_study::store::{self, Loaded};
use opshock_study::study::{KeepHistories, SetArg, Study};
use opshock_study::sweep::forecast::forecast;
use opshock_study::sweep::spread::Spread;
use opshock_study::sweep::{Ending, Event, Physics, Progress, SweepInput, SweepOptions, sweep};
use opshock_tests::mock_uncertainty::Random;

const STUDIES: u64 = 20;
/// Studies whose time lies in the range, at least.
const HOLDING: usize = 17;
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

/// Seconds of the simulations reported so far, and every estimate with those at its time.
#[derive(Default)]
struct Seconds(Mutex<(f64, Vec<(f64, Spread)>)>);

impl Progress for Seconds {
    fn event(&self, event: &Event) {
        let mut state = self.0.lock().expect("sound");
        match event {
            Event::ProbeDone {
                wall_s: Some(wall_s),
                ..
            } => state.0 += wall_s,
            Event::Estimated(estimate) => {
                if let Some(left) = estimate.core_s {
                    let done_s = state.0;
                    state.1.push((done_s, left));
                }
            }
            _ => {}
        }
    }
}

#[test]
#[ignore = "slow: 20 sweeps, make verify-forecast"]
fn forecast_slow_ranges_hold_the_time_that_sweeps_take() {
    let (mut before, mut inside, mut later) = (0, 0, 0);
    for seed in 1..=STUDIES {
        let (sets, study) = seeded(seed);
        let mut input = SweepInput::of(&study).expect("input");
        input.keep_histories = KeepHistories::None;
        let plan = forecast(
            &input,
            &Physics::of(&study),
            Loaded::default(),
            THREADS,
            0.0,
        );
        let folder = tempfile::tempdir().expect("folder");
        let seconds = Seconds::default();
        let options = SweepOptions::with_threads(THREADS);
        let end = sweep(
            &input,
            &Physics::of(&study),
            folder.path(),
            &options,
            &seconds,
        );
        let end = end.expect("sweeps");
        assert_eq!(end.ending, Ending::Complete);
        let (stored, _) = store::load(folder.path()).expect("a store");
        let runs = stored.runs.len();
        let actual_s: f64 = stored.runs.values().map(|run| run.machine.wall_s).sum();
        let (_, estimates) = seconds.0.into_inner().expect("sound");
        let (done_s, left) = *estimates
            .iter()
            .find(|(done_s, _)| *done_s >= 0.1 * actual_s)
            .expect("an estimate after a tenth");
        let planned = [3600.0 * plan.core_h.min, 3600.0 * plan.core_h.max];
        let tenth = [done_s + left.min, done_s + left.max];
        let holds = |range: [f64; 2]| (range[0]..=range[1]).contains(&actual_s);
        let is_narrow = tenth[1] <= 2.0 * tenth[0];
        before += usize::from(holds(planned));
        later += usize::from(holds(tenth) && is_narrow);
        inside += usize::from(holds(tenth));
        println!(
            "{seed:2}: {runs:4} runs, {actual_s:6.1} s; planned {:.1} to {:.1} ({}, factor {:.1}); \
             after {:.0} % {:.1} to {:.1} ({}, factor {:.1}); {sets}",
            planned[0],
            planned[1],
            if holds(planned) { "holds" } else { "fails" },
            planned[1] / planned[0],
            100.0 * done_s / actual_s,
            tenth[0],
            tenth[1],
            if holds(tenth) { "holds" } else { "fails" },
            tenth[1] / tenth[0],
        );
    }
    println!(
        "of {STUDIES}: {before} inside the planned range; after a tenth {inside} inside the stated range, {later} of \
         them no wider than a factor 2"
    );
    assert!(
        before >= HOLDING && later >= HOLDING,
        "{before} and {later}"
    );
}
