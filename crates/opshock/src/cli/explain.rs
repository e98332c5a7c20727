//! `opshock explain`: prints which effects are simulated for each scene of a study, and which rule leaves out the others.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::selection::ShockArgs;
use super::thresholds::coordinates;
use super::{memory, stored, study_file};
use anyhow::Context as _;
use clap::Args;
use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::scene::plan::{Decision, Effect, Mode, Needs, Plan, State, Touch};
use opshock_solver::simulation::{Bearing, Model, Request, Workspace, simulate};
use opshock_study::report::savings;
use opshock_study::study::memory::Demand;
use opshock_study::study::{Faces, Point, Study};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Instant;

/// Print which effects are simulated for each scene: on, off or inactive, and by which rule
#[derive(Args, Debug)]
pub struct ExplainArgs {
    /// Study file
    study: PathBuf,
    #[command(flatten)]
    shock: ShockArgs,
    /// Run the shock with the reduced and the full model, and print the cost saved
    #[arg(long, requires = "amplitude_g")]
    measure: bool,
}

/// One scene explained.
struct Explained {
    point: Point,
    effects: Vec<Effect>,
    rules: Vec<Decision>,
    /// Disk modes driven by the shock and modes of both arms, marched at any time; all modes.
    modes: [usize; 2],
    film_cells: Option<usize>,
    measured: Option<Measured>,
}

/// Wall times of one shock, s; building included.
struct Measured {
    reduced_s: f64,
    full_s: f64,
}

/// Runs the command.
pub fn run(
    arguments: &ExplainArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let study = study_file::read(&arguments.study, global, console)?;
    let amplitude_g = arguments.shock.choice().amplitude_g;
    if let Some(amplitude) = amplitude_g.filter(|a| !(a.is_finite() && *a >= 0.0)) {
        return Err(Failure::Usage(vec![Fault {
            key: Some("--amplitude-g".into()),
            value: Some(amplitude.to_string()),
            allowed: Some("a finite number >= 0".into()),
            ..Fault::new("usage", "--amplitude-g is out of range")
        }]));
    }
    let plan = study.plan();
    let mut cells: Option<(Scene, usize)> = None;
    let mut all = Vec::new();
    let points = chosen(&study, arguments)?;
    let runs = points
        .iter()
        .map(|point| Demand::run(&point.scene, &plan, false));
    memory::check("a point", runs.fold(Demand::default(), Demand::max), 1)?;
    for point in points {
        let film_cells = film_cells(&plan, &point.scene, &mut cells)?;
        all.push(explain(
            &study,
            &plan,
            point,
            amplitude_g,
            film_cells,
            arguments.measure,
        )?);
    }
    // What a sweep of this study saved, once it has been made.
    let source = stored::source(&arguments.study, global)?;
    let swept = stored::read(&source, console).ok();
    let saved = swept.map_or(Vec::new(), |stored| stored.savings);
    if console.json {
        let mut explained = as_json(&study, &plan, amplitude_g, &all);
        explained["saved_in_sweep"] = json!(saved);
        console.result_json(&explained)?;
    } else {
        let mut text = as_text(&study, &plan, amplitude_g, &all);
        if !saved.is_empty() {
            let _ = writeln!(text, "\nsaved in the sweep in {}", source.folder.display());
        }
        for line in savings::lines(&saved) {
            let _ = writeln!(text, "  {line}");
        }
        console.result(&text)?;
    }
    Ok(Exit::Complete)
}

/// The study's points that the options leave; what the options name beyond them.
fn chosen(study: &Study, arguments: &ExplainArgs) -> Result<Vec<Point>, Failure> {
    let choice = arguments.shock.choice();
    let fits = |point: &Point| {
        choice.ramp.is_none_or(|ramp| ramp == point.ramp)
            && choice.pulse_ms.is_none_or(|width| width == point.pulse_ms)
            && choice.sign.is_none_or(|sign| sign == point.sign)
    };
    let points: Vec<Point> = study
        .table_order()
        .into_iter()
        .map(|place| &study.points[place])
        .filter(|point| fits(point))
        .cloned()
        .collect();
    if points.is_empty() {
        return Ok(vec![study.select_point(&choice)?]);
    }
    Ok(points)
}

/// Unknowns of the film; scenes with the same film are counted once.
fn film_cells(
    plan: &Plan,
    scene: &Scene,
    last: &mut Option<(Scene, usize)>,
) -> Result<Option<usize>, Failure> {
    if plan.needs < Needs::Flight {
        return Ok(None);
    }
    if let Some((other, cells)) = last
        && Bearing::is_shared(scene, other)
    {
        return Ok(Some(*cells));
    }
    let film = scene.film().context("no film")?;
    let cells = film.n_cells();
    *last = Some((scene.clone(), cells));
    Ok(Some(cells))
}

