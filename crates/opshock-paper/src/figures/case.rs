//! Turns the histories of runs that are drawn beside one another into curves.

use opshock_solver::simulation::History;
use opshock_study::report::chart::{Dash, colour};
use opshock_study::report::{RunCaption, column_named};
use opshock_study::store::history::{Column, head_columns, structure_columns};

/// One run.
#[derive(Clone, Debug)]
pub struct PaperCase {
    /// Word of the ramp model: first part of the columns' names.
    pub ramp: String,
    /// Shock, times and clearances.
    pub caption: RunCaption,
    /// `survives`, or `fails at 1.004 ms`.
    pub verdict: String,
    disk: Vec<Column>,
    head: Vec<Column>,
}

impl PaperCase {
    /// A run with its histories.
    pub fn new(ramp: &str, caption: RunCaption, verdict: String, history: &History) -> Self {
        Self {
            ramp: ramp.into(),
            disk: structure_columns(&history.structure, caption.start_s),
            head: head_columns(&history.head, caption.start_s),
            caption,
            verdict,
        }
    }

    pub(super) fn columns(&self, clock: Clock) -> &[Column] {
        match clock {
            Clock::Disk => &self.disk,
            Clock::Head => &self.head,
        }
    }

    pub(super) fn heading(&self) -> String {
        let ramp = match self.ramp.as_str() {
            "none" => "no ramp".to_owned(),
            ramp => format!("{ramp} ramp"),
        };
        format!("{ramp}: {}", self.verdict)
    }

    /// Drawn times: from 0 of the study's axis to the end of the window, ms.
    pub(super) fn window_ms(&self) -> (f64, f64) {
        let last = column_named(&self.disk, "time_s").values.last();
        (0.0, 1e3 * last.copied().unwrap_or(self.caption.start_s))
    }
}

/// The time a column is given on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Clock {
    /// Grid of disk and ramp.
    Disk,
    /// Accepted steps of the head.
    Head,
}

/// A curve of a panel.
#[derive(Clone, Copy)]
pub(super) struct Curve {
    pub(super) clock: Clock,
    pub(super) column: &'static str,
    /// Name in the legend.
    pub(super) name: &'static str,
    /// From SI to the unit of the axis.
    pub(super) factor: f64,
    pub(super) colour: colour::Rgb,
    pub(super) dash: Dash,
}

pub(super) const fn curve(
    clock: Clock,
    column: &'static str,
    name: &'static str,
    factor: f64,
    colour: colour::Rgb,
    dash: Dash,
) -> Curve {
    Curve {
        clock,
        column,
        name,
        factor,
        colour,
        dash,
    }
}
