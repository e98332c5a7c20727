//! `opshock sweep` of a study that asks for touch thresholds and nothing that needs a search: computes the
//! amplitude of the first touch of every point, from the unit response of disk and ramp alone.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::{memory, study_file};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::Model;
use opshock_study::study::memory::Demand;
use opshock_study::study::{Point, Study, StudyError, StudyErrors};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// Prints the threshold of every point in the order of tables.
///
/// # Errors
///
/// An output that no sweep answers; a scene that cannot be built.
pub fn run(study: &Study, console: &Console) -> Result<Exit, Failure> {
    let answered = Output::TouchThreshold;
    if let Some(output) = study.outputs.iter().find(|output| **output != answered) {
        let message = format!("a sweep does not answer {output} without critical_shock");
        let allowed = "critical_shock with any others, or touch_threshold alone";
        return Err(refused(study, &message, allowed));
    }
    let plan = Plan::new(&[Output::TouchThreshold], Mode::Auto);
    let runs = study
        .points
        .iter()
        .map(|point| Demand::run(&point.scene, &plan, false));
    memory::check("a point", runs.fold(Demand::default(), Demand::max), 1)?;
    let mut rows = Vec::new();
    for place in study.table_order() {
        let point = &study.points[place];
        let model = Model::assemble(&point.scene, &plan, None)
            .map_err(|error| study_file::cannot_be_simulated(study, &error))?;
        let onset = model
            .structure()
            .touch_amplitude_m_per_s2(point.factor() > 0.0);
        rows.push((point, onset.map(|a| a / STANDARD_GRAVITY_M_PER_S2)));
    }
    if console.json {
        let points: Vec<Value> = rows
            .iter()
            .map(|(point, onset)| row(point, *onset))
            .collect();
        console.result_json(&json!({
            "study": study.name,
            "digest": study.digest_hex(),
            "points": points,
        }))?;
    } else {
        console.result(&text(&rows))?;
    }
    Ok(Exit::Complete)
}

/// Refuses a study whose outputs need no search.
///
/// # Errors
///
/// E158.
pub fn refuse_without_search(study: &Study) -> Result<(), Failure> {
    if study.asks_for(Output::CriticalShock) {
        return Ok(());
    }
    let message = "the outputs are without critical_shock: there is nothing to search";
    Err(refused(study, message, "critical_shock with any others"))
}

fn refused(study: &Study, message: &str, allowed: &str) -> Failure {
    let file = study.path.display().to_string();
    let mut fault = StudyError::in_file("E158", &file, message)
        .allowed(allowed)
        .hint("`opshock run` gives the outputs of one shock");
    fault.key = "outputs".to_owned();
    StudyErrors::from(fault).into()
}

fn row(point: &Point, onset_g: Option<f64>) -> Value {
    let mut row = coordinates(point);
    row.insert("onset_g".to_owned(), json!(onset_g));
    Value::Object(row)
}

/// Ramp, width, sign and further axes of a point, as every table names them.
pub fn coordinates(point: &Point) -> Map<String, Value> {
    let mut map = Map::new();
    map.insert("ramp".to_owned(), json!(point.ramp.as_str()));
    map.insert("pulse_ms".to_owned(), json!(point.pulse_ms));
    map.insert("sign".to_owned(), json!(point.sign.to_string()));
    for (name, value) in &point.axes {
        map.insert(name.clone(), value.to_json());
    }
    map
}

fn text(rows: &[(&Point, Option<f64>)]) -> String {
    let mut text = String::from("first touch of disk and ramp in the window\n");
    for (point, onset) in rows {
        let onset = onset.map_or("never".to_owned(), |g| format!("{g:.3} G"));
        let _ = writeln!(text, "  {:<32}  {onset:>12}", point.label());
    }
    text
}
