//! Builds the scene of one point, all data of a simulation in SI, from the settings of the study.

use opshock_solver::disk::{DiskDamping, Wave};
use opshock_solver::gas::{self, GasParameters};
use opshock_solver::ramp::{
    ArmMode, Arms, CoupledMode, NoRamp, OneBody, RampBody, RampParameters, Relaxation, RigidRamp,
    Viscoelastic,
};
use opshock_solver::scene::preset::{self, Preset, Resolutions, SKEWED_CORRECTION_CELLS};
use opshock_solver::scene::{Scene, Window};
use opshock_solver::shock::{BaseMode, ObliqueShock, Pulse, PulseShape};
use opshock_solver::slider::{Rail, RailOutline};
use opshock_solver::suspension::{
    ContactLaw, LiftTab, Limiter, RayleighDamping, SuspensionParameters,
};

use super::field::{Field, Pair};
use super::fields::{self, PLACES};
use super::settings::View;
use super::unit;
use super::words::{Criterion, Faces, RailKind, RunOut, Shape};
use super::{imported_suspension, measured_pulse, ramp_geometry};
use crate::search::Ramp;

/// Builds the scene of one point as its head sees it, and the way this faces. `width_ms` is its pulse width.
pub fn build(view: &View<'_>, ramp: Ramp, width_ms: f64) -> (Scene, Faces) {
    let scene = drive(view, ramp, width_ms);
    let faces = view.get(&fields::SLIDER_FACES).unwrap_or_default();
    match faces {
        Faces::Down => (scene, faces),
        Faces::Up => (scene.mirrored(), faces),
    }
}

/// Brings the values of keys below a path that go into a scene as they are to their places.
fn place(view: &View<'_>, below: &str, scene: &mut Scene) {
    let places = PLACES.iter().filter(|(path, _)| path.starts_with(below));
    places.for_each(|(_, place)| place(view, scene));
}

/// The scene with z along the drive's axis and a head over the disk.
fn drive(view: &View<'_>, ramp: Ramp, width_ms: f64) -> Scene {
    let mut scene = at_preset(view);
    place(view, "", &mut scene);
    scene.pulse = pulse(view, width_ms);
    scene.oblique = oblique(view);
    scene.base = base(view);
    scene.window = window(view);
    scene.disk.damping = disk_damping(view);
    scene.run_out = run_out(view);
    complete_ramp(view, ramp, &mut scene.ramp);
    scene.slider.surface.rails = (0..view.get(&fields::SLIDER_SURFACE_RAIL))
        .map(|position| rail(view, position))
        .collect();
    complete_suspension(view, &mut scene.suspension);
    scene.gas = gas_parameters(view);
    match view.get(&fields::FAILURE_CRITERION) {
        // No clearance decides: the slider touches where it always does.
        Some(Criterion::Damage) => scene.fail_below_m = 0.0,
        _ => scene.damage = None,
    }
    scene.not_refined = view.get(&fields::RESOLUTION_NOT_REFINED);
    scene
}

/// Coupling tolerance as a share of the head's, unless the study sets it.
const COUPLING_SHARE: f64 = 0.01;

/// Resolution preset of a point.
pub fn preset(view: &View<'_>) -> Preset {
    view.get(&fields::RESOLUTION_PRESET)
}

/// The preset's resolutions with what the study sets itself.
pub fn resolutions(view: &View<'_>) -> Resolutions {
    let mut scene = at_preset(view);
    place(view, "solver.", &mut scene);
    place(view, "resolution.", &mut scene);
    Resolutions {
        disk: scene.disk_resolution,
        structure: scene.structure_resolution,
        film: scene.film_resolution,
        head: scene.head_resolution,
    }
}

/// The default drive at the resolutions of the preset, and what follows from single ones that the study sets.
fn at_preset(view: &View<'_>) -> Scene {
    let mut scene = Scene::default_drive();
    let Resolutions {
        disk,
        structure,
        film,
        head,
    } = preset::resolutions(preset(view));
    scene.disk_resolution = disk;
    scene.structure_resolution = structure;
    scene.film_resolution = film;
    scene.head_resolution = head;
    let is_skewed = view.get(&fields::SLIDER_SKEW_DEG) != 0.0;
    let reference = &mut scene.film_resolution.correction_cells;
    match view.get(&fields::RESOLUTION_FILM_CELLS) {
        // A grid that the study sets is taken as it is.
        Some(_) => *reference = 0,
        None if is_skewed => *reference = SKEWED_CORRECTION_CELLS.max(*reference),
        None => {}
    }
    // The residual of the coupled solve must stay small beside the error of a step.
    if let Some(tolerance) = view.get(&fields::RESOLUTION_HEAD_TOLERANCE) {
        // The smallest tolerance of all has no hundredth but 0, which is none.
        scene.head_resolution.coupling_tolerance =
            (COUPLING_SHARE * tolerance).max(f64::MIN_POSITIVE);
    }
    scene
}

