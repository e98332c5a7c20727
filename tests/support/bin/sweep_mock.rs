//! Sweeps the mock study into a folder: a process that tests can kill.
//!
//! `sweep-mock FOLDER THREADS SLEEP_MS [CHECKPOINT_MS]`
//!
//! Prints `ready`, and a line for every simulation once it is told as done: from then on it must
//! never be lost.

use std::io::Write as _;
use std::process::ExitCode;
use std::time::Duration;

use opshock_study::store::StoreError;
use opshock_study::sweep::{Ending, Event, Progress, SweepOptions, sweep};
use opshock_tests::mock_sweep::{MockSimulator, fig13};

/// Prints what is told as done.
struct Told;

impl Progress for Told {
    fn event(&self, event: &Event) {
        if let Event::ProbeDone {
            point,
            amplitude_g,
            purpose,
            ..
        } = event
        {
            // A reader that went away must not end a sweep.
            let _ = writeln!(
                std::io::stdout(),
                "{point} {:x} {}",
                amplitude_g.to_bits(),
                if *purpose == "window" { 2 } else { 1 }
            );
        }
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (folder, threads, sleep_ms, checkpoint_ms) = match arguments.as_slice() {
        [folder, threads, sleep_ms] => (folder, threads, sleep_ms, "100"),
        [folder, threads, sleep_ms, checkpoint_ms] => {
            (folder, threads, sleep_ms, checkpoint_ms.as_str())
        }
        _ => {
            eprintln!("sweep-mock FOLDER THREADS SLEEP_MS [CHECKPOINT_MS]");
            return ExitCode::from(2);
        }
    };
    let milliseconds = |text: &str| Duration::from_millis(text.parse().expect("milliseconds"));
    let mut input = fig13();
    input.checkpoint = milliseconds(checkpoint_ms);
    let mut simulator = MockSimulator::new(&input);
    simulator.sleep = milliseconds(sleep_ms);
    let options = SweepOptions::with_threads(threads.parse().expect("threads"));
    options.stop.listen().expect("signal handlers");
    println!("ready");
    match sweep(&input, &simulator, folder.as_ref(), &options, &Told) {
        Ok(end) => match end.ending {
            Ending::Complete => ExitCode::SUCCESS,
            Ending::Budget => ExitCode::from(5),
            Ending::Stopped { signal } => ExitCode::from(128 + signal.unwrap_or(0) as u8),
        },
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(StoreError::EXIT_CODE)
        }
    }
}
