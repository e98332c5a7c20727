//! `opshock plan`: estimates what a sweep is going to cost, and prints a job script for Slurm.

use super::console::Console;
use super::exit::Exit;
use super::failure::Failure;
use super::global::GlobalArgs;
use super::{matching, memory, slurm, stored, study_file};
use anyhow::Context as _;
use clap::Args;
use opshock_study::matching::is_match_file;
use opshock_study::study::Study;
use opshock_study::study::difference::SettingDifference;
use opshock_study::study::memory::Demand;
use opshock_study::sweep::added_points::refined;
use opshock_study::sweep::forecast::{Forecast, forecast, workers};
use opshock_study::sweep::spread::Spread;
use opshock_study::sweep::{Physics, SweepInput};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Estimate what a sweep is going to cost: simulations, core-hours, time, disk
#[derive(Args, Debug)]
pub struct PlanArgs {
    /// Study file, or match file
    study: PathBuf,
    /// Print a job-array script for Slurm instead, one task per shard with -j threads each
    #[arg(long)]
    slurm: bool,
    /// Tasks of the job array [default: as many as points, at most 16]
    #[arg(long, value_name = "N", requires = "slurm", value_parser = clap::value_parser!(u16).range(1..))]
    shards: Option<u16>,
}

/// Runs the command.
pub fn run(arguments: &PlanArgs, global: &GlobalArgs, console: &Console) -> Result<Exit, Failure> {
    if !arguments.slurm && is_match_file(&arguments.study) {
        return matching::plan(&arguments.study, global, console);
    }
    let study = study_file::read(&arguments.study, global, console)?;
    study_file::refuse_unaccepted(&study, &global.accept)?;
    let folder = stored::folder_of_study(&arguments.study, global);
    let loaded = stored::finished(&folder)?;
    let owner = loaded.owner.clone();
    let no_range = "the study has no amplitudes to search";
    let study = refined(&study, &loaded).context(no_range)?;
    let added = study.points.iter().filter(|point| point.round > 0).count();
    let to_add = study.search.added_points.map_or(0, |added_points| {
        added_points.max_points.saturating_sub(added)
    });
    let input = SweepInput::of(&study).context(no_range)?;
    if let Some(owner) = &owner {
        owner.admit(&folder, &input.texts)?;
    }
    let threads = if arguments.slurm {
        global.jobs.map_or(1, usize::from)
    } else {
        global.threads()
    };
    memory::check("the forecast", Demand::models(&study), workers(threads))?;
    let nodes = history_nodes(&study);
    let mut forecast = forecast(&input, &Physics::of(&study), loaded, threads, nodes);
    forecast.may_add(to_add as u64);
    if arguments.slurm {
        let shards = arguments
            .shards
            .map_or_else(|| input.points.len().clamp(1, 16), usize::from);
        let job = slurm::Job {
            name: &study.name,
            study: &arguments.study,
            store: &folder,
            shards,
            threads,
            hours: forecast.core_h.max / (shards * threads) as f64,
        };
        console.result(&slurm::script(&job, global).context("cannot write the script")?)?;
    } else {
        let plan = Plan {
            changed: owner
                .and_then(|owner| owner.changed(&input.texts.resolved))
                .unwrap_or_default(),
            forecast,
            is_decisive: input.decides.is_some(),
        };
        if console.json {
            console.result_json(&plan)?;
        } else {
            console.result(&as_text(&study.name, &plan))?;
        }
    }
    Ok(Exit::Complete)
}

/// The forecast, and why simulations in the store no longer serve.
#[derive(Serialize)]
struct Plan {
    #[serde(flatten)]
    forecast: Forecast,
    changed: Vec<SettingDifference>,
    /// Intervals are made for decisive points alone.
    #[serde(skip)]
    is_decisive: bool,
}

/// Time steps of a history of the longest point.
fn history_nodes(study: &Study) -> f64 {
    let nodes = |point: &opshock_study::study::Point| {
        let scene = &point.scene;
        let window_s = match scene.window {
            opshock_solver::scene::Window::Fixed { length_s } => length_s,
            opshock_solver::scene::Window::UntilDecayed { max_s, .. } => max_s,
        };
        window_s / scene.structure_resolution.step_s
    };
    study.points.iter().map(nodes).fold(0.0, f64::max)
}

fn as_text(name: &str, plan: &Plan) -> String {
    let forecast = &plan.forecast;
    let mut text = String::new();
    let mut line = |what: &str, value: String| {
        // Writing into a text cannot fail.
        let _ = writeln!(text, "{what:<14}{value}");
    };
    line("study", name.to_owned());
    line(
        "points",
        format!(
            "{}, {} of them answered",
            forecast.points, forecast.answered
        ),
    );
    if forecast.added_points > 0 {
        line(
            "added points",
            format!(
                "{} at most, in every number below that is a maximum",
                forecast.added_points
            ),
        );
    }
    line(
        "reuse",
        format!("{} finished simulations stay valid", forecast.reused_runs),
    );
    for setting in &plan.changed {
        line("  changed", setting.to_string());
    }
    let runs = |spread: Spread| {
        format!(
            "{:.0} to {:.0}, likely {:.0}",
            spread.min, spread.max, spread.likely
        )
    };
    line("simulations", runs(forecast.runs));
    line("  search", runs(forecast.search_runs));
    line("  uncertainty", runs(forecast.uncertainty_runs));
    if plan.is_decisive {
        let left_out = "of decisive points alone, as simulated answers choose them; the brackets to be found may choose others";
        line("", left_out.to_owned());
    }
    let paces: Vec<String> = forecast
        .seconds_per_run
        .iter()
        .map(|(ramp, seconds)| format!("{ramp} {seconds:.2} s"))
        .collect();
    line("each", paces.join(", "));
    let hours = |spread: Spread| {
        format!(
            "{} to {}, likely {}",
            time(spread.min),
            time(spread.max),
            time(spread.likely)
        )
    };
    line("core time", hours(forecast.core_h));
    line(
        "time",
        format!(
            "{}, with {} threads",
            hours(forecast.wall_h),
            forecast.threads
        ),
    );
    if let Some(unrefined) = forecast.unrefined_wall_h {
        let time = hours(unrefined);
        line("  unrefined", format!("{time}, with --max-refinements 0"));
    }
    line(
        "disk",
        format!("{:.1} MB at most", forecast.disk_bytes as f64 * 1e-6),
    );
    text
}

/// Hours in words.
fn time(hours: f64) -> String {
    let seconds = hours * 3600.0;
    match seconds {
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        _ => format!("{hours:.1} h"),
    }
}