fn explain(
    study: &Study,
    plan: &Plan,
    point: Point,
    amplitude_g: Option<f64>,
    film_cells: Option<usize>,
    measure: bool,
) -> Result<Explained, Failure> {
    let refused = |error| study_file::cannot_be_simulated(study, &error);
    let scene = &point.scene;
    let structural = Plan {
        needs: Needs::Structure,
        ..plan.clone()
    };
    let model = Model::assemble(scene, &structural, None).map_err(refused)?;
    let structure = model.structure();
    let n_modes = structure.n_modes();
    let n_modes = n_modes.map_err(|error| study_file::cannot_be_simulated(study, &error))?;
    let amplitude = amplitude_g.map(|g| point.factor() * m_per_s2_from_g(g));
    let touch = Touch {
        amplitude_m_per_s2: amplitude,
        threshold_m_per_s2: [true, false].map(|sign| structure.touch_amplitude_m_per_s2(sign)),
    };
    let timed = |plan: &Plan, amplitude_m_per_s2| -> Result<f64, Failure> {
        let started = Instant::now();
        let model = Model::assemble(scene, plan, None).map_err(refused)?;
        let request = Request {
            amplitude_m_per_s2,
            record: false,
        };
        simulate(&model, &request, &mut Workspace::default());
        Ok(started.elapsed().as_secs_f64())
    };
    let measured = match amplitude.filter(|_| measure) {
        Some(amplitude) => Some(Measured {
            reduced_s: timed(plan, amplitude)?,
            full_s: timed(&Plan::new(&plan.outputs, Mode::Full), amplitude)?,
        }),
        None => None,
    };
    let mut effects = plan.effects(scene, &touch);
    // The scene is the head's own: only the point knows which way up it is in the drive.
    effects.push(Effect {
        name: "head.faces_up",
        state: match point.faces {
            Faces::Down => State::Off,
            Faces::Up => State::On,
        },
        rule: None,
    });
    let is_gap_taken = point.gap_taken_m > 0.0;
    effects.push(Effect {
        name: "ramp.lowest_gap",
        state: if is_gap_taken { State::On } else { State::Off },
        rule: None,
    });
    Ok(Explained {
        effects,
        rules: plan.decisions(scene, &touch),
        modes: [structure.n_free_modes(), n_modes],
        film_cells,
        measured,
        point,
    })
}

fn rules_json(rules: &[Decision]) -> Vec<Value> {
    rules
        .iter()
        .map(|d| {
            json!({
                "rule": d.rule,
                "what": d.what,
                "applied": d.applied,
                "condition": d.condition,
                "value": d.value,
            })
        })
        .collect()
}

fn as_json(study: &Study, plan: &Plan, amplitude_g: Option<f64>, all: &[Explained]) -> Value {
    let scenes: Vec<Value> = all
        .iter()
        .map(|scene| {
            let effects: Vec<Value> = scene
                .effects
                .iter()
                .map(|e| json!({"effect": e.name, "state": e.state.as_str(), "rule": e.rule}))
                .collect();
            let mut row = coordinates(&scene.point);
            row.insert("effects".into(), json!(effects));
            row.insert(
                "unknowns".into(),
                json!({
                    "modes_before_touch": scene.modes[0],
                    "modes_after_touch": scene.modes[1],
                    "film_cells": scene.film_cells,
                }),
            );
            row.insert(
                "cost".into(),
                json!(scene.measured.as_ref().map(|m| json!({
                    "reduced_s": m.reduced_s,
                    "full_s": m.full_s,
                    "saved_share": 1.0 - m.reduced_s / m.full_s,
                }))),
            );
            row.insert("rules".into(), json!(rules_json(&scene.rules)));
            Value::Object(row)
        })
        .collect();
    json!({
        "study": study.name,
        "digest": study.digest_hex(),
        "mode": plan.mode.as_str(),
        "outputs": study.output_words(),
        "amplitude_g": amplitude_g,
        "rules": all.first().map(|first| rules_json(&first.rules)),
        "scenes": scenes,
    })
}

fn as_text(study: &Study, plan: &Plan, amplitude_g: Option<f64>, all: &[Explained]) -> String {
    let mut text = format!(
        "{}: outputs {}, effects {}{}\n\n",
        study.name,
        study.output_words().join(", "),
        plan.mode.as_str(),
        amplitude_g.map_or(String::new(), |g| format!(", {g} G")),
    );
    let Some(first) = all.first() else {
        return text;
    };
    let width = all.iter().map(|s| s.point.label().len()).max().unwrap_or(0);
    let _ = write!(text, "{:width$}", "scene");
    for effect in &first.effects {
        let _ = write!(text, "  {}", effect.name);
    }
    text.push_str("  modes  film cells\n");
    for scene in all {
        let _ = write!(text, "{:width$}", scene.point.label());
        for effect in &scene.effects {
            let state = match effect.rule {
                Some(rule) => format!("{} {rule}", effect.state.as_str()),
                None => effect.state.as_str().to_owned(),
            };
            let _ = write!(text, "  {state:<wide$}", wide = effect.name.len());
        }
        let cells = scene.film_cells.map_or("-".to_owned(), |n| n.to_string());
        let modes = format!("{}/{}", scene.modes[0], scene.modes[1]);
        let _ = writeln!(text, "  {modes:>5}  {cells:>10}");
        if let Some(m) = &scene.measured {
            let _ = writeln!(
                text,
                "{:width$}  measured {:.4} s (reduced model), {:.4} s (full model): {:.1} % saved",
                "",
                m.reduced_s,
                m.full_s,
                100.0 * (1.0 - m.reduced_s / m.full_s)
            );
        }
    }
    text.push_str("modes: moving before the first touch / after it\n");
    // Rules depend mostly on the ramp model; scenes with the same ramp model differ in numbers only.
    let mut listed = Vec::new();
    for scene in all {
        if listed.contains(&scene.point.ramp) {
            continue;
        }
        listed.push(scene.point.ramp);
        let _ = writeln!(text, "\nrules for {}", scene.point.label());
        for d in &scene.rules {
            let applied = if d.applied { "yes" } else { "no" };
            let _ = writeln!(text, "  {:<3}  {applied:<3}  {}", d.rule, d.what);
            let _ = writeln!(text, "            if: {}; found: {}", d.condition, d.value);
        }
    }
    text
}
