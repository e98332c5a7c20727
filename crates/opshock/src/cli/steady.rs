//! `opshock steady`: computes the slider's steady flight before the shock, or its film at a given attitude.

use super::console::Console;
use super::exit::Exit;
use super::failure::{Failure, Fault};
use super::global::GlobalArgs;
use super::selection::{PointArgs, unshaken_point};
use super::steady_state::{
    ImpedanceJson, LoadJson, LowerJson, Matrix, ModeJson, SteadyJson, as_text,
};
use super::{memory, study_file};
use anyhow::Context as _;
use clap::Args;
use opshock_solver::air_bearing::impedance::{AirBearingMode, SmallMotion};
use opshock_solver::air_bearing::steady::{
    Equilibrium, SteadyError, fixed_attitude, lower_equilibria,
};
use opshock_solver::air_bearing::{Attitude, Film, GapLoad};
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{Bearing, BuildError};
use opshock_solver::slider::body::Inertia;
use opshock_study::study::Study;
use opshock_study::study::memory::Demand;
use std::f64::consts::TAU;
use std::path::PathBuf;
use std::sync::Arc;

/// Print the flying attitude, or the forces at a given one; stiffness, damping, impedance
#[derive(Args, Debug)]
pub struct SteadyArgs {
    /// Study file
    study: PathBuf,
    #[command(flatten)]
    point: PointArgs,
    /// Hold the slider: height of the reference plane at the centre (nm), pitch (urad), roll (urad)
    #[arg(
        long,
        value_name = "NM,URAD,URAD",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    attitude: Option<Vec<f64>>,
    /// Stiffness and damping at these frequencies, Hz
    #[arg(long, value_name = "HZ,...", value_delimiter = ',')]
    impedance: Vec<f64>,
}

/// Runs the command.
pub fn run(
    arguments: &SteadyArgs,
    global: &GlobalArgs,
    console: &Console,
) -> Result<Exit, Failure> {
    let held = arguments.attitude.as_deref().map(attitude).transpose()?;
    check_frequencies(&arguments.impedance)?;
    let study = study_file::read(&arguments.study, global, console)?;
    let scene = unshaken_point(&study, &arguments.point)?.scene;
    let (film, state) = match held {
        Some(attitude) => {
            let film = film_to_hold(&study, &scene, console)?;
            let state = held_state(&film, &scene, attitude)?;
            (film, state)
        }
        None => {
            let bearing = bearing(&study, &scene)?;
            let state = flying_state(&bearing, &scene)?;
            (bearing.film, state)
        }
    };
    let steady = SteadyJson {
        impedance: impedance(&film, &state, &arguments.impedance)?,
        ..state.json
    };
    if console.json {
        console.result_json(&steady)?;
    } else {
        console.result(&as_text(&steady))?;
    }
    Ok(Exit::Complete)
}

/// Modes of the slider flying free on its film.
///
/// # Errors
///
/// No steady flight, or a mode that does not settle.
pub fn air_bearing_modes(study: &Study, scene: &Scene) -> Result<Vec<ModeJson>, Failure> {
    let bearing = bearing(study, scene)?;
    Ok(flying_state(&bearing, scene)?
        .json
        .modes
        .unwrap_or_default())
}

/// What `--json` prints of a scene's steady flight.
///
/// # Errors
///
/// The scene has none.
pub(super) fn json_of(study: &Study, scene: &Scene) -> Result<serde_json::Value, Failure> {
    let bearing = bearing(study, scene)?;
    let state = flying_state(&bearing, scene)?;
    Ok(serde_json::to_value(state.json).context("the flight cannot be written as JSON")?)
}

/// A state of the film and what is said about it.
struct State {
    psi: Vec<f64>,
    attitude: Attitude,
    json: SteadyJson,
}

/// The film and the flight of every simulation of `scene`.
fn bearing(study: &Study, scene: &Scene) -> Result<Bearing, Failure> {
    memory::check("the steady flight", Demand::impedance(scene), 1)?;
    let bearing = Bearing::build(scene, None);
    bearing.map_err(|error| study_file::cannot_be_simulated(study, &error))
}

