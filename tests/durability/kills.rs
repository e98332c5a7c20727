//! Real `kill -9` at random moments: 20 in every test run, 2000 with `make verify-store`.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_study::search::Sign;
use opshock_study::store::{PointDigest, Record, RunKey, journal, results};
use opshock_study::sweep::{Silent, SweepInput, SweepOptions, sweep};
use opshock_tests::hdf5_dump::dump;
use opshock_tests::mock_sweep::{MockSimulator, fig13};
use opshock_tests::program::program;
use opshock_tests::refined::{refined_study, sweep_rounds};
use opshock_tests::seeded::{OnPanic, Seeded, seeds};

/// Kills of one seed.
const KILLS: usize = 10;

/// Whole runs of a journal by key; none is there twice.
fn stored(folder: &Path) -> BTreeMap<RunKey, Vec<u8>> {
    let content = journal::read(&folder.join("journal")).expect("reads");
    let mut runs = BTreeMap::new();
    for record in content.map_or(Vec::new(), |content| content.records) {
        if let Record::Run(run) = &record {
            let doubled = runs.insert(run.key, record.encode());
            assert!(doubled.is_none(), "a simulation is there twice");
        }
    }
    runs
}

/// Simulations that a killed process had reported as done: point and sign, amplitude, window.
fn reported(output: &str) -> Vec<RunKey> {
    // The last line may be cut.
    let whole = output.rsplit_once('\n').map_or("", |(whole, _)| whole);
    let number = |text: &str| u64::from_str_radix(text, 16).expect("bits");
    whole
        .lines()
        .skip(1)
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            let mut point = PointDigest([0; 32]);
            for (byte, place) in point.0.iter_mut().zip((0..).step_by(2)) {
                *byte = number(&words[0][place..place + 2]) as u8;
            }
            let sign = Sign::from_word(words[1]).expect("a sign");
            let amplitude = m_per_s2_from_g(f64::from_bits(number(words[2])));
            RunKey {
                point,
                amplitude_bits: (sign.factor() * amplitude).to_bits(),
                window_factor: words[3].parse().expect("a window"),
                retry: 0,
            }
        })
        .collect()
}

fn start(program: &mut Command) -> Child {
    program
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts")
}

/// Kills after a while; whether the process was still running, and what it had printed.
fn kill(mut child: Child, after: Duration) -> (bool, String) {
    std::thread::sleep(after);
    let ran = child.try_wait().expect("waits").is_none();
    child.kill().expect("kills");
    child.wait().expect("waits");
    let mut output = String::new();
    let mut pipe = child.stdout.take().expect("piped");
    pipe.read_to_string(&mut output).expect("reads");
    (ran, output)
}

/// What a store is killed under.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Swept {
    /// The 36 points of a figure.
    Figure,
    /// A study that adds widths, round by round.
    Refined,
}

impl Swept {
    /// Ends the sweep in `folder`; the number of simulations made where the sweep itself reports it.
    fn finish(self, folder: &Path) -> Option<u64> {
        let options = SweepOptions::with_threads(1);
        match self {
            Swept::Figure => {
                let input = fig13();
                let simulator = MockSimulator::new(&input);
                let end = sweep(&input, &simulator, folder, &options, &Silent);
                Some(end.expect("sweeps").computed_runs)
            }
            Swept::Refined => {
                sweep_rounds(&refined_study(), folder, &options, 99);
                None
            }
        }
    }

    fn undisturbed(self) -> Vec<String> {
        let folder = tempfile::tempdir().expect("folder");
        self.finish(folder.path());
        dump(&folder.path().join("results.h5"), &["/machine"])
    }
}

/// Kills of some lives, and those of them after which added widths were there.
#[derive(Default)]
struct Kills {
    all: usize,
    in_added_rounds: usize,
}

