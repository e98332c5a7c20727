//! Sweeps the mock study into a folder: a process that tests can kill.
//!
//! `sweep-mock FOLDER THREADS SLEEP_MS`

use std::process::ExitCode;
use std::time::Duration;

use opshock_study::store::StoreError;
use opshock_study::sweep::{Ending, Silent, SweepOptions, sweep};
use opshock_tests::mock_sweep::{MockSimulator, fig13};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, threads, sleep_ms] = arguments.as_slice() else {
        eprintln!("sweep-mock FOLDER THREADS SLEEP_MS");
        return ExitCode::from(2);
    };
    let mut input = fig13();
    input.checkpoint = Duration::from_millis(100);
    let mut simulator = MockSimulator::new(&input);
    simulator.sleep = Duration::from_millis(sleep_ms.parse().expect("milliseconds"));
    let options = SweepOptions::with_threads(threads.parse().expect("threads"));
    options.stop.listen().expect("signal handlers");
    println!("ready");
    match sweep(&input, &simulator, folder.as_ref(), &options, &Silent) {
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