/// The same film for a slider at a fixed attitude. For a slider that cannot fly, its defect is not corrected.
fn film_to_hold(study: &Study, scene: &Scene, console: &Console) -> Result<Arc<Film>, Failure> {
    memory::check("the steady flight", Demand::impedance(scene), 1)?;
    match Bearing::build(scene, None) {
        Ok(bearing) => Ok(bearing.film),
        Err(BuildError::Steady(error @ SteadyError::CannotFly { .. })) => {
            console.note(&format!("{error}; the film is taken as its grid has it"));
            let film = scene.film().map(Arc::new);
            film.map_err(|error| study_file::cannot_be_simulated(study, &error))
        }
        Err(error) => Err(study_file::cannot_be_simulated(study, &error)),
    }
}

fn flying_state(bearing: &Bearing, scene: &Scene) -> Result<State, Failure> {
    let load = [scene.suspension.gram_load_n, 0.0, 0.0];
    let (film, flight) = (&*bearing.film, &*bearing.flight);
    let lower = lower_equilibria(film, load, flight);
    let mut state = described(film, flight.psi.clone(), flight.attitude);
    state.json.stiffness = flight.stiffness;
    state.json.damping = flight.damping;
    state.json.lower = Some(lower.iter().map(lower_json).collect());
    let mut motion = SmallMotion::new(film, &state.psi, &state.attitude);
    let modes = motion.free_modes(Inertia::of(&scene.slider).diagonal());
    state.json.modes = Some(modes_json(
        &modes.context("no modes of the slider on its film")?,
    ));
    Ok(state)
}

fn held_state(film: &Film, scene: &Scene, attitude: Attitude) -> Result<State, Failure> {
    let clearance_m = film.min_clearance(&attitude).value_m;
    if clearance_m <= 0.0 {
        return Err(Failure::Usage(vec![Fault {
            key: Some("--attitude".into()),
            allowed: Some("an attitude that clears the disk".into()),
            ..Fault::new(
                "usage",
                format!(
                    "--attitude: the slider would reach {:.3} nm into the disk",
                    -1e9 * clearance_m
                ),
            )
        }]));
    }
    let held = fixed_attitude(film, &attitude).context("no steady film at this attitude")?;
    let mut state = described(film, held.psi, attitude);
    let mut motion = SmallMotion::new(film, &state.psi, &attitude);
    (state.json.stiffness, _) = at_frequency(&mut motion, 0.0)?;
    (_, state.json.damping) = at_frequency(&mut motion, QUASI_STATIC_HZ)?;
    // A slider held where it would not fly may have no oscillation at all.
    let modes = motion.free_modes(Inertia::of(&scene.slider).diagonal());
    state.json.modes = modes.ok().map(|modes| modes_json(&modes));
    Ok(state)
}

/// Frequency far below everything the film does, Hz.
const QUASI_STATIC_HZ: f64 = 1.0;

/// Everything that needs no linearisation.
fn described(film: &Film, psi: Vec<f64>, attitude: Attitude) -> State {
    let n = film.n_cells();
    let (mut forces, mut pressure) = (vec![0.0; n], vec![0.0; n]);
    film.cell_forces(&psi, &attitude, &mut forces, &mut film.scratch());
    film.pressure(&psi, &attitude, &mut pressure);
    let [force_n, pitch_moment_n_m, roll_moment_n_m] =
        film.force(&psi, &attitude, &mut film.scratch());
    let [air_n, air_pitch_n_m, air_roll_n_m] = film.air_force(&psi, &attitude, &mut film.scratch());
    let part = |load: GapLoad| LoadJson {
        force_n: load.force[0],
        pitch_moment_n_m: load.force[1],
        roll_moment_n_m: load.force[2],
        stiffness: load.by_attitude.map(|row| row.map(|slope| -slope)),
        drag_n: load.in_plane_n.map(|force| force[0]),
        outward_n: load.in_plane_n.map(|force| force[1]),
    };
    let [length_m, width_m] = film.extent_m();
    let json = SteadyJson {
        min_clearance_m: film.min_clearance(&attitude).value_m,
        centre_height_m: attitude.centre_height_m,
        pitch_rad: attitude.pitch_rad,
        roll_rad: attitude.roll_rad,
        lift_n: forces.iter().filter(|force| **force > 0.0).sum(),
        suction_n: forces.iter().filter(|force| **force < 0.0).sum(),
        force_n,
        pitch_moment_n_m,
        roll_moment_n_m,
        centre_of_pressure: [
            0.5 * length_m - air_pitch_n_m / air_n,
            0.5 * width_m + air_roll_n_m / air_n,
        ],
        p_max_pa: pressure.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        p_min_pa: pressure.iter().copied().fold(f64::INFINITY, f64::min),
        stiffness: [[0.0; 3]; 3],
        damping: [[0.0; 3]; 3],
        modes: None,
        unknowns: n,
        lower: None,
        correction: film.correction(&attitude).map(part),
        gap_forces: film
            .gap_loads(&psi, &attitude, &mut film.scratch())
            .into_iter()
            .map(|(name, load)| (name, part(load)))
            .collect(),
        impedance: None,
    };
    State {
        psi,
        attitude,
        json,
    }
}

