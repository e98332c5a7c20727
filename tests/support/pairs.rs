//! One scene twice: as reduced model, and as full model, marched from the onset to the end of the
//! window with nothing shared. Verdict, extremes, contacts, histories and costs of what both have must
//! be the same numbers. There are two exceptions. Before the first touch of disk and ramp one energy balance
//! sums amplitude² × unit energies, the other energies of amplitude × unit states, so that they must
//! agree to 1e-13 of the peak energy. And after a touch of the slider only the full model goes on:
//! its histories and fields must begin with those of the reduced model and end with the window, and
//! its head's cost can only be larger.

use opshock_solver::air_bearing::SurfaceForces;
use opshock_solver::air_bearing::steady::SteadyError;
use opshock_solver::disk::{DiskDamping, HubParameters, Wave};
use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::ramp::{ArmMode, Arms, NoRamp, RampBody, RigidRamp};
use opshock_solver::scene::plan::{Mode, Needs, Output, Plan};
use opshock_solver::scene::{Scene, Window};
use opshock_solver::shock::{BaseMode, ObliqueShock, PulseShape};
use opshock_solver::simulation::{
    Bearing, BuildError, Cost, HeadColumns, History, Model, Outcome, Request, StructureColumns,
    Verdict, Warning, Workspace, simulate,
};
use opshock_solver::suspension::{ContactLaw, LiftTab, Limiter};
use opshock_study::search::{self, ProbeResult};

use crate::scenes;
use crate::seeded::Seeded;

/// Times at which a pair that is asked for pressure fields keeps them, s.
const FIELD_TIMES_S: [f64; 4] = [-1e-4, 0.0, 1.37e-4, 6e-4];

/// Code of the warning that a full run's head did not come to the end of the window.
const BROKE_OFF: &str = "broke_off_behind_touch";

/// Builds `scene` by `plan` and runs one shock, recording.
///
/// # Panics
/// When the scene does not build.
pub fn run(
    scene: &Scene,
    plan: &Plan,
    amplitude_g: f64,
    shared_model: Option<&Model>,
) -> (Model, Outcome) {
    let model = Model::assemble(scene, plan, shared_model).expect("the scene builds");
    let request = Request {
        amplitude_m_per_s2: m_per_s2_from_g(amplitude_g),
        record: true,
    };
    let outcome = simulate(&model, &request, &mut Workspace::default());
    (model, outcome)
}

/// Whether `outcome` answers `output`.
pub fn is_answered(output: Output, outcome: &Outcome) -> bool {
    let head = outcome.history.as_ref().map(|history| &history.head);
    let recorded =
        |column: fn(&HeadColumns) -> &Vec<f64>| head.is_some_and(|head| !column(head).is_empty());
    match output {
        Output::CriticalShock | Output::MinClearance => outcome.min_clearance_m.is_some(),
        // A drive without asperities has no contact to tell of.
        Output::SliderContact => match &outcome.slider_contact {
            Some(contact) => contact.energy.is_some(),
            None => outcome.min_clearance_m.is_some(),
        },
        Output::SliderAttitude => recorded(|head| &head.slider_z_m),
        Output::Pitch => recorded(|head| &head.slider_pitch_rad),
        Output::BearingForce => recorded(|head| &head.bearing_force_n),
        Output::DimpleForce => outcome.dimple.is_some(),
        Output::SteadyAttitude => outcome.steady.is_some(),
        Output::PressureField => {
            let history = outcome.history.as_ref();
            history.is_some_and(|h| h.fields.as_ref().is_some_and(|f| !f.time_s.is_empty()))
        }
        Output::TouchThreshold
        | Output::DiskDisplacement
        | Output::RampDisplacement
        | Output::ContactForce => outcome.disk.slider_max_m != outcome.disk.slider_min_m,
    }
}

