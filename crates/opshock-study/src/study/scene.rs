//! One point's settings as a scene in SI.
//!
//! Every number passes [`View::si`] here and nowhere else.

use opshock_solver::air_bearing::FilmResolution;
use opshock_solver::air_bearing::gap_forces::{GapForces, SurfaceForces, ViscousShear};
use opshock_solver::disk::{DiskDamping, DiskParameters, DiskResolution, HubParameters, Wave};
use opshock_solver::gas::{self, GasParameters};
use opshock_solver::ramp::{
    ArmMode, CONTACT_DAMPING_RATIO, CONTACT_FREQUENCY_HZ, CoupledMode, RampModel, RampParameters,
};
use opshock_solver::scene::accuracy::{self, Resolutions, Rung, SKEWED_REFERENCE_CELLS};
use opshock_solver::scene::knob::Knob;
use opshock_solver::scene::{HeadResolution, Scene, Window};
use opshock_solver::shock::{BaseMode, ObliqueShock, Pulse, PulseShape};
use opshock_solver::slider::{Rail, RailOutline, SliderParameters, SurfaceParameters};
use opshock_solver::structure::StructureResolution;
use opshock_solver::suspension::{
    ContactLaw, Flange, Flexure, Gimbal, Hinge, LiftTab, Limiter, LoadBeam, SuspensionParameters,
};

use super::settings::{Datum, View};
use super::unit;
use super::words::{self, Faces, Ramp, Shape};
use super::{imported_suspension, ramp_geometry, ramp_mesh};

/// Key of the times of pressure fields.
pub const FIELD_TIMES: &str = "fields.times_ms";
/// Waves of the disk.
pub const WAVES: &str = "disk.waves";

/// Key of the way the head faces.
pub const FACES: &str = "slider.faces";

/// Builds the scene of one point as its head sees it, and the way this faces. `width_ms` is its pulse width.
pub fn build(view: &View<'_>, ramp: Ramp, width_ms: f64) -> (Scene, Faces) {
    let scene = drive(view, ramp, width_ms);
    let faces = view.chosen(FACES, &words::FACES).unwrap_or_default();
    match faces {
        Faces::Down => (scene, faces),
        Faces::Up => (scene.mirrored(), faces),
    }
}

/// The scene with z along the drive's axis and a head over the disk.
fn drive(view: &View<'_>, ramp: Ramp, width_ms: f64) -> Scene {
    let Resolutions {
        disk,
        structure,
        film,
        head,
    } = resolutions(view);
    Scene {
        pulse: pulse(view, width_ms),
        oblique: oblique(view),
        base: base(view),
        window: window(view),
        disk: disk_parameters(view),
        run_out: run_out(view),
        ramp: ramp_parameters(view, ramp),
        slider: slider(view),
        suspension: suspension(view),
        gas: gas_parameters(view),
        flow: given(view, "gas.model", &words::FLOWS),
        gap_forces: gap_forces(view),
        fail_below_m: view.si("solver.fail_below_nm"),
        disk_resolution: disk,
        structure_resolution: structure,
        film_resolution: film,
        head_resolution: head,
        not_refined: not_refined(view),
    }
}

/// Discretisation parameters that are values of the model.
fn not_refined(view: &View<'_>) -> Vec<Knob> {
    let words = view.words("solver.not_refined").iter();
    words.filter_map(|word| Knob::from_word(word)).collect()
}

/// Coupling tolerance as a share of the head's, unless the study sets it.
const COUPLING_SHARE: f64 = 0.01;

/// Accuracy asked for at a point.
pub fn rung(view: &View<'_>) -> Rung {
    given(view, "solver.accuracy", &words::RUNGS)
}

/// Value of a word that every study has, by its default if not by itself.
pub fn given<T: Copy>(view: &View<'_>, path: &str, list: &[(&str, T)]) -> T {
    let value = view.chosen(path, list);
    value.expect("the table of keys has a default for it")
}