/// Scaled to a largest magnitude of 1, to a length of `width_s`.
fn table(view: &View<'_>, width_s: f64) -> PulseShape {
    let times = view.get(&fields::PULSE_TABLE_TIME_MS);
    let relative = view.get(&fields::PULSE_TABLE_RELATIVE);
    let last = times.last().copied().unwrap_or(1.0);
    let largest = relative
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    PulseShape::Table {
        time_s: times.iter().map(|time| width_s * (time / last)).collect(),
        relative: relative.iter().map(|value| value / largest).collect(),
    }
}

fn pulse(view: &View<'_>, width_ms: f64) -> Pulse {
    // The width of a measured pulse is the time above a share of its peak; the record is longer.
    let length_ms = measured_pulse::length_ms(view).unwrap_or(width_ms);
    let width_s = unit::si(fields::PULSE_WIDTHS_MS.path(), length_ms);
    let shape = match view.get(&fields::PULSE_SHAPE) {
        Shape::HalfSine => PulseShape::HalfSine,
        Shape::Haversine => PulseShape::Haversine,
        Shape::Square => PulseShape::Square,
        Shape::Trapezoid => PulseShape::Trapezoid {
            rise_share: view.get(&fields::PULSE_RISE_SHARE),
        },
        Shape::DampedSine => PulseShape::DampedSine {
            frequency_hz: view.get(&fields::PULSE_FREQUENCY_HZ),
            decay_per_s: view.get(&fields::PULSE_DECAY_PER_S),
        },
        Shape::Table => table(view, width_s),
    };
    Pulse { shape, width_s }
}

/// Shares of an oblique shock; `None` when all are 0.
fn oblique(view: &View<'_>) -> Option<ObliqueShock> {
    let share = |field: &Field<Option<f64>>| view.get(field).unwrap_or(0.0);
    let shock = ObliqueShock {
        in_plane: [&fields::PULSE_IN_PLANE_X, &fields::PULSE_IN_PLANE_Y].map(share),
        rotation_per_m: [
            &fields::PULSE_ROTATION_X_PER_M,
            &fields::PULSE_ROTATION_Y_PER_M,
        ]
        .map(share),
    };
    (shock != ObliqueShock::default()).then_some(shock)
}

/// Modes of base plate and housing.
fn base(view: &View<'_>) -> Vec<BaseMode> {
    let mode = |entry| BaseMode {
        frequency_hz: view.entry(entry, &fields::BASE_MODES_FREQUENCY_HZ),
        damping_ratio: view.entry(entry, &fields::BASE_MODES_DAMPING_RATIO),
        participation_sqrt_kg: view.entry(entry, &fields::BASE_MODES_PARTICIPATION_SQRT_KG),
        spindle_per_sqrt_kg: view.entry(entry, &fields::BASE_MODES_SPINDLE_PER_SQRT_KG),
        ramp_per_sqrt_kg: view.entry(entry, &fields::BASE_MODES_RAMP_PER_SQRT_KG),
        pivot_per_sqrt_kg: view.entry(entry, &fields::BASE_MODES_PIVOT_PER_SQRT_KG),
    };
    (0..view.get(&fields::BASE_MODES)).map(mode).collect()
}

/// Times at which pressure fields are asked for, after the onset, ascending.
pub fn field_times_s(view: &View<'_>) -> Vec<f64> {
    let start_s = view.get(&fields::PULSE_START_MS);
    let asked = view.get(&fields::FIELDS_TIMES_MS).iter();
    let mut times_s: Vec<f64> = asked
        .map(|&time| unit::si(fields::FIELDS_TIMES_MS.path(), time) - start_s)
        .collect();
    times_s.sort_by(f64::total_cmp);
    times_s
}

