//! Every dependency and every condition of a rule is needed: with it deleted, a pair differs.

use std::panic::{AssertUnwindSafe, catch_unwind};

use opshock_solver::air_bearing::FlowModel;
use opshock_solver::ramp::RigidRamp;
use opshock_solver::scene::plan::{Mode, Needs, Output, Plan};
use opshock_solver::scene::{Scene, Window};
use opshock_solver::shock::ObliqueShock;
use opshock_solver::simulation::Model;
use opshock_tests::pairs::{Pair, base, compare, random_pair, rough_base};

/// Conditions that any pair of a ramp, a sign and an amplitude may need; seeds of random pairs are
/// tried until one does.
const OF_STRUCTURE: [&str; 5] = [
    "R2 no ramp",
    "R3 first touch",
    "R4 shaking ramp",
    "R5 sign",
    "R7 mirrored",
];

type Change = fn(&mut Scene);

/// Conditions of sharing, with a change of the scene that only this condition keeps apart.
const OF_SHARING: [(&str, Change); 15] = [
    ("R9 slider", |s| s.slider.length_m *= 1.01),
    ("R9 gas", |s| s.gas.pressure_pa *= 0.9),
    ("R9 flow model", |s| s.flow = FlowModel::Slip1),
    ("R9 gap forces", |s| {
        s.gap_forces.surface_forces.potential_v = 0.3;
    }),
    ("R9 gap forces", |s| {
        s.gap_forces.asperity_contact.roughness_m = 0.5e-9;
    }),
    ("R9 film cells", |s| s.film_resolution.cells = 60),
    ("R9 speed", |s| s.disk.spin_rad_per_s *= 1.05),
    ("R9 gram load", |s| s.suspension.gram_load_n *= 1.05),
    ("R9 disk", |s| s.disk.thickness_m *= 1.05),
    ("R9 disk modes", |s| s.disk_resolution.cut_hz *= 0.5),
    ("R9 ramp", |s| s.ramp.clearance_top_m *= 0.5),
    ("R9 pulse", |s| s.pulse.width_s *= 1.1),
    ("R9 window", |s| s.window = Window::Fixed { length_s: 1e-3 }),
    ("R9 structure steps", |s| {
        s.structure_resolution.step_s *= 0.5
    }),
    ("R9 slider's place", |s| s.slider.angle_rad += 0.1),
];

fn differs(check: impl FnOnce()) -> bool {
    catch_unwind(AssertUnwindSafe(check)).is_err()
}

#[test]
fn effects_mutants_of_a_declared_dependency_are_caught() {
    let base = base();
    for output in Output::ALL {
        let pair = Pair {
            with_head: true,
            output: Some(output),
            ..Pair::default()
        };
        random_pair(&base, 1, pair);
        let mutant = Pair {
            mutant: Some(output.as_str()),
            ..pair
        };
        let is_caught = differs(|| random_pair(&base, 1, mutant));
        // An output of disk and ramp declares nothing beyond them.
        assert_eq!(is_caught, output.needs() > Needs::Structure, "{output:?}");
    }
}

#[test]
fn effects_mutants_of_the_structures_rules_are_caught() {
    let base = base();
    for name in OF_STRUCTURE {
        let mutant = Pair {
            mutant: Some(name),
            ..Pair::default()
        };
        let caught = (0..40).find(|&seed| differs(|| random_pair(&base, seed, mutant)));
        let seed = caught.unwrap_or_else(|| panic!("no pair needs {name}"));
        random_pair(&base, seed, Pair::default());
    }
}

/// A shock that touches, and one that survives: only the first may end before the window does, and at
/// its touch.
#[test]
fn effects_mutant_of_the_end_at_touch_is_caught() {
    let base = base();
    let shock = |amplitude_g: f64, mutant| {
        let pair = Pair {
            with_head: true,
            mutant,
            ..Pair::default()
        };
        compare(
            &base,
            &[Output::CriticalShock],
            amplitude_g,
            None,
            pair,
            "touch",
        );
    };
    for amplitude_g in [100.0, 300.0] {
        shock(amplitude_g, None);
        assert!(
            differs(|| shock(amplitude_g, Some("R6 touch"))),
            "{amplitude_g} G"
        );
    }
}

/// A random pair whose reduced model is another without the condition `name`.
fn is_caught(base: &Scene, seed: u64, output: Output, name: &'static str) {
    let pair = Pair {
        with_head: true,
        output: Some(output),
        ..Pair::default()
    };
    let mutant = Pair {
        mutant: Some(name),
        ..pair
    };
    random_pair(base, seed, pair);
    assert!(differs(|| random_pair(base, seed, mutant)), "{name}");
}

/// Contact that is asked for deleted: the run ends with the first touch.
#[test]
fn effects_mutant_of_the_run_through_contact_is_caught() {
    let base = rough_base();
    is_caught(&base, 0, Output::SliderContact, "R6 slider contact");
}

/// The asked times deleted: no field is kept.
#[test]
fn effects_mutant_of_the_asked_times_is_caught() {
    is_caught(&base(), 2, Output::PressureField, "R8 asked times");
}

#[test]
fn effects_mutants_of_the_conditions_of_sharing_are_caught() {
    let mut scene = base();
    scene.ramp.model = RigidRamp.into();
    for (name, change) in OF_SHARING {
        is_needed(&scene, name, change);
    }
    is_needed(&scene, "R9 base", |s| s.base = super::base::BASE.to_vec());
    // Only a disk on a hub takes an oblique shock.
    scene.disk.hub = Some(super::hub::spindle());
    is_needed(&scene, "R9 direction", |s| {
        s.oblique = Some(ObliqueShock {
            in_plane: [0.5, 0.0],
            ..ObliqueShock::default()
        });
    });
}

/// A shared model that `change` makes another one than `scene`; only the condition `name` shows the difference.
fn is_needed(scene: &Scene, name: &'static str, change: Change) {
    let asked = [Output::CriticalShock];
    let plan = Plan::new(&asked, Mode::Auto);
    let mut other = scene.clone();
    change(&mut other);
    let shared_model = Model::assemble(&other, &plan, None).expect("the shared_model builds");
    let shock = |mutant| {
        let pair = Pair {
            with_head: true,
            mutant,
            ..Pair::default()
        };
        compare(scene, &asked, 250.0, Some(&shared_model), pair, name);
    };
    shock(None);
    assert!(differs(|| shock(Some(name))), "nothing needs {name}");
}