/// The rung's resolutions with what the study sets itself.
pub fn resolutions(view: &View<'_>) -> Resolutions {
    let base = accuracy::resolutions(rung(view));
    // Limits of the table keep every count inside usize.
    let count = |path: &str, base: usize| {
        view.maybe_integer(path)
            .map_or(base, |value| value as usize)
    };
    let number = |path: &str, base: f64| view.maybe_si(path).unwrap_or(base);
    let is_skewed = view
        .maybe_si("slider.skew_deg")
        .is_some_and(|skew| skew != 0.0);
    // What the solve leaves must stay small beside the error of a step.
    let coupling_tolerance =
        view.maybe_si("solver.head_tolerance")
            .map_or(base.head.coupling_tolerance, |tolerance| {
                // The smallest tolerance of all has no hundredth but 0, which is none.
                (COUPLING_SHARE * tolerance).max(f64::MIN_POSITIVE)
            });
    Resolutions {
        disk: DiskResolution {
            n_harmonics: count("solver.disk_harmonics", base.disk.n_harmonics),
            cut_hz: number("solver.disk_cut_khz", base.disk.cut_hz),
            n_elements: count("solver.disk_elements", base.disk.n_elements),
            static_correction: view
                .maybe_flag("solver.static_correction")
                .unwrap_or(base.disk.static_correction),
        },
        structure: StructureResolution {
            step_s: number("solver.structure_step_us", base.structure.step_s),
            contact: base.structure.contact,
        },
        film: FilmResolution {
            cells: count("solver.film_cells", base.film.cells),
            floor_m: number("solver.film_floor_nm", base.film.floor_m),
            // A grid that the study sets is taken as it is.
            reference_cells: count(
                "solver.film_reference_cells",
                match view.maybe_integer("solver.film_cells") {
                    Some(_) => 0,
                    None if is_skewed => base.film.reference_cells.max(SKEWED_REFERENCE_CELLS),
                    None => base.film.reference_cells,
                },
            ),
        },
        head: HeadResolution {
            tolerance: number("solver.head_tolerance", base.head.tolerance),
            approach_share: number("solver.approach_share", base.head.approach_share),
            suspension_modes: count("solver.suspension_modes", base.head.suspension_modes),
            coupling: view
                .chosen("solver.coupling", &words::COUPLINGS)
                .unwrap_or(base.head.coupling),
            coupling_tolerance: number("solver.coupling_tolerance", coupling_tolerance),
            max_steps: view
                .maybe_integer("solver.max_steps")
                .map_or(base.head.max_steps, |value| value as u64),
        },
    }
}

/// Stretched to the width, scaled to a largest magnitude of 1.
fn table(view: &View<'_>, width_s: f64) -> PulseShape {
    let times = view.numbers("pulse.table_time_ms");
    let relative = view.numbers("pulse.table_relative");
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
    let width_s = unit::si("pulse.widths_ms", width_ms);
    let shape = match given(view, "pulse.shape", &words::SHAPES) {
        Shape::HalfSine => PulseShape::HalfSine,
        Shape::Haversine => PulseShape::Haversine,
        Shape::Square => PulseShape::Square,
        Shape::Trapezoid => PulseShape::Trapezoid {
            rise_share: view.si("pulse.rise_share"),
        },
        Shape::DampedSine => PulseShape::DampedSine {
            frequency_hz: view.si("pulse.frequency_hz"),
            decay_per_s: view.si("pulse.decay_per_s"),
        },
        Shape::Table => table(view, width_s),
    };
    Pulse { shape, width_s }
}

/// Shares of an oblique shock; `None` when all are 0.
fn oblique(view: &View<'_>) -> Option<ObliqueShock> {
    let share = |path: &str| view.maybe_si(path).unwrap_or(0.0);
    let shock = ObliqueShock {
        in_plane: [share("pulse.in_plane_x"), share("pulse.in_plane_y")],
        rotation_per_m: [
            share("pulse.rotation_x_per_m"),
            share("pulse.rotation_y_per_m"),
        ],
    };
    (shock != ObliqueShock::default()).then_some(shock)
}