fn window(view: &View<'_>) -> Window {
    match view.get(&fields::PULSE_WINDOW_MS) {
        Some(length_s) => Window::Fixed { length_s },
        None => Window::UntilDecayed {
            share: view.get(&fields::PULSE_DECAY_SHARE),
            max_s: view.get(&fields::PULSE_WINDOW_MAX_MS),
        },
    }
}

fn disk_damping(view: &View<'_>) -> DiskDamping {
    match view.get(&fields::DISK_DAMPING_MODAL_RATIO) {
        Some(ratio) => DiskDamping::ModalRatio(ratio),
        None => DiskDamping::Rayleigh {
            alpha_per_s: view.get(&fields::DISK_DAMPING_RAYLEIGH_ALPHA_PER_S),
            beta_s: view.get(&fields::DISK_DAMPING_RAYLEIGH_BETA_S),
        },
    }
}

/// Run-out once a revolution, then the waves as listed; what has no amplitude is left out.
fn run_out(view: &View<'_>) -> Vec<Wave> {
    let once = Wave {
        harmonic: 1,
        amplitude_m: view.get(&fields::DISK_RUN_OUT_UM).unwrap_or(0.0),
        phase_rad: -view.get(&fields::DISK_RUN_OUT_DEG).unwrap_or(0.0),
        grows_with_radius: true,
    };
    let listed = (0..view.get(&fields::DISK_WAVES)).map(|entry| Wave {
        harmonic: view.entry(entry, &fields::DISK_WAVES_HARMONIC),
        amplitude_m: view.entry(entry, &fields::DISK_WAVES_AMPLITUDE_NM),
        phase_rad: view
            .entry(entry, &fields::DISK_WAVES_PHASE_DEG)
            .unwrap_or(0.0),
        grows_with_radius: false,
    });
    std::iter::once(once)
        .chain(listed)
        .filter(|wave| wave.amplitude_m > 0.0)
        .collect()
}

/// What the running-out disk takes of the ramp's gaps at its highest and lowest, m; 0 unless asked for.
pub fn gap_taken_m(view: &View<'_>) -> f64 {
    if view.get(&fields::RAMP_RUN_OUT) != Some(RunOut::LowestGap) {
        return 0.0;
    }
    let share = view.get(&fields::RAMP_RADIUS_MM) / view.get(&fields::DISK_OUTER_RADIUS_MM);
    let at_ramp = |wave: &Wave| match wave.grows_with_radius {
        true => share * wave.amplitude_m,
        false => wave.amplitude_m,
    };
    run_out(view).iter().map(at_ramp).sum()
}

/// Modes of both arms as one body, as listed.
fn coupled_modes(view: &View<'_>) -> Vec<CoupledMode> {
    let mode = |entry| CoupledMode {
        frequency_hz: view.entry(entry, &fields::RAMP_DEFORMABLE_COUPLED_MODES_FREQUENCY_HZ),
        shape_per_sqrt_kg: [
            view.entry(
                entry,
                &fields::RAMP_DEFORMABLE_COUPLED_MODES_TOP_PER_SQRT_KG,
            ),
            view.entry(
                entry,
                &fields::RAMP_DEFORMABLE_COUPLED_MODES_BOTTOM_PER_SQRT_KG,
            ),
        ],
        participation_sqrt_kg: view.entry(
            entry,
            &fields::RAMP_DEFORMABLE_COUPLED_MODES_PARTICIPATION_SQRT_KG,
        ),
        damping_ratio: view
            .entry(entry, &fields::RAMP_DEFORMABLE_COUPLED_MODES_DAMPING_RATIO)
            .unwrap_or_else(|| view.get(&fields::RAMP_DEFORMABLE_DAMPING_RATIO)),
    };
    let count = view.get(&fields::RAMP_DEFORMABLE_COUPLED_MODES);
    (0..count).map(mode).collect()
}

/// What relaxes of the ramp's modes; nothing without a series.
fn relax(view: &View<'_>, ramp: &mut RampBody) {
    let term = |entry| Relaxation {
        share: view.entry(entry, &fields::RAMP_DEFORMABLE_PRONY_SHARE),
        time_s: view.entry(entry, &fields::RAMP_DEFORMABLE_PRONY_TIME_MS),
    };
    let prony: Vec<Relaxation> = (0..view.get(&fields::RAMP_DEFORMABLE_PRONY))
        .map(term)
        .collect();
    if !prony.is_empty() && !ramp.modes().is_empty() {
        let elastic = ramp.clone();
        *ramp = Viscoelastic { elastic, prony }.into();
    }
}

