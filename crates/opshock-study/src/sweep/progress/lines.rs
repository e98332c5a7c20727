//! Progress as plain lines, for logs and pipes.

use std::io::Write;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use super::event::{Event, PointLabel, Progress};
use super::text::{answer, finished, left, stopping};

/// Time between two lines about what is left.
const EVERY: Duration = Duration::from_secs(10);

/// Writes a line per answered point and one every ten seconds.
pub struct Lines<W>(Mutex<State<W>>);

struct State<W> {
    output: W,
    points: Vec<PointLabel>,
    answered: usize,
    reported_at: Instant,
}

impl<W: Write> Lines<W> {
    /// Begins with a line naming the study.
    pub fn start(output: W, study: &str) -> Lines<W> {
        let lines = Lines(Mutex::new(State {
            output,
            points: Vec::new(),
            answered: 0,
            reported_at: Instant::now(),
        }));
        lines.with(|state| state.say(&format!("sweep of {study}")));
        lines
    }

    fn with(&self, act: impl FnOnce(&mut State<W>)) {
        // Only a panic while writing poisons it; at worst a line is lost.
        act(&mut self
            .0
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner));
    }
}

impl<W: Write> State<W> {
    /// A closed pipe must not end a sweep.
    fn say(&mut self, line: &str) {
        let _ = writeln!(self.output, "{line}");
        let _ = self.output.flush();
    }
}

impl<W: Write + Send> Progress for Lines<W> {
    fn event(&self, event: &Event) {
        self.with(|state| match event {
            Event::Started {
                points,
                threads,
                stored_runs,
                ..
            } => {
                state.points.clone_from(points);
                state.say(&format!(
                    "{} points, {threads} threads, {stored_runs} runs in the store",
                    points.len()
                ));
            }
            Event::PointDone {
                is_stored: true, ..
            } => state.answered += 1,
            Event::PointDone { point, summary, .. } => {
                state.answered += 1;
                let flags: Vec<&str> = summary.flags.iter().map(|flag| flag.as_str()).collect();
                let line = format!(
                    "[{}/{}] {}: {}, {} runs {}",
                    state.answered,
                    state.points.len(),
                    state.points[*point],
                    answer(summary),
                    summary.runs,
                    flags.join(" ")
                );
                state.say(line.trim_end());
            }
            Event::Estimated(estimate) if state.reported_at.elapsed() >= EVERY => {
                state.reported_at = Instant::now();
                state.say(&left(estimate, state.points.len()));
            }
            Event::Warning { code, message } => state.say(&format!("warning {code}: {message}")),
            Event::Stopping { in_flight, ending } => state.say(&stopping(*in_flight, *ending)),
            Event::Finished {
                totals,
                bracketed,
                wall_s,
                core_use,
            } => state.say(&finished(totals, *bracketed, *wall_s, *core_use)),
            Event::PointStarted { .. }
            | Event::ProbeDone { .. }
            | Event::Bracket { .. }
            | Event::Estimated(_)
            | Event::Checkpoint { .. } => {}
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::Sign;
    use crate::store::summary::Totals;

    #[test]
    fn the_first_line_is_there_before_any_event_and_warnings_are_reported() {
        let mut text = Vec::new();
        {
            let lines = Lines::start(&mut text, "Fig. 13");
            lines.event(&Event::Started {
                study: "Fig. 13".into(),
                points: vec![PointLabel {
                    ramp: "rigid".into(),
                    pulse_ms: 0.5,
                    sign: Sign::Minus,
                    axes: vec!["clearance_um=60".into()],
                }],
                threads: 2,
                stored_runs: 7,
            });
            lines.event(&Event::Warning {
                code: "lucky",
                message: "found".into(),
            });
            lines.event(&Event::Finished {
                totals: Totals {
                    points: 3,
                    open: 3,
                    ..Totals::default()
                },
                bracketed: 2,
                wall_s: 119.5,
                core_use: 0.96,
            });
        }
        assert_eq!(
            String::from_utf8(text).expect("text"),
            "sweep of Fig. 13\n1 points, 2 threads, 7 runs in the store\nwarning lucky: found\n\
             3 points: 2 bracketed without their uncertainty, 1 not finished; 0 runs, 0 without verdict; 2 min, cores 96 % busy\n"
        );
    }
}