/// Modes of base plate and housing.
fn base(view: &View<'_>) -> Vec<BaseMode> {
    view.tables("base.modes", |si| BaseMode {
        frequency_hz: si("frequency_hz"),
        damping_ratio: si("damping_ratio"),
        participation_sqrt_kg: si("participation_sqrt_kg"),
        spindle_per_sqrt_kg: si("spindle_per_sqrt_kg"),
        ramp_per_sqrt_kg: si("ramp_per_sqrt_kg"),
        pivot_per_sqrt_kg: si("pivot_per_sqrt_kg"),
    })
}

/// Times at which pressure fields are asked for, after the onset, ascending.
pub fn field_times_s(view: &View<'_>) -> Vec<f64> {
    let start_s = view.si("pulse.start_ms");
    let asked = view.numbers(FIELD_TIMES).iter();
    let mut times_s: Vec<f64> = asked
        .map(|&time| unit::si(FIELD_TIMES, time) - start_s)
        .collect();
    times_s.sort_by(f64::total_cmp);
    times_s
}

fn window(view: &View<'_>) -> Window {
    match view.maybe_si("pulse.window_ms") {
        Some(length_s) => Window::Fixed { length_s },
        None => Window::UntilDecayed {
            share: view.si("pulse.decay_share"),
            max_s: view.si("pulse.window_max_ms"),
        },
    }
}

fn disk_parameters(view: &View<'_>) -> DiskParameters {
    DiskParameters {
        inner_radius_m: view.si("disk.inner_radius_mm"),
        outer_radius_m: view.si("disk.outer_radius_mm"),
        thickness_m: view.si("disk.thickness_mm"),
        youngs_modulus_pa: view.si("disk.youngs_modulus_gpa"),
        poisson: view.si("disk.poisson"),
        density_kg_per_m3: view.si("disk.density_kg_per_m3"),
        spin_rad_per_s: view.si("disk.rpm"),
        damping: match view.maybe_si("disk.damping.modal_ratio") {
            Some(ratio) => DiskDamping::ModalRatio(ratio),
            None => DiskDamping::Rayleigh {
                alpha_per_s: view.si("disk.damping.rayleigh.alpha_per_s"),
                beta_s: view.si("disk.damping.rayleigh.beta_s"),
            },
        },
        space_fixed_damping_per_s: view.si("disk.space_fixed_damping_per_s"),
        hub: hub(view),
    }
}

/// Run-out once a revolution, then the waves as listed; what has no amplitude is left out.
fn run_out(view: &View<'_>) -> Vec<Wave> {
    let once = Wave {
        harmonic: 1,
        amplitude_m: view.maybe_si("disk.run_out_um").unwrap_or(0.0),
        phase_rad: -view.maybe_si("disk.run_out_deg").unwrap_or(0.0),
        grows_with_radius: true,
    };
    let listed = (0..view.entries(WAVES)).map(|position| {
        let member = |name: &str| format!("{WAVES}[{position}].{name}");
        let harmonic = view.maybe_integer(&member("harmonic")).unwrap_or(1);
        Wave {
            // The table of keys bounds it.
            harmonic: harmonic as u32,
            amplitude_m: view.si(&member("amplitude_nm")),
            phase_rad: view.maybe_si(&member("phase_deg")).unwrap_or(0.0),
            grows_with_radius: false,
        }
    });
    std::iter::once(once)
        .chain(listed)
        .filter(|wave| wave.amplitude_m > 0.0)
        .collect()
}

/// What the running-out disk takes of the ramp's gaps at its highest and lowest, m; 0 unless asked for.
pub fn gap_taken_m(view: &View<'_>) -> f64 {
    if view.chosen("ramp.run_out", &words::RUN_OUT) != Some(true) {
        return 0.0;
    }
    let share = view.si("ramp.radius_mm") / view.si("disk.outer_radius_mm");
    let at_ramp = |wave: &Wave| match wave.grows_with_radius {
        true => share * wave.amplitude_m,
        false => wave.amplitude_m,
    };
    run_out(view).iter().map(at_ramp).sum()
}

