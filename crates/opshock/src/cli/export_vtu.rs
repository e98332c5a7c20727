//! `opshock export STUDY --format vtu`: writes one shock as time series for ParaView.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::run::simulated;
use super::selection::ShockArgs;
use super::study_file;
use opshock_solver::scene::{Scene, Window};
use opshock_solver::simulation::{History, StructureColumns};
use opshock_solver::structure::disk_displacements;
use opshock_study::report::vtk_files::{DiskSeries, FilmSeries, RampSeries, VtkSeries, write_vtk};
use opshock_study::study::{SetArg, Shot, Study};
use std::f64::consts::TAU;
use std::path::Path;

/// Circles and angles of the drawn disk: its modes below 30 kHz bend over no less than some
/// 10 mm.
const CIRCLES: usize = 13;
const ANGLES: usize = 48;

/// Runs the command.
pub(super) fn run(
    path: &Path,
    shock: &ShockArgs,
    out: &Path,
    frames: usize,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let given = study_file::read(path, global, console)?;
    let shot = given.select(&shock.choice())?;
    let times_s = frame_times(&shot.point.scene, frames)?;
    let study = with_fields(&given, &times_s, global)?;
    let shot = study.select(&shock.choice())?;
    let outcome = simulated(&study, &shot, true)?;
    let history = outcome
        .history
        .ok_or_else(|| anyhow::anyhow!("the run kept no history: {:?}", outcome.verdict))?;
    let scene = &shot.point.scene;
    let series = VtkSeries {
        disk: disk(&study, &shot, &times_s)?,
        ramp: ramp(scene, &history.structure, &times_s, study.start_s),
        film: film(&history, study.start_s),
    };
    let shown = series.film.as_ref().map_or(0, |film| film.time_s.len());
    if shown < times_s.len() {
        console.note(&format!(
            "{shown} of {} film fields: the head's run ends at its failure",
            times_s.len()
        ));
    }
    let written = write_vtk(out, &series)?;
    let collections: Vec<String> = written
        .iter()
        .filter(|path| path.extension().is_some_and(|ending| ending == "pvd"))
        .map(|path| path.display().to_string())
        .collect();
    console.note(&format!(
        "wrote {} files into {}",
        written.len(),
        out.display()
    ));
    if console.json {
        console.result_json(&serde_json::json!({ "series": collections }))?;
    } else {
        console.result(&(collections.join("\n") + "\n"))?;
    }
    Ok(Exit::Complete)
}

/// Times after the onset, s, of frames spread over a fixed window.
fn frame_times(scene: &Scene, frames: usize) -> Result<Vec<f64>, Failure> {
    let Window::Fixed { length_s } = scene.window else {
        return Err(Failure::Usage(vec![Fault {
            key: Some("pulse.window_ms".into()),
            allowed: Some("a length, as --set pulse.window_ms=5".into()),
            ..Fault::new("usage", "frames need a window of fixed length")
        }]));
    };
    Ok((0..frames)
        .map(|k| length_s * k as f64 / (frames - 1) as f64)
        .collect())
}

/// The study asking for histories of everything and for the film at the frames.
fn with_fields(study: &Study, times_s: &[f64], global: &GlobalArgs) -> Result<Study, Failure> {
    let mut sets = study_file::sets(global)?;
    sets.retain(|set| set.key != "outputs" && set.key != "fields.times_ms");
    // The last frame must not fall behind the window's end by the rounding of milliseconds.
    let end_s = times_s.last().map_or(0.0, |end| end * (1.0 - 1e-9));
    let times: Vec<String> = times_s
        .iter()
        .map(|t| format!("{:?}", 1e3 * (t.min(end_s) + study.start_s)))
        .collect();
    for text in [
        "outputs=[\"min_clearance\", \"slider_attitude\", \"disk_displacement\", \
         \"ramp_displacement\", \"contact_force\", \"pressure_field\"]"
            .to_owned(),
        format!("fields.times_ms=[{}]", times.join(", ")),
    ] {
        sets.push(SetArg::parse(&text)?);
    }
    Ok(Study::from_path(&study.path, &sets)?)
}

/// Linear interpolation of a column at a time after the onset.
fn at(columns: &StructureColumns, values: &[f64], time_s: f64) -> f64 {
    let after = columns.time_s.partition_point(|&t| t < time_s);
    let last = columns.time_s.len() - 1;
    let (before, after) = (after.saturating_sub(1), after.min(last));
    let (a, b) = (columns.time_s[before], columns.time_s[after]);
    if b > a {
        let share = ((time_s - a) / (b - a)).clamp(0.0, 1.0);
        values[before] + share * (values[after] - values[before])
    } else {
        values[after]
    }
}

/// The disk on a polar grid.
fn disk(study: &Study, shot: &Shot, times_s: &[f64]) -> Result<DiskSeries, Failure> {
    let scene = &shot.point.scene;
    let (inner, outer) = (scene.disk.inner_radius_m, scene.disk.outer_radius_m);
    let radii_m: Vec<f64> = (0..CIRCLES)
        .map(|k| inner + (outer - inner) * k as f64 / (CIRCLES - 1) as f64)
        .map(|radius_m| radius_m.min(outer))
        .collect();
    let angles_rad: Vec<f64> = (0..ANGLES)
        .map(|k| TAU * k as f64 / ANGLES as f64)
        .collect();
    let (structure, places) = (scene.structure(), [&*radii_m, &*angles_rad]);
    let deflection_m = disk_displacements(&structure, shot.amplitude_m_per_s2, times_s, places)
        .map_err(|error| study_file::cannot_be_simulated(study, &error))?;
    Ok(DiskSeries {
        time_s: times_s.iter().map(|t| t + study.start_s).collect(),
        radii_m,
        angles_rad,
        deflection_m,
    })
}

fn ramp(
    scene: &Scene,
    columns: &StructureColumns,
    times_s: &[f64],
    start_s: f64,
) -> Option<RampSeries> {
    if scene.ramp.model.is_absent() {
        return None;
    }
    let half = 0.5 * scene.disk.thickness_m;
    let pairs = |top: &[f64], bottom: &[f64]| -> Vec<[f64; 2]> {
        let pair = |&t: &f64| [at(columns, top, t), at(columns, bottom, t)];
        times_s.iter().map(pair).collect()
    };
    Some(RampSeries {
        radius_m: scene.ramp.radius_m,
        angle_rad: scene.ramp.angle_rad,
        rest_m: [
            half + scene.ramp.clearance_top_m,
            -half - scene.ramp.clearance_bottom_m,
        ],
        time_s: times_s.iter().map(|t| t + start_s).collect(),
        displacement_m: pairs(&columns.ramp_top_m, &columns.ramp_bottom_m),
        force_n: pairs(&columns.contact_top_n, &columns.contact_bottom_n),
    })
}

fn film(history: &History, start_s: f64) -> Option<FilmSeries> {
    let fields = history.fields.as_ref()?;
    let cells = fields.n_cells().max(1);
    let frames = |values: &[f64]| values.chunks(cells).map(<[f64]>::to_vec).collect();
    Some(FilmSeries {
        x_lines_m: fields.x_lines_m.clone(),
        y_lines_m: fields.y_lines_m.clone(),
        time_s: fields.time_s.iter().map(|t| t + start_s).collect(),
        pressure_pa: frames(&fields.pressure_pa),
        gap_m: frames(&fields.gap_m),
    })
}