/// Everything `lean`, the outcome of `plan`, has must be in `full`, number by number.
///
/// # Panics
/// When it is not.
pub fn assert_same(lean: &Outcome, full: &Outcome, plan: &Plan, what: &str) {
    let needs = plan.needs;
    assert_eq!(lean.disk, full.disk, "{what}");
    assert_eq!(lean.top, full.top, "{what}");
    assert_eq!(lean.bottom, full.bottom, "{what}");
    assert_eq!(lean.complementarity, full.complementarity, "{what}");
    // What warns of harmonics n >= 1 goes with them.
    let of_waves = ["harmonics_bounded", "physical_instability"];
    let left = |outcome: &Outcome| -> Vec<Warning> {
        let drops = |w: &&Warning| {
            !lean.effects.contains(&"disk.travelling_waves") && of_waves.contains(&w.code)
                || w.code == BROKE_OFF
        };
        let kept = outcome.warnings.iter().filter(|w| !drops(w));
        kept.cloned().collect()
    };
    assert_eq!(lean.warnings, left(full), "{what}");
    assert_eq!(
        lean.cost.structure_steps, full.cost.structure_steps,
        "{what}"
    );
    let (a, b) = (&lean.history, &full.history);
    let (a, b) = (a.as_ref().expect(what), b.as_ref().expect(what));
    let moved = |s: &StructureColumns| {
        [
            s.time_s.clone(),
            s.disk_slider_m.clone(),
            s.disk_ramp_m.clone(),
            s.disk_rim_m.clone(),
            s.disk_pitch_rad.clone(),
            s.disk_roll_rad.clone(),
            s.ramp_top_m.clone(),
            s.ramp_bottom_m.clone(),
            s.contact_top_n.clone(),
            s.contact_bottom_n.clone(),
            s.hub_axial_m.clone(),
            s.hub_tilt_ramp_rad.clone(),
            s.hub_tilt_across_rad.clone(),
        ]
    };
    assert!(moved(&a.structure) == moved(&b.structure), "{what}");
    let balance = |o: &Outcome| {
        let e = &o.energy;
        [
            e.kinetic_j,
            e.elastic_j,
            e.h_end_j,
            e.h_peak_j,
            e.shock_work_j,
            e.damping_loss_j,
            e.impact_loss_j,
            e.algorithmic_j,
            e.spindle_work_j,
        ]
    };
    let peak = full.energy.h_peak_j;
    for (i, (x, y)) in balance(lean).into_iter().zip(balance(full)).enumerate() {
        assert!((x - y).abs() <= 1e-13 * peak, "{what}: energy {i} {x} {y}");
    }
    if needs >= Needs::Flight {
        assert_eq!(lean.steady, full.steady, "{what}");
    }
    if needs >= Needs::Head {
        assert_eq!(lean.verdict, full.verdict, "{what}");
        assert_eq!(lean.min_clearance_m, full.min_clearance_m, "{what}");
        assert_eq!(lean.t_min_clearance_s, full.t_min_clearance_s, "{what}");
        assert_eq!(lean.dimple, full.dimple, "{what}");
        assert_eq!(lean.limiters, full.limiters, "{what}");
        assert_eq!(lean.lift_tab, full.lift_tab, "{what}");
        match lean.verdict {
            Some(Verdict::Fails { t_fail_s, .. }) if plan.stops_at_failure => {
                assert_goes_on(lean, full, t_fail_s, what);
            }
            _ => {
                if !plan.stops_at_failure {
                    assert_eq!(lean.slider_contact, full.slider_contact, "{what}");
                }
                assert_eq!(lean.cost, full.cost, "{what}");
                assert!(a.head == b.head, "{what}");
                assert!(a.fields == b.fields, "{what}");
            }
        }
    } else {
        assert_eq!(lean.min_clearance_m, None, "{what}");
    }
}