/// Modes of both arms as one body, as listed.
fn coupled_modes(view: &View<'_>) -> Vec<CoupledMode> {
    let list = ramp_mesh::MODES;
    let mode = |position: usize| {
        let member = |name: &str| format!("{list}[{position}].{name}");
        CoupledMode {
            frequency_hz: view.si(&member("frequency_hz")),
            shape_per_sqrt_kg: ["top_per_sqrt_kg", "bottom_per_sqrt_kg"]
                .map(|name| view.si(&member(name))),
            participation_sqrt_kg: view.si(&member("participation_sqrt_kg")),
            damping_ratio: view
                .maybe_si(&member("damping_ratio"))
                .unwrap_or_else(|| view.si("ramp.deformable.damping_ratio")),
        }
    };
    (0..view.entries(list)).map(mode).collect()
}

/// The hub, when its stiffnesses are given; what is left out of it is 0.
fn hub(view: &View<'_>) -> Option<HubParameters> {
    let maybe = |name: &str| view.maybe_si(&format!("hub.{name}"));
    let or_0 = |name: &str| maybe(name).unwrap_or(0.0);
    Some(HubParameters {
        axial_stiffness_n_per_m: maybe("axial_stiffness_n_per_m")?,
        tilt_stiffness_n_m_per_rad: maybe("tilt_stiffness_n_m_per_rad")?,
        mass_kg: or_0("mass_mg"),
        transverse_inertia_kg_m2: or_0("transverse_inertia_mg_mm2"),
        polar_inertia_kg_m2: or_0("polar_inertia_mg_mm2"),
        axial_damping_n_s_per_m: or_0("axial_damping_n_s_per_m"),
        tilt_damping_n_m_s_per_rad: or_0("tilt_damping_n_m_s_per_rad"),
        cross_stiffness_n_m_per_rad: or_0("cross_stiffness_n_m_per_rad"),
        cross_damping_n_m_s_per_rad: or_0("cross_damping_n_m_s_per_rad"),
        centre_height_m: or_0("centre_height_mm"),
    })
}

fn ramp_parameters(view: &View<'_>, ramp: Ramp) -> RampParameters {
    let arm = |list: &str| -> Vec<ArmMode> {
        (0..view.entries(list))
            .map(|position| {
                let member = |name: &str| format!("{list}[{position}].{name}");
                ArmMode {
                    frequency_hz: view.si(&member("frequency_hz")),
                    mass_kg: view.si(&member("mass_mg")),
                    participation: view.si(&member("participation")),
                    damping_ratio: view
                        .maybe_si(&member("damping_ratio"))
                        .unwrap_or_else(|| view.si("ramp.deformable.damping_ratio")),
                }
            })
            .collect()
    };
    let clearance_m = view.si("ramp.clearance_um");
    let taken_m = gap_taken_m(view);
    RampParameters {
        model: match ramp {
            Ramp::None => RampModel::None,
            Ramp::Rigid => RampModel::Rigid,
            Ramp::Deformable if ramp_geometry::is_given(view) => RampModel::Coupled {
                modes: ramp_geometry::coupled_modes(view),
            },
            Ramp::Deformable if view.entries(ramp_mesh::MODES) > 0 => RampModel::Coupled {
                modes: coupled_modes(view),
            },
            Ramp::Deformable => {
                let top = arm("ramp.deformable.modes");
                let bottom = match view.entries("ramp.deformable.bottom_modes") {
                    0 => top.clone(),
                    _ => arm("ramp.deformable.bottom_modes"),
                };
                RampModel::Deformable { top, bottom }
            }
        },
        clearance_top_m: view
            .maybe_si("ramp.clearance_top_um")
            .unwrap_or(clearance_m)
            - taken_m,
        clearance_bottom_m: view
            .maybe_si("ramp.clearance_bottom_um")
            .unwrap_or(clearance_m)
            - taken_m,
        radius_m: view.si("ramp.radius_mm"),
        angle_rad: view.si("ramp.angle_deg"),
        restitution: view.si("ramp.restitution"),
        contact_stiffness_n_per_m: view.maybe_si("ramp.contact_stiffness_n_per_m"),
        contact_frequency_hz: view
            .maybe_si("ramp.contact_frequency_khz")
            .unwrap_or(CONTACT_FREQUENCY_HZ),
        contact_damping_ratio: view
            .maybe_si("ramp.contact_damping_ratio")
            .unwrap_or(CONTACT_DAMPING_RATIO),
    }
}

