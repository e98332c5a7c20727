//! Only what a scene calls for: leaving the rest out changes nothing.
//!
//! A pair runs one scene twice: as planned, and with everything built, marched from the onset and
//! nothing shared. Verdict, extremes, contacts, histories and costs of what both have must be the
//! same numbers. The one exception is the energy book of the structure: before the first touch one
//! sums amplitude² × unit energies, the other energies of amplitude × unit states, so that it must
//! agree to 1e-12 of the peak energy.

use opshock_solver::disk::DiskDamping;
use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::ramp::{ArmMode, RampModel};
use opshock_solver::scene::plan::{Mode, Needs, Output, Plan};
use opshock_solver::scene::{Scene, Window};
use opshock_solver::shock::PulseShape;
use opshock_solver::simulation::{Model, Outcome, Request, Warning, Workspace, simulate};
use opshock_tests::scenes;

fn run(scene: &Scene, plan: &Plan, amplitude_g: f64, donor: Option<&Model>) -> (Model, Outcome) {
    let model = Model::assemble(scene, plan, donor).expect("the scene builds");
    let request = Request {
        amplitude_m_per_s2: m_per_s2_from_g(amplitude_g),
        stop_at_failure: true,
        record: true,
    };
    let outcome = simulate(&model, &request, &mut Workspace::default());
    (model, outcome)
}