/// What both recorded up to the touch is the same; the reduced model ends there, the full one with the
/// window.
fn assert_goes_on(lean: &Outcome, full: &Outcome, t_fail_s: f64, what: &str) {
    let history = |outcome: &Outcome| -> History { outcome.history.clone().expect(what) };
    let (mut a, mut b) = (history(lean), history(full));
    assert_eq!(a.head.time_s.last(), Some(&t_fail_s), "{what}");
    let (end_s, window_s) = (b.head.time_s.last(), b.structure.time_s.last());
    match full.warnings.iter().find(|w| w.code == BROKE_OFF) {
        None => assert_eq!(end_s, window_s, "{what}"),
        Some(warning) => {
            println!("{what}: {}", warning.message);
            assert!(end_s > Some(&t_fail_s) && end_s < window_s, "{what}");
        }
    }
    for (a, b) in columns(&mut a.head).into_iter().zip(columns(&mut b.head)) {
        assert!(b.starts_with(a), "{what}");
    }
    if let (Some(a), Some(b)) = (&a.fields, &mut b.fields) {
        let n = b.time_s.partition_point(|&t| t <= t_fail_s);
        let n_cells = b.n_cells();
        b.time_s.truncate(n);
        b.pressure_pa.truncate(n * n_cells);
        b.gap_m.truncate(n * n_cells);
        assert!(a == b, "{what}");
    }
    let counted = |cost: &Cost| [cost.steps, cost.film_solves, cost.factorisations];
    let (less, more) = (counted(&lean.cost), counted(&full.cost));
    assert!(
        less.iter().zip(&more).all(|(a, b)| a <= b),
        "{what}: {less:?} {more:?}"
    );
    assert_eq!(lean.cost.film_unknowns, full.cost.film_unknowns, "{what}");
}

/// Answers of a search's probes with the reduced and the full model: the same but for the work of heads that
/// fail, which go on in the full model.
///
/// # Panics
/// When they are not.
pub fn assert_same_answers(planned: &[ProbeResult], full: &[ProbeResult]) {
    assert_eq!(planned.len(), full.len());
    for (planned, full) in planned.iter().zip(full) {
        let mut full = full.clone();
        if let search::Verdict::Fails { .. } = planned.verdict {
            assert!(full.cost.steps > planned.cost.steps);
            assert_eq!(full.cost.structure_steps, planned.cost.structure_steps);
            full.cost = planned.cost;
        }
        assert_eq!(*planned, full);
    }
}

/// The scene on coarse grids, 0.8 ms of it.
pub fn coarse(mut scene: Scene) -> Scene {
    scene.window = Window::Fixed { length_s: 8e-4 };
    scene.disk_resolution.cut_hz = 12e3;
    scene.film_resolution.cells = 150;
    scene.head_resolution.tolerance = 0.1;
    scene
}

/// The scene that random ones come from.
pub fn base() -> Scene {
    let mut scene = coarse(scenes::scene("fig13-stiffness", "rigid", 0.5, &[]));
    scene.film_resolution.cells = 100;
    scene
}

/// The same between rough surfaces.
pub fn rough_base() -> Scene {
    let mut scene = base();
    scene.gap_forces.asperity_contact.roughness_m = 0.5e-9;
    scene
}

