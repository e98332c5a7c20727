//! Simulations: one with its history, or many on all cores.

use crate::failure::{or_raise, raised};
use crate::signals::interruptible;
use crate::study::Study;
use opshock::cli::failure::Failure;
use opshock::cli::{memory, run, study_file};
use opshock_study::batch::{Shock, Simulated, simulate_all};
use opshock_study::report::RunJson;
use opshock_study::store::history::{Column, head_columns, root_columns};
use opshock_study::study::memory::Demand;
use opshock_study::study::{Choice, Shot};
use opshock_study::sweep::StopFlag;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::time::Instant;

/// A column: name, unit, description, and its numbers as bytes of 64-bit floats.
type Columns<'py> = Vec<(
    &'static str,
    &'static str,
    &'static str,
    Bound<'py, PyBytes>,
)>;
/// Pressure fields: times, lines across, lines along, pressure, gap.
type Fields<'py> = [Bound<'py, PyBytes>; 5];

/// The shock of a study of one point.
fn shot(study: &Study, amplitude_g: f64) -> Result<Shot, Failure> {
    let amplitude_g = Some(amplitude_g);
    let choice = Choice {
        amplitude_g,
        ..Choice::default()
    };
    Ok(study.study.select(&choice)?)
}

/// Simulates one shock of a study of one point: the answer as JSON; with `record` the columns on the structure's time,
/// those on the head's, and the pressure fields.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "read by one Python function")]
pub fn simulate<'py>(
    py: Python<'py>,
    study: &Study,
    amplitude_g: f64,
    record: bool,
) -> PyResult<(
    String,
    Option<(Columns<'py>, Columns<'py>, Option<Fields<'py>>)>,
)> {
    let shot = or_raise(py, shot(study, amplitude_g))?;
    let began = Instant::now();
    let outcome = py.detach(|| run::simulated(&study.study, &shot, record));
    let outcome = or_raise(py, outcome)?;
    let start_s = study.study.start_s;
    let answer = RunJson::new(&outcome, start_s, began.elapsed().as_secs_f64());
    let history = outcome.history.as_ref().map(|history| {
        let head = match history.head.time_s.is_empty() {
            true => Vec::new(),
            false => head_columns(&history.head, start_s),
        };
        let fields = history.fields.as_ref().map(|fields| {
            let time_s: Vec<f64> = fields.time_s.iter().map(|t| t + start_s).collect();
            [
                &time_s,
                &fields.y_lines_m,
                &fields.x_lines_m,
                &fields.pressure_pa,
                &fields.gap_m,
            ]
            .map(|numbers| bytes(py, numbers))
        });
        let root = columns(py, root_columns(history, start_s));
        (root, columns(py, head), fields)
    });
    Ok((json(&answer), history))
}

/// Simulates shocks of studies of one point each on `threads` threads: an answer as JSON for each.
#[pyfunction]
pub fn simulate_many(
    py: Python<'_>,
    studies: Vec<Bound<'_, Study>>,
    shocks: Vec<(usize, f64)>,
    threads: usize,
) -> PyResult<Vec<String>> {
    let studies: Vec<&Study> = studies.iter().map(|study| study.get()).collect();
    let shots: Result<Vec<Shot>, Failure> = shocks
        .iter()
        .map(|&(study, amplitude_g)| shot(studies[study], amplitude_g))
        .collect();
    let shots = or_raise(py, shots)?;
    let plans: Vec<_> = studies.iter().map(|study| study.study.plan()).collect();
    let scenes = studies.iter().map(|study| &study.study.points[0].scene);
    let scenes: Vec<_> = scenes.zip(&plans).collect();
    let threads = threads.clamp(1, shocks.len().max(1));
    let demands = scenes
        .iter()
        .map(|(scene, plan)| Demand::run(scene, plan, false));
    let demand = demands.fold(Demand::default(), Demand::max);
    or_raise(py, memory::check("the batch", demand, threads))?;
    let list: Vec<Shock> = shocks
        .iter()
        .zip(&shots)
        .map(|(&(scene, _), shot)| Shock {
            scene,
            amplitude_m_per_s2: shot.amplitude_m_per_s2,
        })
        .collect();
    let stop = StopFlag::default();
    let answers = interruptible(py, &stop, || simulate_all(&scenes, &list, threads, &stop))?;
    let answers = answers
        .into_iter()
        .zip(&shocks)
        .filter_map(|(answer, &(study, _))| {
            let Simulated { outcome, wall_s } = answer?;
            let study = &studies[study].study;
            let outcome =
                outcome.map(|outcome| json(&RunJson::new(&outcome, study.start_s, wall_s)));
            Some(
                outcome.map_err(|error| raised(py, study_file::cannot_be_simulated(study, &error))),
            )
        });
    answers.collect()
}

fn columns(py: Python<'_>, columns: Vec<Column>) -> Columns<'_> {
    let named = |column: Column| {
        let Column {
            name,
            units,
            description,
            values,
        } = column;
        (name, units, description, bytes(py, &values))
    };
    columns.into_iter().map(named).collect()
}

/// Numbers as Python takes them: 64-bit floats in the machine's order.
fn bytes<'py>(py: Python<'py>, numbers: &[f64]) -> Bound<'py, PyBytes> {
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_ne_bytes()).collect();
    PyBytes::new(py, &bytes)
}

/// JSON of an answer; numbers that are not finite become null.
fn json(answer: &RunJson) -> String {
    serde_json::to_string(answer).unwrap_or_else(|_| "null".to_owned())
}
