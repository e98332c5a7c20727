//! Sweeps a mock study into a folder: a process that tests can kill.
//!
//! `sweep-mock FOLDER THREADS SLEEP_MS [CHECKPOINT_MS] [refined]`
//!
//! Prints `ready`, and a line for every simulation once it is reported as done: from then on it must
//! never be lost; and `begun` for one that outlasts any test. `refined` sweeps a study that adds widths, round by round.

use std::io::Write as _;
use std::process::ExitCode;
use std::time::Duration;

use opshock_study::store::StoreError;
use opshock_study::sweep::{Ending, Event, Progress, SweepInput, SweepOptions, sweep};
use opshock_tests::mock_sweep::{MockSimulator, fig13};
use opshock_tests::refined::{refined_study, sweep_reported};

/// Prints what is reported as done: the point's digest and sign, the amplitude's bits, the window.
struct Reported(Vec<String>);

impl Reported {
    fn of(input: &SweepInput) -> Reported {
        let points = input.points.iter();
        let name = points.map(|point| {
            let digest: String = point.digest.0.iter().map(|b| format!("{b:02x}")).collect();
            format!("{digest} {}", point.coordinates.sign.as_str())
        });
        Reported(name.collect())
    }
}

impl Progress for Reported {
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
                "{} {:x} {}",
                self.0[*point],
                amplitude_g.to_bits(),
                if *purpose == "window" { 2 } else { 1 }
            );
        }
    }
}

fn main() -> ExitCode {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let is_refined = arguments.last().is_some_and(|last| last == "refined");
    if is_refined {
        arguments.pop();
    }
    let (folder, threads, sleep_ms, checkpoint_ms) = match arguments.as_slice() {
        [folder, threads, sleep_ms] => (folder, threads, sleep_ms, "100"),
        [folder, threads, sleep_ms, checkpoint_ms] => {
            (folder, threads, sleep_ms, checkpoint_ms.as_str())
        }
        _ => {
            eprintln!("sweep-mock FOLDER THREADS SLEEP_MS [CHECKPOINT_MS] [refined]");
            return ExitCode::from(2);
        }
    };
    let milliseconds = |text: &str| Duration::from_millis(text.parse().expect("milliseconds"));
    let options = SweepOptions::with_threads(threads.parse().expect("threads"));
    options.stop.listen().expect("signal handlers");
    println!("ready");
    if is_refined {
        let reported = |input: &SweepInput| Box::new(Reported::of(input)) as Box<dyn Progress>;
        let sleep = milliseconds(sleep_ms);
        sweep_reported(
            &refined_study(),
            folder.as_ref(),
            &options,
            99,
            sleep,
            reported,
        );
        return ExitCode::SUCCESS;
    }
    let mut input = fig13();
    input.checkpoint = milliseconds(checkpoint_ms);
    let mut simulator = MockSimulator::new(&input);
    simulator.sleep = milliseconds(sleep_ms);
    match sweep(
        &input,
        &simulator,
        folder.as_ref(),
        &options,
        &Reported::of(&input),
    ) {
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