fn impedance(
    film: &Film,
    state: &State,
    frequencies_hz: &[f64],
) -> Result<Option<Vec<ImpedanceJson>>, Failure> {
    if frequencies_hz.is_empty() {
        return Ok(None);
    }
    let mut motion = SmallMotion::new(film, &state.psi, &state.attitude);
    let rows: Result<Vec<ImpedanceJson>, Failure> = frequencies_hz
        .iter()
        .map(|&frequency_hz| {
            let (stiffness, damping) = at_frequency(&mut motion, frequency_hz)?;
            Ok(ImpedanceJson {
                frequency_hz,
                stiffness,
                damping,
            })
        })
        .collect();
    rows.map(Some)
}

/// Re Z and Im Z / omega; the second is zero at frequency zero.
fn at_frequency(
    motion: &mut SmallMotion<'_>,
    frequency_hz: f64,
) -> Result<(Matrix, Matrix), Failure> {
    let z = motion
        .impedance(frequency_hz)
        .with_context(|| format!("no impedance at {frequency_hz} Hz"))?;
    let omega = TAU * frequency_hz;
    let part = |of: &dyn Fn(usize, usize) -> f64| {
        std::array::from_fn(|row| std::array::from_fn(|column| of(row, column)))
    };
    let damping = |row: usize, column: usize| {
        if omega > 0.0 {
            z[(row, column)].im / omega
        } else {
            0.0
        }
    };
    Ok((part(&|row, column| z[(row, column)].re), part(&damping)))
}

fn modes_json(modes: &[AirBearingMode]) -> Vec<ModeJson> {
    modes
        .iter()
        .map(|mode| ModeJson {
            frequency_hz: mode.frequency_hz,
            damping_ratio: mode.damping_ratio,
            shape: mode.shape,
        })
        .collect()
}

fn lower_json(below: &Equilibrium) -> LowerJson {
    LowerJson {
        min_clearance_m: below.min_clearance_m,
        centre_height_m: below.attitude.centre_height_m,
        pitch_rad: below.attitude.pitch_rad,
        roll_rad: below.attitude.roll_rad,
        stable: below.stable,
    }
}

fn attitude(numbers: &[f64]) -> Result<Attitude, Failure> {
    match numbers {
        [height_nm, pitch_urad, roll_urad] if numbers.iter().all(|number| number.is_finite()) => {
            Ok(Attitude {
                centre_height_m: 1e-9 * height_nm,
                pitch_rad: 1e-6 * pitch_urad,
                roll_rad: 1e-6 * roll_urad,
            })
        }
        _ => Err(Failure::Usage(vec![Fault {
            key: Some("--attitude".into()),
            allowed: Some("three numbers: centre height (nm), pitch (urad), roll (urad)".into()),
            ..Fault::new(
                "usage",
                format!("--attitude takes three numbers, found {}", numbers.len()),
            )
        }])),
    }
}

fn check_frequencies(frequencies_hz: &[f64]) -> Result<(), Failure> {
    match frequencies_hz
        .iter()
        .find(|hz| !hz.is_finite() || **hz < 0.0)
    {
        None => Ok(()),
        Some(hz) => Err(Failure::Usage(vec![Fault {
            key: Some("--impedance".into()),
            value: Some(hz.to_string()),
            allowed: Some("frequencies >= 0".into()),
            ..Fault::new("usage", format!("--impedance {hz}: no frequency"))
        }])),
    }
}
