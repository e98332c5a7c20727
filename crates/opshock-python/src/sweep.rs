//! Sweeps into a store, with progress and Ctrl-C.

use crate::failure::or_raise;
use crate::signals::interruptible;
use crate::study::Study;
use opshock::cli::failure::Failure;
use opshock::cli::sweep::{Observer, in_rounds};
use opshock::cli::{memory, study_file};
use opshock_study::sweep::{Event, Progress, StopFlag, SweepOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Passes events on to a Python function; what it raises stops the sweep.
struct Caller {
    function: Arc<Py<PyAny>>,
    stop: StopFlag,
    raised: Arc<Mutex<Option<PyErr>>>,
}

impl Caller {
    fn call(&self, event: &Value) {
        let is_over = || {
            self.raised
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .is_some()
        };
        if is_over() {
            return;
        }
        let called = Python::attach(|py| self.function.call1(py, (event.to_string(),)).map(drop));
        if let Err(error) = called {
            self.stop.ask();
            let mut raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
            raised.get_or_insert(error);
        }
    }
}

impl Progress for Caller {
    fn event(&self, event: &Event) {
        if let Some(event) = reported(event) {
            self.call(&event);
        }
    }
}

/// The events that a progress bar shows.
fn reported(event: &Event) -> Option<Value> {
    Some(match event {
        Event::Started { points, .. } => json!({"event": "started", "points": points.len()}),
        Event::PointDone { .. } => json!({"event": "point"}),
        Event::Estimated(estimate) => json!({
            "event": "estimate",
            "runs_done": estimate.runs_done,
            "left_s": estimate.left_s.map(|left| [left.min, left.likely, left.max]),
        }),
        Event::Warning { code, message } => {
            json!({"event": "warning", "code": code, "message": message})
        }
        _ => return None,
    })
}

/// Finds every critical shock of a study, into the store in `folder`.
#[pyfunction]
#[expect(
    clippy::too_many_arguments,
    reason = "named by the Python function above it"
)]
pub fn sweep(
    py: Python<'_>,
    study: &Study,
    folder: PathBuf,
    threads: usize,
    budget_s: Option<f64>,
    retry_undecided: bool,
    reuse: Vec<PathBuf>,
    accept: Vec<String>,
    progress: Py<PyAny>,
) -> PyResult<()> {
    or_raise(py, study_file::refuse_unaccepted(&study.study, &accept))?;
    let budget = budget_s.map(Duration::try_from_secs_f64).transpose();
    let budget = budget.map_err(|_| PyValueError::new_err("budget_s must be a time >= 0 in s"))?;
    let stop = StopFlag::default();
    let options = SweepOptions {
        stop: stop.clone(),
        budget,
        retry_undecided,
        reuse,
        ..SweepOptions::with_threads(threads)
    };
    let (function, raised) = (Arc::new(progress), Arc::new(Mutex::new(None)));
    let caller = || Caller {
        function: Arc::clone(&function),
        stop: stop.clone(),
        raised: Arc::clone(&raised),
    };
    let work = || -> Result<(), Failure> {
        let observer = Observer {
            progress: &|_| Box::new(caller()),
            message: &|message| caller().call(&json!({"event": "message", "message": message})),
        };
        let available = memory::available_bytes();
        in_rounds(study.study.clone(), &folder, options, available, &observer)?;
        Ok(())
    };
    let ended = interruptible(py, &stop, work)?;
    if let Some(error) = raised.lock().unwrap_or_else(PoisonError::into_inner).take() {
        return Err(error);
    }
    or_raise(py, ended)
}
