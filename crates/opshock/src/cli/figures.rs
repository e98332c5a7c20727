//! `opshock figures`: draws the figures of the paper from a study's scene, runs and critical shocks.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::run::{caption, simulated};
use super::{stored, study_file};
use clap::Args;
use opshock_paper::figures::{
    PaperCase, PaperFigure, critical_figure, deformable_ramp_drawing, long_shock_figures,
    plan_drawing, pulse_figure, rigid_ramp_drawing, short_shock_figures, write_paper_figures,
};
use opshock_solver::scene::Scene;
use opshock_solver::simulation::Verdict;
use opshock_study::provenance;
use opshock_study::report::read_table;
use opshock_study::store::{StoreError, Summary};
use opshock_study::study::{Choice, Ramp, Sign, Study};
use std::path::{Path, PathBuf};

/// Draw the paper's figures: drive, ramps, two shocks with every ramp model, critical shocks
#[derive(Args, Debug)]
pub struct FiguresArgs {
    /// Study file
    study: PathBuf,
    /// Folder of the figures
    #[arg(long, value_name = "DIR", default_value = "results/paper")]
    out: PathBuf,
    /// Shock of figures 5 to 9
    #[arg(long, value_name = "MS:G", value_parser = shock, default_value = "2:400")]
    long: Shock,
    /// Shock of figures 10 to 12
    #[arg(long, value_name = "MS:G", value_parser = shock, default_value = "0.5:200")]
    short: Shock,
    /// Critical shocks of figure 13 [default: the store of the study, when it has been swept]
    #[arg(long, value_name = "STORE|TABLE.csv")]
    critical: Option<PathBuf>,
}

/// Width and amplitude.
#[derive(Clone, Copy, Debug)]
struct Shock {
    pulse_ms: f64,
    amplitude_g: f64,
}

fn shock(text: &str) -> Result<Shock, String> {
    let numbers = text
        .split_once(':')
        .and_then(|(ms, g)| Some((ms.parse().ok()?, g.parse().ok()?)));
    match numbers {
        Some((pulse_ms, amplitude_g)) => Ok(Shock {
            pulse_ms,
            amplitude_g,
        }),
        None => Err("must be MS:G, as 2:400".into()),
    }
}

/// Runs the command.
pub fn run(
    arguments: &FiguresArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let study = study_file::read(&arguments.study, global, console)?;
    let program = provenance::program();
    // What cannot be read is said before anything is computed; nothing is written before all is.
    let critical = match &arguments.critical {
        Some(named) => Some(critical_shocks(named, console)?),
        None => swept(&arguments.study, global, console, "no figure 13")?,
    };
    let long = cases(&study, arguments.long, console)?;
    let short = cases(&study, arguments.short, console)?;

    let mut figures = drawings(&study, arguments.long, console, &program)?;
    if let (Some(first), Some(other)) = (long.first(), short.first()) {
        figures.push(pulse_figure(first, other, &program));
    }
    figures.extend(long_shock_figures(&long, &program));
    figures.extend(short_shock_figures(&short, &program));
    if let Some((summary, source)) = &critical {
        figures.push(critical_figure(summary, source));
    }
    let provenance = format!(
        "{program}, study {} ({})",
        study.path.display(),
        study.digest_hex()
    );
    let written = write_paper_figures(&arguments.out, &figures, &provenance)?;
    let files: Vec<String> = written
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    if console.json {
        console.result_json(&serde_json::json!({ "files": files }))?;
    } else {
        console.result(&(files.join("\n") + "\n"))?;
    }
    Ok(Exit::Complete)
}