/// A scene like `base` with another disk, pulse, window, ramp and slider's place.
pub fn random_scene(base: &Scene, seeded: &mut Seeded) -> Scene {
    let mut scene = base.clone();
    scene.disk.thickness_m *= seeded.between(0.7, 1.3);
    scene.disk.spin_rad_per_s *= seeded.between(0.7, 1.5);
    if seeded.once_in(2) {
        scene.disk.damping = DiskDamping::ModalRatio(seeded.between(0.0, 0.02));
    }
    scene.disk.space_fixed_damping_per_s = *seeded.one_of(&[0.0, 0.0, 20.0]);
    scene.disk_resolution.cut_hz = 8e3;
    scene.disk_resolution.static_correction = seeded.once_in(2);
    scene.structure_resolution.step_s = *seeded.one_of(&[1e-6, 2e-6, 1.7e-6]);
    let shapes = [
        PulseShape::HalfSine,
        PulseShape::Haversine,
        PulseShape::Square,
    ];
    scene.pulse.shape = seeded.one_of(&shapes).clone();
    scene.pulse.width_s = seeded.between(2e-4, 1e-3);
    scene.window = *seeded.one_of(&[
        Window::Fixed { length_s: 1e-3 },
        Window::Fixed { length_s: 1.5e-3 },
        Window::UntilDecayed {
            share: 0.5,
            max_s: 1.5e-3,
        },
    ]);
    let mut arm = || {
        (0..1 + seeded.below(3))
            .map(|_| ArmMode {
                frequency_hz: seeded.between(500.0, 2e4),
                mass_kg: seeded.between(1e-5, 1e-4),
                participation: seeded.between(0.1, 1.0),
                damping_ratio: seeded.between(0.0, 0.05),
            })
            .collect::<Vec<_>>()
    };
    let (top, bottom) = (arm(), arm());
    let models = [
        RampBody::from(NoRamp),
        RigidRamp.into(),
        Arms {
            top: top.clone(),
            bottom,
        }
        .into(),
        Arms {
            top: top.clone(),
            bottom: top,
        }
        .into(),
    ];
    scene.ramp.model = seeded.one_of(&models).clone();
    scene.ramp.clearance_top_m = *seeded.one_of(&[0.0, 2e-5, 1e-4]);
    scene.ramp.clearance_bottom_m = *seeded.one_of(&[2e-5, 1e-4]);
    scene.ramp.restitution = *seeded.one_of(&[0.0, 0.0, 0.3, 0.9]);
    // A contact with a stiffness has no restitution.
    if scene.ramp.restitution != 0.0 {
        scene.ramp.contact_stiffness_n_per_m = None;
    }
    scene.slider.angle_rad = seeded.between(0.05, 6.0);
    if seeded.once_in(4) {
        scene.disk.hub = Some(HubParameters {
            mass_kg: seeded.between(0.0, 2e-2),
            transverse_inertia_kg_m2: 4e-7,
            polar_inertia_kg_m2: seeded.between(0.0, 8e-7),
            axial_stiffness_n_per_m: seeded.between(1e6, 5e7),
            axial_damping_n_s_per_m: seeded.between(0.0, 100.0),
            tilt_stiffness_n_m_per_rad: seeded.between(50.0, 1000.0),
            tilt_damping_n_m_s_per_rad: seeded.between(0.0, 1e-2),
            cross_stiffness_n_m_per_rad: 0.0,
            cross_damping_n_m_s_per_rad: 0.0,
            centre_height_m: 1e-3,
        });
        if seeded.once_in(2) {
            let mut share = |most: f64| seeded.between(-most, most);
            scene.oblique = Some(ObliqueShock {
                in_plane: [share(1.0), share(1.0)],
                rotation_per_m: [share(10.0), share(10.0)],
            });
        }
    }
    if scene.disk.hub.is_none() && seeded.once_in(3) {
        let mut shape = || seeded.between(-1.0, 1.0);
        let shapes = [shape(), shape(), shape(), shape()];
        scene.base = vec![BaseMode {
            frequency_hz: seeded.between(300.0, 5e3),
            damping_ratio: seeded.between(0.0, 0.05),
            participation_sqrt_kg: 0.3 * shapes[0],
            spindle_per_sqrt_kg: shapes[1],
            ramp_per_sqrt_kg: shapes[2],
            pivot_per_sqrt_kg: shapes[3],
        }];
    }
    let contact = ContactLaw {
        stiffness_n_per_m: 1e5,
        damping_ratio: 0.05,
    };
    if seeded.once_in(4) {
        let mut limiter = |across_m: f64| Limiter {
            gap_m: *seeded.one_of(&[0.0, 1e-6, 1e-5]),
            along_m: 2e-4,
            across_m,
            contact,
        };
        scene.suspension.limiters = vec![limiter(-3e-4), limiter(3e-4)];
        let gap_m = seeded.between(0.0, 2e-5);
        scene.suspension.lift_tab = Some(LiftTab { gap_m, contact });
    }
    if seeded.once_in(4) {
        scene.run_out = vec![Wave {
            harmonic: *seeded.one_of(&[1, 7, 15]),
            amplitude_m: seeded.between(0.0, 1e-8),
            phase_rad: seeded.between(0.0, 6.0),
            grows_with_radius: seeded.once_in(2),
        }];
    }
    if seeded.once_in(4) {
        let surface_forces = SurfaceForces {
            hamaker_j: seeded.between(0.0, 2e-19),
            repulsion_j_m6: 1e-76,
            potential_v: seeded.between(0.0, 0.5),
        };
        // A study with both is refused.
        if scene.gap_forces.asperity_contact.roughness_m == 0.0 {
            scene.gap_forces.surface_forces = surface_forces;
        }
    }
    scene
}

/// How a random pair is made.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pair {
    /// Outputs may need the head, and the head runs.
    pub with_head: bool,
    /// Asked for instead of random outputs.
    pub output: Option<Output>,
    /// Condition deleted in the reduced model.
    pub mutant: Option<&'static str>,
}