/// Everything `lean` has must be in `full`, number by number.
fn assert_same(lean: &Outcome, full: &Outcome, needs: Needs, what: &str) {
    assert_eq!(lean.disk, full.disk, "{what}");
    assert_eq!(lean.top, full.top, "{what}");
    assert_eq!(lean.bottom, full.bottom, "{what}");
    assert_eq!(lean.complementarity, full.complementarity, "{what}");
    // What warns of harmonics n >= 1 goes with them.
    let of_waves = ["harmonics_bounded", "physical_instability"];
    let left = |outcome: &Outcome| -> Vec<Warning> {
        let drops = |w: &&Warning| {
            !lean.effects.contains(&"disk.travelling_waves") && of_waves.contains(&w.code)
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
    let moved = |s: &opshock_solver::simulation::StructureColumns| {
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
        ]
    };
    assert!(moved(&a.structure) == moved(&b.structure), "{what}");
    let book = |o: &Outcome| {
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
    for (i, (x, y)) in book(lean).into_iter().zip(book(full)).enumerate() {
        assert!((x - y).abs() <= 1e-12 * peak, "{what}: energy {i} {x} {y}");
    }
    if needs >= Needs::Flight {
        assert_eq!(lean.steady, full.steady, "{what}");
    }
    if needs >= Needs::Head {
        assert_eq!(lean.verdict, full.verdict, "{what}");
        assert_eq!(lean.min_clearance_m, full.min_clearance_m, "{what}");
        assert_eq!(lean.t_min_clearance_s, full.t_min_clearance_s, "{what}");
        assert_eq!(lean.dimple, full.dimple, "{what}");
        assert_eq!(lean.cost, full.cost, "{what}");
        assert!(a.head == b.head, "{what}");
    } else {
        assert_eq!(lean.min_clearance_m, None, "{what}");
    }
}

fn coarse(mut scene: Scene) -> Scene {
    scene.window = Window::Fixed { length_s: 8e-4 };
    scene.disk_resolution.cut_hz = 12e3;
    scene.film_resolution.cells = 150;
    scene.head_resolution.tolerance = 0.1;
    scene
}

/// A point of every ramp model of every study that comes with opshock.
#[test]
fn effects_auto_is_full_for_the_studies() {
    for name in ["fig13", "paper-cases", "drive-2.5in"] {
        let study = scenes::study(name, &[]);
        let mut donor: Option<Model> = None;
        for ramp in &study.ramps {
            let of_ramp = |point: &&opshock_study::study::Point| point.ramp == *ramp;
            let point = study.points.iter().find(of_ramp).expect("a point");
            let scene = coarse(point.scene.clone());
            let amplitude_g = 150.0 * point.sign.factor();
            let asked = [Output::CriticalShock];
            let auto = Plan::new(&asked, Mode::Auto);
            let (model, lean) = run(&scene, &auto, amplitude_g, donor.as_ref());
            let full = Plan::new(&asked, Mode::Full);
            let (_, all) = run(&scene, &full, amplitude_g, donor.as_ref());
            assert_same(&lean, &all, Needs::Head, &format!("{name} {ramp}"));
            donor = Some(model);
        }
    }
}

/// Seeded numbers (splitmix64).
struct Seeded(u64);

impl Seeded {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn one_of<T: Clone>(&mut self, list: &[T]) -> T {
        list[(self.next() % list.len() as u64) as usize].clone()
    }
}

fn random_scene(base: &Scene, seeded: &mut Seeded) -> Scene {
    let mut scene = base.clone();
    scene.disk.thickness_m *= seeded.between(0.7, 1.3);
    scene.disk.spin_rad_per_s *= seeded.between(0.7, 1.5);
    if seeded.next().is_multiple_of(2) {
        scene.disk.damping = DiskDamping::ModalRatio(seeded.between(0.0, 0.02));
    }
    scene.disk.space_fixed_damping_per_s = seeded.one_of(&[0.0, 0.0, 20.0]);
    scene.disk_resolution.cut_hz = 8e3;
    scene.disk_resolution.static_correction = seeded.next().is_multiple_of(2);
    scene.structure_resolution.step_s = seeded.one_of(&[1e-6, 2e-6, 1.7e-6]);
    scene.pulse.shape = seeded.one_of(&[
        PulseShape::HalfSine,
        PulseShape::Haversine,
        PulseShape::Square,
    ]);
    scene.pulse.width_s = seeded.between(2e-4, 1e-3);
    scene.window = seeded.one_of(&[
        Window::Fixed { length_s: 1e-3 },
        Window::Fixed { length_s: 1.5e-3 },
        Window::UntilDecayed {
            share: 0.5,
            max_s: 1.5e-3,
        },
    ]);
    let mut arm = || {
        (0..1 + seeded.next() % 3)
            .map(|_| ArmMode {
                frequency_hz: seeded.between(500.0, 2e4),
                mass_kg: seeded.between(1e-5, 1e-4),
                participation: seeded.between(0.1, 1.0),
                damping_ratio: seeded.between(0.0, 0.05),
            })
            .collect::<Vec<_>>()
    };
    let (top, bottom) = (arm(), arm());
    scene.ramp.model = seeded.one_of(&[
        RampModel::None,
        RampModel::Rigid,
        RampModel::Deformable {
            top: top.clone(),
            bottom,
        },
        RampModel::Deformable {
            top: top.clone(),
            bottom: top,
        },
    ]);
    scene.ramp.clearance_top_m = seeded.one_of(&[0.0, 2e-5, 1e-4]);
    scene.ramp.clearance_bottom_m = seeded.one_of(&[2e-5, 1e-4]);
    scene.ramp.restitution = seeded.one_of(&[0.0, 0.0, 0.3, 0.9]);
    scene.slider.angle_rad = seeded.between(0.05, 6.0);
    scene
}

/// One random scene, random outputs, random shock. The head of a planned structure-only run is
/// simulated in one pair of `head_every`, because it is most of the cost.
fn random_pair(base: &Scene, seed: u64, head_every: u64) {
    let mut seeded = Seeded(seed);
    let scene = random_scene(base, &mut seeded);
    let with_head = seed.is_multiple_of(head_every);
    let allowed: Vec<Output> = Output::ALL
        .into_iter()
        .filter(|output| with_head || output.needs() == Needs::Structure)
        .collect();
    let asked: Vec<Output> = (0..1 + seeded.next() % 3)
        .map(|_| seeded.one_of(&allowed))
        .collect();
    let amplitude_g = seeded.between(5.0, 500.0) * seeded.one_of(&[1.0, -1.0]);
    let auto = Plan::new(&asked, Mode::Auto);
    let mut full = Plan::new(&asked, Mode::Full);
    if !with_head {
        full = full.without_head().expect("structural outputs");
    }
    let (lean_model, lean) = run(&scene, &auto, amplitude_g, None);
    let (full_model, all) = run(&scene, &full, amplitude_g, Some(&lean_model));
    let what = format!("seed {seed}, {amplitude_g} G, {asked:?}");
    assert_same(&lean, &all, auto.needs, &what);
    for positive in [true, false] {
        let threshold = |model: &Model| model.structure().touch_amplitude_m_per_s2(positive);
        let limit = threshold(&lean_model);
        assert_eq!(limit, threshold(&full_model), "{what}");
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

fn base() -> Scene {
    let mut scene = coarse(scenes::scene("fig13", "rigid", 0.5, &[]));
    scene.film_resolution.cells = 100;
    scene
}

#[test]
fn effects_auto_is_full_for_random_scenes() {
    let base = base();
    for seed in 0..100 {
        random_pair(&base, seed, 10);
    }
}

/// 2000 scenes, or `OPSHOCK_SEEDS=first..end` to go on where a run ended.
#[test]
#[ignore = "slow"]
fn effects_slow_auto_is_full_for_random_scenes() {
    let given = std::env::var("OPSHOCK_SEEDS").unwrap_or("1000..3000".to_owned());
    let (first, end) = given.split_once("..").expect("first..end");
    let number = |text: &str| text.parse::<u64>().expect("a seed");
    let base = base();
    for seed in number(first)..number(end) {
        random_pair(&base, seed, 4);
        if seed % 100 == 99 {
            println!("seeds below {} agree", seed + 1);
        }
    }
}

/// Film, suspension and head numbers of a structural plan are never read.
#[test]
fn effects_poisoned_head_never_reaches_the_structure() {
    let plan = Plan::new(&[Output::ContactForce], Mode::Auto);
    let scene = coarse(scenes::scene("fig13", "deformable", 0.5, &[]));
    let mut poisoned = scene.clone();
    poisoned.gas.pressure_pa = f64::NAN;
    poisoned.gas.viscosity_pa_s = f64::NAN;
    poisoned.gas.mean_free_path_m = f64::NAN;
    poisoned.suspension.gram_load_n = f64::NAN;
    poisoned.suspension.flexure.mass_kg = f64::NAN;
    poisoned.suspension.dimple.stiffness_n_per_m = f64::NAN;
    poisoned.slider.length_m = f64::NAN;
    poisoned.slider.width_m = f64::NAN;
    poisoned.slider.density_kg_per_m3 = f64::NAN;
    poisoned.fail_below_m = f64::NAN;
    poisoned.film_resolution.floor_m = f64::NAN;
    poisoned.head_resolution.tolerance = f64::NAN;
    let (_, clean) = run(&scene, &plan, 250.0, None);
    let (_, other) = run(&poisoned, &plan, 250.0, None);
    assert!(clean.top.first_touch_s.is_some());
    assert_eq!(clean, other);
}

/// A steady attitude reads neither the moving suspension nor the head's time steps.
#[test]
fn effects_poisoned_suspension_never_reaches_the_steady_flight() {
    let plan = Plan::new(&[Output::SteadyAttitude], Mode::Auto);
    let scene = coarse(scenes::scene("fig13", "none", 0.5, &[]));
    let mut poisoned = scene.clone();
    poisoned.suspension.flexure.mass_kg = f64::NAN;
    poisoned.suspension.dimple.stiffness_n_per_m = f64::NAN;
    poisoned.head_resolution.tolerance = f64::NAN;
    poisoned.fail_below_m = f64::NAN;
    let (_, clean) = run(&scene, &plan, 50.0, None);
    let (_, other) = run(&poisoned, &plan, 50.0, None);
    assert!(clean.steady.is_some());
    assert_eq!(clean, other);
}

/// R1 to R10, in order, with their findings.
#[test]
fn effects_every_rule_is_decided() {
    let scene = coarse(scenes::scene("fig13", "rigid", 0.5, &[]));
    let plan = Plan::new(&[Output::ContactForce], Mode::Auto);
    let model = Model::assemble(&scene, &plan, None).expect("builds");
    let limit = model
        .structure()
        .touch_amplitude_m_per_s2(true)
        .expect("a touch");
    let applied = |amplitude: f64| -> Vec<bool> {
        let decisions = model.decisions(Some(amplitude));
        let rules: Vec<&str> = decisions.iter().map(|d| d.rule).collect();
        let all = ["R1", "R2", "R3", "R4", "R5", "R6", "R7", "R8", "R9", "R10"];
        assert_eq!(rules, all);
        decisions.iter().map(|d| d.applied).collect()
    };
    let (t, f) = (true, false);
    assert_eq!(applied(0.999 * limit), [t, t, t, t, t, f, f, t, t, t]);
    assert_eq!(applied(1.001 * limit), [t, t, t, f, t, f, f, t, t, t]);
    let full = Plan::new(&[Output::ContactForce], Mode::Full);
    let touch = opshock_solver::scene::plan::Touch::default();
    let decisions = full.decisions(&scene, &touch);
    let on: Vec<&str> = decisions
        .iter()
        .filter(|d| d.applied)
        .map(|d| d.rule)
        .collect();
    assert_eq!(on, ["R6", "R10"]);
    assert_eq!(
        Plan::new(&[Output::Pitch], Mode::Auto).without_head(),
        Err(Output::Pitch)
    );
}

/// Every declared dependency carries its output: with the next smaller part of the drive it is
/// missing, and with the declared part it is there.
#[test]
fn effects_every_declared_dependency_is_needed() {
    let scene = coarse(scenes::scene("fig13", "none", 0.5, &[]));
    let answers = |needs: Needs| {
        let plan = Plan {
            needs,
            ..Plan::new(&[Output::CriticalShock], Mode::Auto)
        };
        run(&scene, &plan, 20.0, None).1
    };
    let found = |output: Output, outcome: &Outcome| {
        let head = outcome.history.as_ref().map(|history| &history.head);
        let recorded = |column: fn(&opshock_solver::simulation::HeadColumns) -> &Vec<f64>| {
            head.is_some_and(|head| !column(head).is_empty())
        };
        match output {
            Output::CriticalShock | Output::MinClearance => outcome.min_clearance_m.is_some(),
            Output::SliderAttitude => recorded(|head| &head.slider_z_m),
            Output::Pitch => recorded(|head| &head.slider_pitch_rad),
            Output::BearingForce => recorded(|head| &head.bearing_force_n),
            Output::DimpleForce => outcome.dimple.is_some(),
            Output::SteadyAttitude => outcome.steady.is_some(),
            Output::TouchThreshold
            | Output::DiskDisplacement
            | Output::RampDisplacement
            | Output::ContactForce => outcome.disk.slider_max_m > 0.0,
        }
    };
    let parts = [Needs::Structure, Needs::Flight, Needs::Head];
    let outcomes = parts.map(answers);
    for output in Output::ALL {
        for (part, outcome) in parts.iter().zip(&outcomes) {
            let enough = *part >= output.needs();
            assert_eq!(found(output, outcome), enough, "{output:?} {part:?}");
        }
    }
}

/// Without a ramp its clearances and its restitution are never read.
#[test]
fn effects_numbers_of_an_absent_ramp_change_nothing() {
    let plan = Plan::new(&[Output::DiskDisplacement], Mode::Auto);
    let scene = coarse(scenes::scene("fig13", "none", 0.5, &[]));
    let mut other = scene.clone();
    other.ramp.clearance_top_m = 0.0;
    other.ramp.clearance_bottom_m = 1e-9;
    other.ramp.restitution = 1.0;
    let (_, a) = run(&scene, &plan, 500.0, None);
    let (_, b) = run(&other, &plan, 500.0, None);
    assert_eq!(a, b);
}
