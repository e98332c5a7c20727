//! Progress as a live table of brackets on a terminal.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Duration;

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::event::{Event, PointLabel, Progress};
use super::text::{answer, bracket, finished, left, stopping};

/// Points shown at once; those that changed last.
const ROWS: usize = 12;

/// A line per point at work, and one about the whole.
pub struct Bars(Mutex<State>);

struct State {
    table: MultiProgress,
    whole: ProgressBar,
    points: Vec<PointLabel>,
    rows: BTreeMap<usize, (ProgressBar, u64)>,
    /// Number of changes, to find the row that changed longest ago.
    clock: u64,
}

impl Bars {
    /// Begins with a line naming the study.
    pub fn start(study: &str) -> Bars {
        Bars::on(ProgressDrawTarget::stderr(), study)
    }

    fn on(target: ProgressDrawTarget, study: &str) -> Bars {
        let table = MultiProgress::with_draw_target(target);
        let whole = table.add(ProgressBar::new_spinner().with_style(style("{spinner} {wide_msg}")));
        whole.set_message(format!("sweep of {study}"));
        whole.enable_steady_tick(Duration::from_millis(120));
        whole.tick();
        Bars(Mutex::new(State {
            table,
            whole,
            points: Vec::new(),
            rows: BTreeMap::new(),
            clock: 0,
        }))
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("a fixed template")
}

impl State {
    fn show(&mut self, point: usize, text: &str) {
        self.clock += 1;
        if !self.rows.contains_key(&point) {
            if self.rows.len() >= ROWS {
                let oldest = self.rows.iter().min_by_key(|(_, (_, clock))| *clock);
                if let Some(oldest) = oldest.map(|(&point, _)| point) {
                    self.hide(oldest);
                }
            }
            let row = ProgressBar::new_spinner().with_style(style("  {prefix:<34} {wide_msg}"));
            row.set_prefix(self.points[point].to_string());
            let row = self.table.insert_before(&self.whole, row);
            self.rows.insert(point, (row, 0));
        }
        if let Some((row, clock)) = self.rows.get_mut(&point) {
            *clock = self.clock;
            row.set_message(text.to_owned());
            row.tick();
        }
    }

    fn hide(&mut self, point: usize) {
        if let Some((row, _)) = self.rows.remove(&point) {
            row.finish_and_clear();
            self.table.remove(&row);
        }
    }

    fn say(&self, line: &str) {
        // Fails only when the terminal is gone.
        let _ = self.table.println(line);
    }
}

impl Progress for Bars {
    fn event(&self, event: &Event) {
        let mut state = self
            .0
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        let state = &mut *state;
        match event {
            Event::Started { points, .. } => state.points.clone_from(points),
            Event::PointStarted { point } => state.show(*point, ""),
            Event::Bracket {
                point,
                survived_g,
                failed_g,
                runs,
            } => {
                let text = format!("{:<22} {runs:>3} runs", bracket(*survived_g, *failed_g));
                state.show(*point, &text);
            }
            Event::PointDone {
                point,
                summary,
                is_stored,
            } => {
                state.hide(*point);
                // An earlier sweep or round printed it.
                if *is_stored {
                    return;
                }
                let flags: Vec<&str> = summary.flags.iter().map(|flag| flag.as_str()).collect();
                let line = format!(
                    "  {:<34} {:<22} {:>3} runs  {}",
                    state.points[*point].to_string(),
                    answer(summary),
                    summary.runs,
                    flags.join(" ")
                );
                state.say(line.trim_end());
            }
            Event::Estimated(estimate) => {
                let words = left(estimate, state.points.len());
                state.whole.set_message(words);
            }
            Event::Warning { code, message } => state.say(&format!("warning {code}: {message}")),
            Event::Stopping { in_flight, ending } => state.say(&stopping(*in_flight, *ending)),
            Event::Finished {
                totals,
                bracketed,
                wall_s,
                core_use,
            } => {
                let rows: Vec<usize> = state.rows.keys().copied().collect();
                for point in rows {
                    state.hide(point);
                }
                state.whole.finish_and_clear();
                state.say(&finished(totals, *bracketed, *wall_s, *core_use));
            }
            Event::ProbeDone { .. } | Event::Checkpoint { .. } => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Result;
    use std::sync::Arc;

    use indicatif::TermLike;

    use super::*;
    use crate::search::Sign;
    use crate::store::summary::Totals;
    use crate::sweep::progress::Estimate;
    use crate::sweep::spread::Spread;

    /// A terminal that keeps what is written.
    #[derive(Clone, Debug, Default)]
    struct Written(Arc<Mutex<String>>);

    impl Written {
        fn add(&self, text: &str) -> Result<()> {
            self.0.lock().expect("sound").push_str(text);
            Ok(())
        }
    }

    impl TermLike for Written {
        fn width(&self) -> u16 {
            120
        }
        fn move_cursor_up(&self, _: usize) -> Result<()> {
            Ok(())
        }
        fn move_cursor_down(&self, _: usize) -> Result<()> {
            Ok(())
        }
        fn move_cursor_right(&self, _: usize) -> Result<()> {
            Ok(())
        }
        fn move_cursor_left(&self, _: usize) -> Result<()> {
            Ok(())
        }
        fn write_line(&self, text: &str) -> Result<()> {
            self.add(&format!("{text}\n"))
        }
        fn write_str(&self, text: &str) -> Result<()> {
            self.add(text)
        }
        fn clear_line(&self) -> Result<()> {
            Ok(())
        }
        fn flush(&self) -> Result<()> {
            Ok(())
        }
    }

    #[test]
    fn brackets_are_counted_before_answers_and_what_ends_early_says_what_it_has() {
        let written = Written::default();
        let target = ProgressDrawTarget::term_like(Box::new(written.clone()));
        let bars = Bars::on(target, "Fig. 13");
        let label = |pulse_ms| PointLabel {
            ramp: "rigid".into(),
            pulse_ms,
            sign: Sign::Minus,
            axes: Vec::new(),
        };
        bars.event(&Event::Started {
            study: "Fig. 13".into(),
            points: vec![label(0.5), label(1.0), label(2.0)],
            threads: 2,
            stored_runs: 0,
        });
        bars.event(&Event::Bracket {
            point: 1,
            survived_g: Some(331.25),
            failed_g: Some(334.5),
            runs: 9,
        });
        bars.event(&Event::Estimated(Estimate {
            bracketed: 3,
            answered: 0,
            runs_done: 27,
            runs_left: Spread {
                min: 40.0,
                likely: 50.0,
                max: 60.0,
            },
            ..Estimate::default()
        }));
        // Drawn at most some times a second.
        std::thread::sleep(Duration::from_millis(300));
        bars.event(&Event::Finished {
            totals: Totals {
                points: 3,
                open: 3,
                runs: 27,
                ..Totals::default()
            },
            bracketed: 3,
            wall_s: 4.0,
            core_use: 1.0,
        });
        let text = written.0.lock().expect("sound").clone();
        for part in [
            "331.2 to 334.5 G         9 runs",
            "3 of 3 points bracketed, 0 answered; 27 runs done, 40 to 60 left",
            "3 points: 3 bracketed without their uncertainty; 27 runs, 0 without verdict",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