/// One random scene, random outputs, random shock.
///
/// # Panics
/// When both runs differ, an asked output is missing, or the amplitude of first touch is not the
/// border that the contact march itself finds.
pub fn random_pair(base: &Scene, seed: u64, pair: Pair) {
    let mut seeded = Seeded::new(seed);
    let mut scene = random_scene(base, &mut seeded);
    let pulled_in = |error| matches!(error, BuildError::Steady(SteadyError::PulledIn { .. }));
    if pair.with_head && Bearing::build(&scene, None).is_err_and(pulled_in) {
        scene.gap_forces.surface_forces = SurfaceForces::default();
    }
    let allowed: Vec<Output> = Output::ALL
        .into_iter()
        .filter(|output| pair.with_head || output.needs() == Needs::Structure)
        .collect();
    let asked: Vec<Output> = (0..1 + seeded.below(3))
        .map(|_| *seeded.one_of(&allowed))
        .collect();
    let asked = pair.output.map_or(asked, |output| vec![output]);
    let amplitude_g = seeded.between(5.0, 500.0) * *seeded.one_of(&[1.0, -1.0]);
    let what = format!("seed {seed}, {amplitude_g} G, {asked:?}");
    compare(&scene, &asked, amplitude_g, None, pair, &what);
}

/// One scene as reduced model, with `shared_model`, against the full model.
///
/// # Panics
/// As [`random_pair`].
pub fn compare(
    scene: &Scene,
    asked: &[Output],
    amplitude_g: f64,
    shared_model: Option<&Model>,
    pair: Pair,
    what: &str,
) {
    let mut full = Plan::new(asked, Mode::Full).with_field_times(&FIELD_TIMES_S);
    if !pair.with_head {
        full = full.without_head().expect("structural outputs");
    }
    let (full_model, all) = run(scene, &full, amplitude_g, None);
    let planned = || {
        let plan = Plan::new(asked, Mode::Auto).with_field_times(&FIELD_TIMES_S);
        let (model, lean) = run(scene, &plan, amplitude_g, shared_model);
        let limits = [true, false].map(|plus| model.structure().touch_amplitude_m_per_s2(plus));
        (plan, lean, limits)
    };
    let (auto, lean, limits) = match pair.mutant {
        Some(name) => deleted(name, planned),
        None => planned(),
    };
    assert_same(&lean, &all, &auto, what);
    for output in asked {
        assert!(is_answered(*output, &lean), "{what}: {output:?}");
    }
    for (positive, limit) in [true, false].into_iter().zip(limits) {
        let structure = full_model.structure();
        assert_eq!(
            limit,
            structure.touch_amplitude_m_per_s2(positive),
            "{what}"
        );
        // The threshold must be the border that the contact march itself finds.
        if positive == (amplitude_g > 0.0)
            && let (Some(limit), Window::Fixed { .. }) = (limit, scene.window)
        {
            let touched = all.top.first_touch_s.or(all.bottom.first_touch_s).is_some();
            let amplitude = m_per_s2_from_g(amplitude_g.abs());
            if (amplitude / limit - 1.0).abs() > 1e-9 {
                assert_eq!(touched, amplitude > limit, "{what}");
            }
        }
    }
}

fn columns(head: &mut HeadColumns) -> [&mut Vec<f64>; 12] {
    [
        &mut head.time_s,
        &mut head.slider_z_m,
        &mut head.slider_pitch_rad,
        &mut head.slider_roll_rad,
        &mut head.min_clearance_m,
        &mut head.bearing_force_n,
        &mut head.bearing_pitch_n_m,
        &mut head.bearing_roll_n_m,
        &mut head.dimple_force_n,
        &mut head.limiter_force_n,
        &mut head.lift_tab_force_n,
        &mut head.asperity_force_n,
    ]
}

/// What `run` gives with the condition `name` deleted.
#[cfg(feature = "mutants")]
fn deleted<T>(name: &'static str, run: impl FnOnce() -> T) -> T {
    opshock_solver::mutant::with(name, run)
}

#[cfg(not(feature = "mutants"))]
fn deleted<T>(name: &'static str, _run: impl FnOnce() -> T) -> T {
    panic!("{name} is deleted in the build of make verify-effects alone")
}
