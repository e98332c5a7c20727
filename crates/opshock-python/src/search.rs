//! The search of one critical shock by asking: verdicts come from outside, by whatever means.

use crate::failure::raised;
use crate::study::Study;
use opshock_study::search::{
    AmplitudeGrid, PointSearch, Retry, SearchSettings, Start, UndecidedCause, Verdict,
};
use opshock_study::sweep::SweepInput;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use serde_json::json;
use std::sync::{Mutex, PoisonError};

/// A search that names amplitudes and takes verdicts.
#[pyclass(frozen, module = "opshock._native")]
pub struct Search {
    grid: AmplitudeGrid,
    /// The failure is a clearance, so that those of survivors say how far they are from it.
    fails_by_clearance: bool,
    /// With the number of verdicts taken.
    search: Mutex<(PointSearch, u64)>,
}

impl Search {
    fn locked(&self) -> std::sync::MutexGuard<'_, (PointSearch, u64)> {
        self.search.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Search {
    /// By the range, tolerance and scan of a study; starts at `hint_g` if given.
    #[new]
    fn new(py: Python<'_>, study: &Study, hint_g: Option<f64>) -> PyResult<Self> {
        let input = SweepInput::of(&study.study)
            .map_err(|error| raised(py, opshock::cli::failure::Failure::Internal(error.into())))?;
        // The doubled window is the simulation's to check: an experiment has none.
        let settings = SearchSettings {
            window_check: false,
            ..input.settings
        };
        let start = Start {
            hint_g,
            onset_index: None,
            fail_below_m: input.points[0].coordinates.fail_below_m,
            width_rank: 0,
        };
        Ok(Self {
            grid: settings.grid,
            fails_by_clearance: study.study.points[0].scene.damage.is_none(),
            search: Mutex::new((PointSearch::new(settings, start), 0)),
        })
    }

    /// The amplitude to try next, G, and what for; nothing when the search has its answer.
    fn ask(&self) -> Option<(f64, &'static str)> {
        let asked = self.locked().0.ask()?;
        Some((
            self.grid.amplitude_g(asked.probe.index),
            asked.purpose.as_str(),
        ))
    }

    /// Takes the verdict of the amplitude asked for, and the smallest clearance of its survivor, m.
    fn tell(&self, verdict: &str, min_clearance_m: Option<f64>) -> PyResult<()> {
        let mut locked = self.locked();
        let (search, taken) = &mut *locked;
        let Some(asked) = search.ask() else {
            let message = "the search has its answer: ask() gives None";
            return Err(PyRuntimeError::new_err(message));
        };
        match verdict {
            "survives" => {
                let margin_m = min_clearance_m.filter(|_| self.fails_by_clearance);
                search.report_margin(&Verdict::Survives, margin_m);
            }
            "fails" => search.tell(&Verdict::Fails {
                t_fail_s: 0.0,
                x_m: 0.0,
                y_m: 0.0,
            }),
            "undecided" => {
                let undecided = Verdict::Undecided {
                    cause: UndecidedCause::NotConverged,
                    message: String::new(),
                };
                // Retries by other numerical methods are the simulation's: here one answer is all there is.
                search.tell(&undecided);
                while search.ask().is_some_and(|next| {
                    next.probe.index == asked.probe.index && next.probe.retry != Retry::None
                }) {
                    search.tell(&undecided);
                }
            }
            other => {
                let allowed = "must be survives, fails or undecided";
                return Err(PyValueError::new_err(format!(
                    "verdict = {other:?}: {allowed}"
                )));
            }
        }
        *taken += 1;
        Ok(())
    }

    /// What is known now, as JSON.
    fn findings(&self) -> String {
        let locked = self.locked();
        let found = locked.0.findings();
        let g = |index: i32| self.grid.amplitude_g(index);
        let brackets = found.brackets.iter().map(|&(low, high)| [g(low), g(high)]);
        let flags = found.flags.iter().map(|flag| flag.as_str());
        json!({
            "status": found.status.as_str(),
            "survived_g": found.survivor.map(g),
            "failed_g": found.failure.map(g),
            "brackets_g": brackets.collect::<Vec<_>>(),
            "flags": flags.collect::<Vec<_>>(),
            "runs": locked.1,
        })
        .to_string()
    }
}