/// One store that is killed again and again and then finished.
fn life(swept: Swept, seed: u64, expected: &[String], kills: &mut Kills) {
    let _on_panic = OnPanic(seed);
    let mut seeded = Seeded::new(seed);
    let own: Vec<PointDigest> = SweepInput::of(&refined_study())
        .map(|input| input.points.iter().map(|point| point.digest).collect())
        .expect("a range");
    let root = tempfile::tempdir().expect("folder");
    let folder = root.path().join("store");
    if swept == Swept::Refined {
        // The study's own widths are answered: every kill falls into a round of added ones.
        let options = SweepOptions::with_threads(1);
        sweep_rounds(&refined_study(), &folder, &options, 1);
    }
    let mut before = stored(&folder);
    for _ in 0..KILLS {
        let mut program = program(env!("CARGO_BIN_EXE_sweep-mock"));
        // Checkpoints every few milliseconds: some kills fall into them.
        let checkpoint_ms = seeded.one_of(&["2", "10", "1000"]);
        program.arg(&folder).args(["2", "2", checkpoint_ms]);
        if swept == Swept::Refined {
            program.arg("refined");
        }
        // Its start reads the store and plays back what it holds, round by round.
        let longest_s = if swept == Swept::Refined { 0.25 } else { 0.06 };
        let after = Duration::from_secs_f64(seeded.between(0.0, longest_s));
        let (ran, output) = kill(start(&mut program), after);
        if !ran {
            break;
        }
        kills.all += 1;
        let now = stored(&folder);
        for key in reported(&output) {
            assert!(now.contains_key(&key), "reported as done, and lost");
        }
        for (key, bytes) in &before {
            assert_eq!(now.get(key), Some(bytes), "lost or altered");
        }
        let is_added = |key: &RunKey| swept == Swept::Refined && !own.contains(&key.point);
        kills.in_added_rounds += usize::from(now.keys().any(is_added));
        // Whatever the moment, the results are whole or not there.
        results::read(&folder.join("results.h5")).expect("whole");
        before = now;
    }
    let known = before.len() as u64;
    let computed = swept.finish(&folder);
    let after = stored(&folder);
    if let Some(computed) = computed {
        assert_eq!(computed, after.len() as u64 - known);
    }
    for (key, bytes) in &before {
        assert_eq!(after.get(key), Some(bytes), "lost or altered");
    }
    let content = dump(&folder.join("results.h5"), &["/machine"]);
    assert!(content == expected, "seed {seed}: other bits");
}

fn lives(swept: Swept, range: std::ops::Range<u64>) -> Kills {
    let expected = swept.undisturbed();
    let mut kills = Kills::default();
    for seed in range {
        life(swept, seed, &expected, &mut kills);
        if seed % 20 == 19 {
            println!("seed {seed}: {} kills so far", kills.all);
        }
    }
    kills
}

#[test]
fn killed_at_random_moments_nothing_is_lost_doubled_or_altered() {
    assert!(lives(Swept::Figure, 0..2).all >= 10);
}

#[test]
fn killed_while_widths_are_added_nothing_is_lost_doubled_or_altered() {
    assert!(lives(Swept::Refined, 0..2).all >= 2);
}

#[test]
#[ignore = "minutes: make verify-store"]
fn store_slow_two_thousand_kills() {
    let range = seeds(0..220);
    let kills = lives(Swept::Figure, range.clone());
    println!(
        "{} kills over seeds {range:?}: nothing lost, doubled or altered",
        kills.all
    );
    if range == (0..220) {
        assert!(kills.all >= 2000, "{} kills", kills.all);
    }
}

#[test]
#[ignore = "minutes: make verify-store"]
fn store_slow_kills_in_rounds_of_refinement() {
    let range = seeds(0..60);
    let kills = lives(Swept::Refined, range.clone());
    println!(
        "{} kills over seeds {range:?}, {} with added widths begun: nothing lost, doubled or altered",
        kills.all, kills.in_added_rounds
    );
    assert!(kills.in_added_rounds > 0);
}
