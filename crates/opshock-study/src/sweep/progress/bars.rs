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
    answered: usize,
}

impl Bars {
    /// Begins with a line naming the study.
    pub fn start(study: &str) -> Bars {
        let table = MultiProgress::with_draw_target(ProgressDrawTarget::stderr());
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
            answered: 0,
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
                state.answered += 1;
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
            Event::Estimated(estimate) => state.whole.set_message(format!(
                "{} of {} points, {}",
                state.answered,
                state.points.len(),
                left(estimate)
            )),
            Event::Warning { code, message } => state.say(&format!("warning {code}: {message}")),
            Event::Stopping { in_flight, ending } => state.say(&stopping(*in_flight, *ending)),
            Event::Finished {
                totals,
                wall_s,
                core_use,
            } => {
                let rows: Vec<usize> = state.rows.keys().copied().collect();
                for point in rows {
                    state.hide(point);
                }
                state.whole.finish_and_clear();
                state.say(&finished(totals, *wall_s, *core_use));
            }
            Event::ProbeDone { .. } | Event::Checkpoint { .. } => {}
        }
    }
}
