//! `opshock run`: simulates one shock of a study; writes its histories and plots.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::selection::ShockArgs;
use super::{memory, study_file};
use clap::Args;
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2;
use opshock_solver::scene::Scene;
use opshock_solver::scene::plan::Output;
use opshock_solver::shock::PulseShape;
use opshock_solver::simulation::{
    FailureEvidence, History, Model, Outcome, Request, Verdict, Workspace, simulate,
};
use opshock_study::provenance;
use opshock_study::report::{
    MechanismJson, RunCaption, RunJson, run_figures, run_text, verdict_word, write_figures,
};
use opshock_study::store::history::{HistoryHeader, fields_path, write_csv, write_hdf5};
use opshock_study::study::memory::Demand;
use opshock_study::study::{Shot, Study};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Simulate one shock: verdict, clearance, contacts, energy
#[derive(Args, Debug)]
pub struct RunArgs {
    /// Study file
    study: PathBuf,
    #[command(flatten)]
    shock: ShockArgs,
    /// Write the histories, as HDF5 or CSV by the ending
    #[arg(long, value_name = "FILE.h5|FILE.csv")]
    history: Option<PathBuf>,
    /// Write plots as SVG, PNG and CSV into a folder
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
}

/// Format of a history file.
#[derive(Clone, Copy)]
enum HistoryFormat {
    Hdf5,
    Csv,
}

/// Runs the command.
pub fn run(arguments: &RunArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    // What cannot be written is said before anything is computed.
    let format = arguments
        .history
        .as_deref()
        .map(history_format)
        .transpose()?;
    let study = study_file::read(&arguments.study, global, console)?;
    let shot = study.select(&arguments.shock.choice())?;
    let record = format.is_some() || arguments.plots.is_some();

    let started = Instant::now();
    let model = assembled(&study, &shot, record)?;
    let outcome = run_on(&model, &shot, record);
    let wall_s = started.elapsed().as_secs_f64();
    let mut answer = RunJson::new(&outcome, study.start_s, wall_s);
    let fails = matches!(outcome.verdict, Some(Verdict::Fails { .. }));
    // The mechanism is seen in a history, if that has room.
    if fails && !record && has_room(&study, &shot, true).is_ok() {
        answer.mechanism = MechanismJson::of(&run_on(&model, &shot, true));
    }
    // Its memory is wanted for the pictures.
    drop(model);

    for warning in &outcome.warnings {
        console.note(&format!("warning: {}: {}", warning.code, warning.message));
    }
    if study.asks_for(Output::PressureField) && format.is_none() {
        console.note("pressure fields are kept with --history FILE");
    }
    if let Some(history) = &outcome.history {
        if let (Some(path), Some(format)) = (&arguments.history, format) {
            write_history(path, format, history, &study, &shot, &outcome)?;
            console.note(&format!("wrote {}", path.display()));
            report_fields(path, format, history, &study, console);
        }
        if let Some(folder) = &arguments.plots {
            let figures = run_figures(history, &caption(&study, &shot, &outcome));
            let written = write_figures(folder, &figures)?;
            console.note(&format!(
                "wrote {} files into {}",
                written.len(),
                folder.display()
            ));
        }
    }
    if console.json {
        console.result_json(&answer)?;
    } else {
        console.result(&run_text(&shock_words(&study, &shot), &answer))?;
    }
    Ok(match outcome.verdict {
        Some(Verdict::Undecided { .. }) => Exit::Open,
        _ => Exit::Complete,
    })
}

/// Runs the shock by the study's plan.
///
/// # Errors
///
/// The run does not fit into the memory; the scene cannot be simulated.
pub fn simulated(study: &Study, shot: &Shot, record: bool) -> Result<Outcome, Failure> {
    let model = assembled(study, shot, record)?;
    Ok(run_on(&model, shot, record))
}

fn assembled(study: &Study, shot: &Shot, record: bool) -> Result<Model, Failure> {
    has_room(study, shot, record)?;
    Model::assemble(&shot.point.scene, &study.plan(), None)
        .map_err(|error| study_file::cannot_be_simulated(study, &error))
}

fn has_room(study: &Study, shot: &Shot, record: bool) -> Result<(), Failure> {
    let demand = Demand::run(&shot.point.scene, &study.plan(), record);
    memory::check("the run", demand, 1)
}

fn run_on(model: &Model, shot: &Shot, record: bool) -> Outcome {
    let request = Request {
        amplitude_m_per_s2: shot.amplitude_m_per_s2,
        record,
    };
    simulate(model, &request, &mut Workspace::default())
}

