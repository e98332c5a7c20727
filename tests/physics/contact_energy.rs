//! A contact with a stiffness adds no energy.
//!
//! Without damping of disk and arms, and once the shock is over, nothing may raise H: the contact stands
//! in space (see the theory of [`opshock_solver::structure`]), its impulses only take, and so does the
//! damping of its spring. The disk turns under it at the speed of the study.

use opshock_solver::disk::DiskDamping;
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{Model, Outcome, Request, Scope, Workspace, simulate};
use opshock_tests::scenes::scene;
use opshock_tests::sheet::at_most;

const PULSE_MS: f64 = 0.5;

/// Figure 13's disk and ramp alone at 1 % for `window_ms`, without damping but the contact's own.
fn undamped(ramp: &str, stiffness: Option<f64>, window_ms: &str) -> Scene {
    let mut scene = scene(
        "fig13-stiffness",
        ramp,
        PULSE_MS,
        &[("pulse.window_ms", window_ms)],
    );
    scene.ramp.contact_stiffness_n_per_m = stiffness;
    scene.disk.damping = DiskDamping::ModalRatio(0.0);
    for mode in scene.ramp.model.contacts.iter_mut().flatten() {
        mode.damping_ratio = 0.0;
    }
    scene
}

fn outcome(scene: &Scene) -> Outcome {
    let model = Model::build(scene, Scope::Structure, None).expect("builds");
    let request = Request {
        amplitude_m_per_s2: 200.0 * G,
        record: true,
    };
    simulate(&model, &request, &mut Workspace::default())
}

/// Largest rise of H from any instant after the shock to any later one, of its peak.
fn rise(outcome: &Outcome) -> f64 {
    let columns = &outcome.history.as_ref().expect("recorded").structure;
    let (mut lowest, mut rise, mut peak) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    for (time_s, h_j) in columns.time_s.iter().zip(&columns.energy_h_j) {
        peak = peak.max(*h_j);
        if *time_s > 1.001e-3 * PULSE_MS {
            lowest = lowest.min(*h_j);
            rise = rise.max(h_j - lowest);
        }
    }
    rise / peak
}

fn assert_falls(scene: &Scene, name: &str) {
    let run = outcome(scene);
    assert!(run.top.first_touch_s.is_some() && run.bottom.first_touch_s.is_some());
    let (rise, balance) = (rise(&run), &run.energy);
    at_most(
        "contact-energy",
        "largest rise of the energy after the shock, of its peak",
        rise,
        1e-10,
    );
    at_most(
        "contact-energy",
        "closure of the balance, of the peak",
        balance.closure,
        1e-9,
    );
    assert!(
        balance.algorithmic_j <= 0.0 && balance.damping_loss_j >= 0.0,
        "{name}: {balance:?}"
    );
}

/// Impulses that gave back what an even train of them would lose in the spring, and not what is lost
/// there, raised H by 5e-5 of itself at 1e6 N/m and by 3 % at 1e4 N/m (deformable, 20 ms).
#[test]
fn a_contact_of_any_stiffness_adds_no_energy() {
    for ramp in ["rigid", "deformable"] {
        for stiffness in [None, Some(1e4), Some(1e5), Some(1e6), Some(1e7), Some(1e9)] {
            let scene = undamped(ramp, stiffness, "20.0");
            assert_falls(&scene, &format!("{ramp}, {stiffness:?} N/m"));
        }
    }
}

/// Whatever spring: slow, light, without damping, slowed by the step; both arms pushed at once; a disk
/// that stands; arms and disk damped.
#[test]
fn no_spring_adds_energy() {
    let with = |change: &dyn Fn(&mut Scene)| {
        let mut scene = undamped("deformable", Some(1e6), "6.0");
        change(&mut scene);
        scene
    };
    for (frequency_hz, ratio) in [(5e4, 0.5), (4e5, 0.0), (4e5, 0.05), (4e5, 1.0), (1e6, 1.0)] {
        let scene = with(&|scene| {
            scene.ramp.contact_frequency_hz = frequency_hz;
            scene.ramp.contact_damping_ratio = ratio;
        });
        assert_falls(&scene, &format!("{frequency_hz:e} Hz, ratio {ratio}"));
    }
    let touching = with(&|scene| {
        scene.ramp.clearance_top_m = 0.0;
        scene.ramp.clearance_bottom_m = 0.0;
    });
    assert_falls(&touching, "both arms touch");
    assert_falls(&with(&|scene| scene.disk.spin_rad_per_s = 0.0), "standing");
    for share in [1e-3, 1.0] {
        let damped = with(&|scene| {
            scene.disk.damping = DiskDamping::Rayleigh {
                alpha_per_s: 25.0 * share,
                beta_s: 1e-7 * share,
            };
        });
        assert_falls(&damped, &format!("damping of {share} times the study's"));
    }
}

/// Relative distances of two runs, `every` steps of the second to one of the first: motion under the slider,
/// 20 us mean of the force on the bottom arm.
fn apart(coarse: &Outcome, fine: &Outcome, every: usize) -> [f64; 2] {
    let [a, b] = [coarse, fine].map(|run| &run.history.as_ref().expect("recorded").structure);
    let distance = |a: &[f64], b: &[f64]| {
        let b: Vec<f64> = b.iter().step_by(every).copied().collect();
        assert_eq!(a.len(), b.len());
        let apart = a.iter().zip(&b).map(|(x, y)| (x - y).abs());
        let largest = b.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        apart.fold(0.0, f64::max) / largest
    };
    [
        distance(&a.disk_slider_m, &b.disk_slider_m),
        distance(&a.contact_bottom_n, &b.contact_bottom_n),
    ]
}

/// A spring that is 3 % stiffer at the nodes than in the mean is 2.9e-4, 1.8e-2 (rigid) and 1.2e-3, 9.4e-3
/// (deformable) off at the standard step, 1.4e-5, 2.0e-3 and 7.7e-5, 1.7e-3 at a quarter of it.
#[test]
fn contacts_converge_with_the_step() {
    for (ramp, bounds) in [
        ("rigid", [[5e-5, 1e-2], [5e-6, 2e-3]]),
        ("deformable", [[2e-4, 2e-2], [1e-5, 3e-3]]),
    ] {
        let at = |step_us: f64| {
            let mut scene = undamped(ramp, Some(1e6), "4.0");
            scene.disk_resolution.cut_hz = 120e3;
            scene.disk_resolution.n_harmonics = 80;
            scene.disk_resolution.n_elements = 56;
            scene.structure_resolution.step_s = 1e-6 * step_us;
            outcome(&scene)
        };
        let finest = at(0.25 / 16.0);
        for (parts, bounds) in [1_u32, 4].into_iter().zip(bounds) {
            let run = at(0.25 / f64::from(parts));
            let touches = [&run, &finest].map(first_touch_s);
            assert!((touches[0] - touches[1]).abs() < 1e-9, "{touches:?}");
            let apart = apart(&run, &finest, 16 / parts as usize);
            println!("{ramp}, 1/{parts}: {:.1e} {:.1e}", apart[0], apart[1]);
            assert!(apart[0] < bounds[0] && apart[1] < bounds[1], "{apart:?}");
        }
    }
}

fn first_touch_s(outcome: &Outcome) -> f64 {
    let touches = [&outcome.top, &outcome.bottom].map(|arm| arm.first_touch_s);
    touches.into_iter().flatten().fold(f64::INFINITY, f64::min)
}