/// The critical shocks in the store of a study and the store's name; `None`, with a message that opens with
/// `without`, where the study as it is has not been swept.
pub(super) fn swept(
    study: &Path,
    global: &GlobalArgs,
    console: &Console,
    without: &str,
) -> Result<Option<(Summary, String)>, Failure> {
    let source = stored::source(study, global)?;
    match stored::read(&source, console) {
        Ok(stored) => Ok(Some((stored.summary, source.folder.display().to_string()))),
        Err(Failure::Store(error @ (StoreError::Empty { .. } | StoreError::OtherStudy { .. }))) => {
            console.note(&format!(
                "{without}: {error}; --critical names a table or another store"
            ));
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

/// Critical shocks out of a store or a table, and its name; of a table with its digest, which says
/// whether it is still the one that was read.
pub(super) fn critical_shocks(
    path: &Path,
    console: &Console,
) -> Result<(Summary, String), Failure> {
    let mut name = path.display().to_string();
    let summary = if path.is_dir() {
        stored::read(&stored::Source::of_folder(path), console)?.summary
    } else {
        let (summary, digest) = read_table(path).map_err(|error| {
            let mut message = error.to_string();
            if let Some(reason) = std::error::Error::source(&error) {
                message = format!("{message}: {reason}");
            }
            Failure::Usage(vec![Fault {
                key: Some("--critical".into()),
                value: Some(name.clone()),
                allowed: Some("a store, or the table.csv of a report".into()),
                ..Fault::new("usage", message)
            }])
        })?;
        name += &format!(" (blake3 {})", &digest[..16]);
        summary
    };
    Ok((summary, name))
}

/// Runs a shock with every ramp model of the study, sign +.
fn cases(study: &Study, shock: Shock, console: &Console) -> Result<Vec<PaperCase>, Failure> {
    let mut cases = Vec::new();
    for &ramp in &study.ramps {
        let shot = study.select(&Choice {
            amplitude_g: Some(shock.amplitude_g),
            ..choice(ramp, shock)
        })?;
        let outcome = simulated(study, &shot, true)?;
        for warning in &outcome.warnings {
            console.note(&format!(
                "warning: {}: {}: {}",
                shot.point.label(),
                warning.code,
                warning.message
            ));
        }
        let caption = caption(study, &shot, &outcome);
        let verdict = match &outcome.verdict {
            Some(Verdict::Survives) => "survives".to_owned(),
            Some(Verdict::Fails { t_fail_s, .. }) => {
                format!("fails at {:.3} ms", 1e3 * (t_fail_s + study.start_s))
            }
            Some(Verdict::Undecided { .. }) | None => "undecided".to_owned(),
        };
        let history = outcome
            .history
            .filter(|history| !history.head.time_s.is_empty());
        let Some(history) = history else {
            return Err(Failure::Usage(vec![Fault {
                key: Some("outputs".into()),
                value: Some(study.output_words().join(", ")),
                allowed: Some("also min_clearance and slider_attitude".into()),
                ..Fault::new(
                    "usage",
                    format!(
                        "{}: its outputs leave out the head, which the figures show",
                        study.path.display()
                    ),
                )
            }]));
        };
        cases.push(PaperCase::new(ramp.as_str(), caption, verdict, &history));
    }
    Ok(cases)
}

/// Fig. 1 to 3; those of ramp models that the study does not have are left out, with a message.
fn drawings(
    study: &Study,
    shock: Shock,
    console: &Console,
    program: &str,
) -> Result<Vec<PaperFigure>, Failure> {
    let scene = |ramp: Ramp| -> Result<Scene, Failure> {
        Ok(study.select_point(&choice(ramp, shock))?.scene)
    };
    let has = |ramp: Ramp| study.ramps.contains(&ramp);
    let mut drawn = Vec::new();
    if let Some(&last) = study.ramps.last() {
        drawn.push(plan_drawing(&scene(last)?, program));
    }
    if has(Ramp::Rigid) {
        drawn.push(rigid_ramp_drawing(&scene(Ramp::Rigid)?, program));
    } else {
        console.note("no figure 2: the study has no rigid ramp");
    }
    if has(Ramp::Deformable) {
        drawn.push(deformable_ramp_drawing(&scene(Ramp::Deformable)?, program));
    } else {
        console.note("no figures 3 and 7: the study has no deformable ramp");
    }
    Ok(drawn)
}

fn choice(ramp: Ramp, shock: Shock) -> Choice {
    Choice {
        ramp: Some(ramp),
        pulse_ms: Some(shock.pulse_ms),
        sign: Some(Sign::Plus),
        amplitude_g: None,
    }
}