/// What became of the pressure fields asked for: where they are, and which the run did not reach.
fn report_fields(
    path: &Path,
    format: HistoryFormat,
    history: &History,
    study: &Study,
    console: &Console,
) {
    let Some(fields) = &history.fields else {
        return;
    };
    let place = match format {
        HistoryFormat::Hdf5 => format!("{}, group fields", path.display()),
        HistoryFormat::Csv => fields_path(path).display().to_string(),
    };
    let (kept, asked) = (fields.time_s.len(), study.field_times_s.len());
    console.note(&format!("{kept} of {asked} pressure fields in {place}"));
    if kept < asked {
        console.note("the head's run ended before the others");
    }
}

fn history_format(path: &Path) -> Result<HistoryFormat, Failure> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("h5" | "hdf5") => Ok(HistoryFormat::Hdf5),
        Some("csv") => Ok(HistoryFormat::Csv),
        _ => Err(Failure::Usage(vec![Fault {
            key: Some("--history".into()),
            value: Some(path.display().to_string()),
            allowed: Some("a name that ends in .h5 or .csv".into()),
            ..Fault::new(
                "usage",
                format!("--history {}: unknown format", path.display()),
            )
        }])),
    }
}

fn write_history(
    path: &Path,
    format: HistoryFormat,
    history: &History,
    study: &Study,
    shot: &Shot,
    outcome: &Outcome,
) -> Result<(), Failure> {
    match format {
        HistoryFormat::Csv => write_csv(path, history, study.start_s)?,
        HistoryFormat::Hdf5 => write_hdf5(path, history, &header(study, shot, outcome))?,
    }
    Ok(())
}

fn header(study: &Study, shot: &Shot, outcome: &Outcome) -> HistoryHeader {
    let point = &shot.point;
    let axes = point.axes.iter();
    HistoryHeader {
        study: study.name.clone(),
        digest: study.digest_hex(),
        program_version: provenance::VERSION.to_owned(),
        commit: provenance::COMMIT.to_owned(),
        ramp: point.ramp.to_string(),
        pulse_ms: point.pulse_ms,
        sign: point.sign,
        axes: axes
            .map(|(name, value)| (name.clone(), value.into()))
            .collect(),
        amplitude_g: shot.amplitude_g,
        start_s: study.start_s,
        verdict: outcome
            .verdict
            .as_ref()
            .map_or("none", verdict_word)
            .to_owned(),
        t_fail_s: t_fail_s(study, outcome),
        mechanism: FailureEvidence::of(outcome).map(|evidence| evidence.mechanism()),
        effects: outcome
            .effects
            .iter()
            .map(|effect| (*effect).to_owned())
            .collect(),
        run: String::new(),
    }
}

/// What the pictures say about a run.
pub(super) fn caption(study: &Study, shot: &Shot, outcome: &Outcome) -> RunCaption {
    let scene: &Scene = &shot.point.scene;
    RunCaption {
        shock: shock_words(study, shot),
        start_s: study.start_s,
        width_s: scene.pulse.width_s,
        t_fail_s: t_fail_s(study, outcome),
        ramp_clearance_m: match scene.ramp.model.is_absent() {
            true => None,
            false => Some((scene.ramp.clearance_top_m, scene.ramp.clearance_bottom_m)),
        },
        fails_by_damage: scene.damage.is_some(),
        fail_below_m: scene.fail_below_m,
    }
}

fn t_fail_s(study: &Study, outcome: &Outcome) -> Option<f64> {
    match outcome.verdict {
        Some(Verdict::Fails { t_fail_s, .. }) => Some(t_fail_s + study.start_s),
        _ => None,
    }
}

/// `rigid ramp, 400 G, 2 ms half-sine, sign +`, and the further axes.
fn shock_words(study: &Study, shot: &Shot) -> String {
    let point = &shot.point;
    let ramp = match point.ramp.as_str() {
        "none" => "no ramp".to_owned(),
        ramp => format!("{ramp} ramp"),
    };
    let shape = match point.scene.pulse.shape {
        PulseShape::HalfSine => "half-sine",
        PulseShape::Haversine => "haversine",
        PulseShape::Square => "square pulse",
        PulseShape::Trapezoid { .. } => "trapezoid",
        PulseShape::DampedSine { .. } => "damped sine",
        PulseShape::Table { .. } => "sampled pulse",
    };
    let measured = study.measured.as_ref().filter(|pulse| !pulse.is_stretched);
    let factor = measured.map_or(String::new(), |pulse| {
        let peak_g = pulse.used.peak_m_per_s2().abs() / STANDARD_GRAVITY_M_PER_S2;
        format!(" ({:.3} of the record)", shot.amplitude_g / peak_g)
    });
    let mut words = format!(
        "{ramp}, {} G{factor}, {} ms {shape}, sign {}",
        shot.amplitude_g, point.pulse_ms, point.sign
    );
    for (name, value) in &point.axes {
        words.push_str(&format!(", {name} = {value}"));
    }
    words
}