/// Model and clearances of the ramp.
fn complete_ramp(view: &View<'_>, ramp: Ramp, parameters: &mut RampParameters) {
    let damping_ratio =
        |own: Option<f64>| own.unwrap_or_else(|| view.get(&fields::RAMP_DEFORMABLE_DAMPING_RATIO));
    let top = |entry| ArmMode {
        frequency_hz: view.entry(entry, &fields::RAMP_DEFORMABLE_MODES_FREQUENCY_HZ),
        mass_kg: view.entry(entry, &fields::RAMP_DEFORMABLE_MODES_MASS_MG),
        participation: view.entry(entry, &fields::RAMP_DEFORMABLE_MODES_PARTICIPATION),
        damping_ratio: damping_ratio(
            view.entry(entry, &fields::RAMP_DEFORMABLE_MODES_DAMPING_RATIO),
        ),
    };
    let bottom = |entry| ArmMode {
        frequency_hz: view.entry(entry, &fields::RAMP_DEFORMABLE_BOTTOM_MODES_FREQUENCY_HZ),
        mass_kg: view.entry(entry, &fields::RAMP_DEFORMABLE_BOTTOM_MODES_MASS_MG),
        participation: view.entry(entry, &fields::RAMP_DEFORMABLE_BOTTOM_MODES_PARTICIPATION),
        damping_ratio: damping_ratio(
            view.entry(entry, &fields::RAMP_DEFORMABLE_BOTTOM_MODES_DAMPING_RATIO),
        ),
    };
    parameters.model = match ramp {
        Ramp::None => NoRamp.into(),
        Ramp::Rigid => RigidRamp.into(),
        Ramp::Deformable if ramp_geometry::is_given(view) => OneBody {
            modes: ramp_geometry::coupled_modes(view),
        }
        .into(),
        Ramp::Deformable if view.get(&fields::RAMP_DEFORMABLE_COUPLED_MODES) > 0 => OneBody {
            modes: coupled_modes(view),
        }
        .into(),
        Ramp::Deformable => {
            let top: Vec<ArmMode> = (0..view.get(&fields::RAMP_DEFORMABLE_MODES))
                .map(top)
                .collect();
            let bottom = match view.get(&fields::RAMP_DEFORMABLE_BOTTOM_MODES) {
                0 => top.clone(),
                count => (0..count).map(bottom).collect(),
            };
            Arms { top, bottom }.into()
        }
    };
    relax(view, &mut parameters.model);
    let clearance_m = view.get(&fields::RAMP_CLEARANCE_UM);
    let taken_m = gap_taken_m(view);
    let own_m = |own: &Field<Option<f64>>| view.get(own).unwrap_or(clearance_m) - taken_m;
    parameters.clearance_top_m = own_m(&fields::RAMP_CLEARANCE_TOP_UM);
    parameters.clearance_bottom_m = own_m(&fields::RAMP_CLEARANCE_BOTTOM_UM);
    parameters.contact_stiffness_n_per_m = view.get(&fields::RAMP_CONTACT_STIFFNESS_N_PER_M);
}

fn rail(view: &View<'_>, entry: usize) -> Rail {
    let pair = |field: &Field<Pair>| {
        let ends = view.entry(entry, field);
        ends.map(|end| unit::si(field.path(), end))
    };
    let outline = match view.entry(entry, &fields::SLIDER_SURFACE_RAIL_KIND) {
        RailKind::Polygon => {
            let corners = &fields::SLIDER_SURFACE_RAIL_POINTS_UM;
            let mut points_m: Vec<[f64; 2]> = view
                .entry(entry, corners)
                .iter()
                .map(|corner| corner.map(|value| unit::si(corners.path(), value)))
                .collect();
            if points_m.len() > 1 && points_m.first() == points_m.last() {
                points_m.pop();
            }
            if super::polygon::signed_area(&points_m) < 0.0 {
                points_m.reverse();
            }
            RailOutline::Polygon { points_m }
        }
        RailKind::Rectangle => RailOutline::Rectangle {
            x_m: pair(&fields::SLIDER_SURFACE_RAIL_X_UM),
            y_m: pair(&fields::SLIDER_SURFACE_RAIL_Y_UM),
        },
    };
    Rail {
        outline,
        recess_m: view.entry(entry, &fields::SLIDER_SURFACE_RAIL_RECESS_UM),
    }
}