fn slider(view: &View<'_>) -> SliderParameters {
    SliderParameters {
        radius_m: view.si("slider.radius_mm"),
        angle_rad: view.si("slider.angle_deg"),
        skew_rad: view.si("slider.skew_deg"),
        length_m: view.si("slider.length_mm"),
        width_m: view.si("slider.width_mm"),
        height_m: view.si("slider.height_mm"),
        density_kg_per_m3: view.si("slider.density_kg_per_m3"),
        surface: SurfaceParameters {
            base_recess_m: view.si("slider.surface.base_recess_um"),
            crown_m: view.si("slider.surface.crown_nm"),
            camber_m: view.si("slider.surface.camber_nm"),
            twist_m: view.si("slider.surface.twist_nm"),
            taper_length_m: view.si("slider.surface.taper_length_um"),
            taper_angle_rad: view.si("slider.surface.taper_angle_deg"),
            rails: (0..view.entries("slider.surface.rail"))
                .map(|position| rail(view, position))
                .collect(),
        },
    }
}

fn rail(view: &View<'_>, position: usize) -> Rail {
    let member = |name: &str| format!("slider.surface.rail[{position}].{name}");
    let pair = |name: &str| match view.get(&member(name)) {
        Some(Datum::Pair(ends)) => ends.map(|end| unit::si(name, end)),
        _ => [0.0; 2],
    };
    let is_polygon = view.chosen(&member("kind"), &words::RAIL_KINDS) == Some(true);
    let outline = match view.get(&member("points_um")) {
        Some(Datum::Points(points)) if is_polygon => {
            let mut points_m: Vec<[f64; 2]> = points
                .iter()
                .map(|corner| corner.map(|value| unit::si("points_um", value)))
                .collect();
            if points_m.len() > 1 && points_m.first() == points_m.last() {
                points_m.pop();
            }
            if super::polygon::signed_area(&points_m) < 0.0 {
                points_m.reverse();
            }
            RailOutline::Polygon { points_m }
        }
        _ => RailOutline::Rectangle {
            x_m: pair("x_um"),
            y_m: pair("y_um"),
        },
    };
    Rail {
        outline,
        recess_m: view.si(&member("recess_um")),
    }
}

/// The suspension.
pub fn suspension(view: &View<'_>) -> SuspensionParameters {
    let si = |name: &str| view.si(&format!("suspension.{name}"));
    SuspensionParameters {
        gram_load_n: si("gram_load_gf"),
        hinge: Hinge {
            length_m: si("hinge.length_mm"),
            width_m: si("hinge.width_mm"),
            thickness_m: si("hinge.thickness_um"),
        },
        load_beam: LoadBeam {
            dimple_m: si("load_beam.dimple_mm"),
            end_m: si("load_beam.end_mm"),
            web_m: si("load_beam.web_um"),
            width_root_m: si("load_beam.width_root_mm"),
            width_dimple_m: si("load_beam.width_dimple_mm"),
            tab_width_m: si("load_beam.tab_width_mm"),
        },
        flange: Flange {
            height_m: si("flange.height_um"),
            from_m: si("flange.from_mm"),
            to_m: si("flange.to_mm"),
        },
        flexure: Flexure {
            mass_kg: si("flexure.mass_mg"),
            from_m: si("flexure.from_mm"),
        },
        youngs_modulus_pa: si("material.youngs_modulus_gpa"),
        shear_modulus_pa: si("material.shear_modulus_gpa"),
        density_kg_per_m3: si("material.density_kg_per_m3"),
        damping_ratio: si("damping_ratio"),
        gimbal: Gimbal {
            vertical_n_per_m: si("gimbal.vertical_n_per_m"),
            pitch_n_m_per_rad: si("gimbal.pitch_n_m_per_rad"),
            roll_n_m_per_rad: si("gimbal.roll_n_m_per_rad"),
        },
        dimple: contact_law(view, "dimple"),
        limiters: limiters(view),
        lift_tab: view
            .maybe_si("suspension.lift_tab.gap_um")
            .map(|gap_m| LiftTab {
                gap_m,
                contact: contact_law(view, "lift_tab"),
            }),
        modes: imported_suspension::listed(view),
    }
}

