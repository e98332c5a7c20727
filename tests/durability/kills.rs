//! Real `kill -9` at random moments: 20 in every test run, 2000 with `make verify-store`.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_study::store::{Record, RunKey, journal, results};
use opshock_study::sweep::{Silent, SweepInput, SweepOptions, sweep};
use opshock_tests::hdf5_dump::dump;
use opshock_tests::mock_sweep::{MockSimulator, fig13};
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

/// Simulations that a killed process had told as done: point, amplitude, window.
fn told(input: &SweepInput, output: &str) -> Vec<RunKey> {
    // The last line may be cut.
    let whole = output.rsplit_once('\n').map_or("", |(whole, _)| whole);
    whole
        .lines()
        .skip(1)
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            let point = &input.points[words[0].parse::<usize>().expect("a point")];
            let bits = u64::from_str_radix(words[1], 16).expect("an amplitude");
            let amplitude = m_per_s2_from_g(f64::from_bits(bits));
            RunKey {
                point: point.digest,
                amplitude_bits: (point.coordinates.sign.factor() * amplitude).to_bits(),
                window_factor: words[2].parse().expect("a window"),
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

/// One store that is killed again and again and then finished; the number of kills.
fn life(seed: u64, expected: &[String]) -> usize {
    let _on_panic = OnPanic(seed);
    let mut seeded = Seeded::new(seed);
    let input = fig13();
    let root = tempfile::tempdir().expect("folder");
    let folder = root.path().join("store");
    let mut before = BTreeMap::new();
    let mut kills = 0;
    while kills < KILLS {
        let mut program = Command::new(env!("CARGO_BIN_EXE_sweep-mock"));
        // Checkpoints every few milliseconds: some kills fall into them.
        let checkpoint_ms = seeded.one_of(&["2", "10", "1000"]);
        program.arg(&folder).args(["2", "2", checkpoint_ms]);
        let after = Duration::from_secs_f64(seeded.between(0.0, 0.06));
        let (ran, output) = kill(start(&mut program), after);
        if !ran {
            break;
        }
        kills += 1;
        let now = stored(&folder);
        for key in told(&input, &output) {
            assert!(now.contains_key(&key), "told as done, and lost");
        }
        for (key, bytes) in &before {
            assert_eq!(now.get(key), Some(bytes), "lost or altered");
        }
        // Whatever the moment, the results are whole or not there.
        results::read(&folder.join("results.h5")).expect("whole");
        before = now;
    }
    let known = before.len() as u64;
    let end = sweep(
        &input,
        &MockSimulator::new(&input),
        &folder,
        &SweepOptions::with_threads(1),
        &Silent,
    )
    .expect("sweeps");
    let after = stored(&folder);
    assert_eq!(end.computed_runs, after.len() as u64 - known);
    for (key, bytes) in &before {
        assert_eq!(after.get(key), Some(bytes), "lost or altered");
    }
    let content = dump(&folder.join("results.h5"), &["/machine"]);
    assert!(content == expected, "seed {seed}: other bits");
    kills
}

fn undisturbed() -> Vec<String> {
    let input = fig13();
    let folder = tempfile::tempdir().expect("folder");
    let simulator = MockSimulator::new(&input);
    let options = SweepOptions::with_threads(1);
    sweep(&input, &simulator, folder.path(), &options, &Silent).expect("sweeps");
    dump(&folder.path().join("results.h5"), &["/machine"])
}

fn lives(range: std::ops::Range<u64>) -> usize {
    let expected = undisturbed();
    let mut kills = 0;
    for seed in range {
        kills += life(seed, &expected);
        if seed % 20 == 19 {
            println!("seed {seed}: {kills} kills so far");
        }
    }
    kills
}

#[test]
fn killed_at_random_moments_nothing_is_lost_doubled_or_altered() {
    assert!(lives(0..2) >= 10);
}

#[test]
#[ignore = "minutes: make verify-store"]
fn store_slow_two_thousand_kills() {
    let range = seeds(0..220);
    let kills = lives(range.clone());
    println!("{kills} kills over seeds {range:?}: nothing lost, doubled or altered");
    if range == (0..220) {
        assert!(kills >= 2000, "{kills} kills");
    }
}