/// The suspension.
pub fn suspension(view: &View<'_>) -> SuspensionParameters {
    let mut scene = Scene::default_drive();
    place(view, "suspension.", &mut scene);
    complete_suspension(view, &mut scene.suspension);
    scene.suspension
}

/// Stops and imported modes of the suspension.
fn complete_suspension(view: &View<'_>, suspension: &mut SuspensionParameters) {
    // A stop without a value of its own takes the dimple's.
    let dimple = suspension.dimple;
    let contact = |stiffness: &Field<Option<f64>>, damping: &Field<Option<f64>>| ContactLaw {
        stiffness_n_per_m: view.get(stiffness).unwrap_or(dimple.stiffness_n_per_m),
        damping_ratio: view.get(damping).unwrap_or(dimple.damping_ratio),
    };
    suspension.limiters = limiters(
        view,
        contact(
            &fields::SUSPENSION_LIMITERS_STIFFNESS_N_PER_M,
            &fields::SUSPENSION_LIMITERS_DAMPING_RATIO,
        ),
    );
    let gap_m = view.get(&fields::SUSPENSION_LIFT_TAB_GAP_UM);
    suspension.lift_tab = gap_m.map(|gap_m| LiftTab {
        gap_m,
        contact: contact(
            &fields::SUSPENSION_LIFT_TAB_STIFFNESS_N_PER_M,
            &fields::SUSPENSION_LIFT_TAB_DAMPING_RATIO,
        ),
    });
    suspension.modes = imported_suspension::listed(view);
    let [alpha_per_s, beta_s] = [
        view.get(&fields::SUSPENSION_RAYLEIGH_ALPHA_PER_S),
        view.get(&fields::SUSPENSION_RAYLEIGH_BETA_S),
    ];
    let is_given = alpha_per_s.or(beta_s).is_some();
    suspension.rayleigh = is_given.then(|| RayleighDamping {
        alpha_per_s: alpha_per_s.unwrap_or(0.0),
        beta_s: beta_s.unwrap_or(0.0),
    });
}

/// The inner and the outer limiter, when a gap is given.
fn limiters(view: &View<'_>, contact: ContactLaw) -> Vec<Limiter> {
    let Some(gap_m) = view.get(&fields::SUSPENSION_LIMITERS_GAP_UM) else {
        return Vec::new();
    };
    let outer_m = view.get(&fields::SUSPENSION_LIMITERS_GAP_OUTER_UM);
    let along_m = view
        .get(&fields::SUSPENSION_LIMITERS_ALONG_MM)
        .unwrap_or(0.0);
    let across_m = view
        .get(&fields::SUSPENSION_LIMITERS_ACROSS_MM)
        .unwrap_or(0.0);
    let limiter = |gap_m, across_m| Limiter {
        gap_m,
        along_m,
        across_m,
        contact,
    };
    vec![
        limiter(gap_m, -across_m),
        limiter(outer_m.unwrap_or(gap_m), across_m),
    ]
}

/// Pressure from itself or the altitude; viscosity from itself or the temperature; mean free path
/// from itself or scaled from the reference state.
pub fn gas_parameters(view: &View<'_>) -> GasParameters {
    let pressure_pa = view
        .get(&fields::GAS_PRESSURE_PA)
        .or_else(|| {
            view.get(&fields::GAS_ALTITUDE_M)
                .map(gas::standard_pressure_pa)
        })
        .unwrap_or(gas::SEA_LEVEL_PRESSURE_PA);
    let temperature_k = view.get(&fields::GAS_TEMPERATURE_C);
    let viscosity_pa_s = view
        .get(&fields::GAS_VISCOSITY_PA_S)
        .or_else(|| temperature_k.map(gas::viscosity_pa_s))
        .unwrap_or(gas::REFERENCE_VISCOSITY_PA_S);
    let mean_free_path_m = view.get(&fields::GAS_MEAN_FREE_PATH_NM).unwrap_or_else(|| {
        let temperature_k = temperature_k.unwrap_or(gas::REFERENCE_TEMPERATURE_K);
        gas::mean_free_path_m(viscosity_pa_s, pressure_pa, temperature_k)
    });
    GasParameters {
        pressure_pa,
        viscosity_pa_s,
        mean_free_path_m,
    }
}