/// The inner and the outer limiter, when a gap is given.
fn limiters(view: &View<'_>) -> Vec<Limiter> {
    let maybe = |name: &str| view.maybe_si(&format!("suspension.limiters.{name}"));
    let Some(gap_m) = maybe("gap_um") else {
        return Vec::new();
    };
    let across_m = maybe("across_mm").unwrap_or(0.0);
    let limiter = |gap_m: f64, across_m: f64| Limiter {
        gap_m,
        along_m: maybe("along_mm").unwrap_or(0.0),
        across_m,
        contact: contact_law(view, "limiters"),
    };
    vec![
        limiter(gap_m, -across_m),
        limiter(maybe("gap_outer_um").unwrap_or(gap_m), across_m),
    ]
}

/// Stiffness and damping of a contact of the suspension; the dimple's where they are left out.
fn contact_law(view: &View<'_>, contact: &str) -> ContactLaw {
    let of = |name: &str| {
        view.maybe_si(&format!("suspension.{contact}.{name}"))
            .unwrap_or_else(|| view.si(&format!("suspension.dimple.{name}")))
    };
    ContactLaw {
        stiffness_n_per_m: of("stiffness_n_per_m"),
        damping_ratio: of("damping_ratio"),
    }
}

/// Forces in the gap beside the air's pressure; none acts unless it is asked for.
fn gap_forces(view: &View<'_>) -> GapForces {
    let or_0 = |path: &str| view.maybe_si(path).unwrap_or(0.0);
    GapForces {
        surface_forces: SurfaceForces {
            hamaker_j: or_0("surface_forces.hamaker_j"),
            repulsion_j_m6: or_0("surface_forces.repulsion_j_m6"),
            potential_v: or_0("surface_forces.potential_v"),
        },
        viscous_shear: ViscousShear {
            is_on: view.maybe_flag("slider.viscous_shear") == Some(true),
        },
    }
}

/// Pressure from itself or the altitude; viscosity from itself or the temperature; mean free path
/// from itself or scaled from the reference state.
pub fn gas_parameters(view: &View<'_>) -> GasParameters {
    let pressure_pa = view
        .maybe_si("gas.pressure_pa")
        .or_else(|| {
            view.maybe_si("gas.altitude_m")
                .map(gas::standard_pressure_pa)
        })
        .unwrap_or(gas::SEA_LEVEL_PRESSURE_PA);
    let temperature_k = view.maybe_si("gas.temperature_c");
    let viscosity_pa_s = view
        .maybe_si("gas.viscosity_pa_s")
        .or_else(|| temperature_k.map(gas::viscosity_pa_s))
        .unwrap_or(gas::REFERENCE_VISCOSITY_PA_S);
    let mean_free_path_m = view.maybe_si("gas.mean_free_path_nm").unwrap_or_else(|| {
        let temperature_k = temperature_k.unwrap_or(gas::REFERENCE_TEMPERATURE_K);
        gas::mean_free_path_m(viscosity_pa_s, pressure_pa, temperature_k)
    });
    GasParameters {
        pressure_pa,
        viscosity_pa_s,
        mean_free_path_m,
    }
}
