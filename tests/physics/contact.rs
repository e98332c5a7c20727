//! Disk-ramp contact: event-driven reference trajectories, energy, signs, two methods.

use opshock_solver::disk::DiskMotion;
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{NoRamp, RampBody, RigidRamp};
use opshock_solver::structure::{Episode, StructureModel, StructureRun, Workspace};
use opshock_tests::digests::assert_digest;
use opshock_tests::sheet::at_most;
use opshock_tests::structures::{Structure, paper, paper_arms, s1, s1_arms};
use opshock_tests::{number, reference};

pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) amplitude: f64,
    pub(super) structure: Structure,
}

/// The four cases of set S1.
pub(super) fn cases() -> Vec<Case> {
    let case = |name, g: f64, width, model: RampBody| Case {
        name,
        amplitude: g * G,
        structure: s1(width, model),
    };
    vec![
        case("case1_rigid", 400.0, 2e-3, RigidRamp.into()),
        case("case1_deform", 400.0, 2e-3, s1_arms()),
        case("case2_rigid", 200.0, 5e-4, RigidRamp.into()),
        case("case2_deform", 200.0, 5e-4, s1_arms()),
    ]
}

pub(super) fn run(structure: &Structure, amplitude: f64) -> StructureRun {
    structure
        .build()
        .run(amplitude, true, &mut Workspace::default())
        .unwrap()
}

/// Largest difference of slider and ramp point from the reference samples, m.
fn distance(run: &StructureRun, name: &str) -> (f64, f64) {
    let data = reference("contact_trajectories.json");
    let columns = run.columns.as_ref().unwrap();
    let step = columns.time_s[1];
    let mut largest = (0.0_f64, 0.0_f64);
    for row in data["S1"][name]["samples_40kHz"]["rows"]
        .as_array()
        .unwrap()
    {
        let k = (number(&row[0]) / step).round() as usize;
        largest.0 = largest
            .0
            .max((columns.disk_slider_m[k] - number(&row[1])).abs());
        largest.1 = largest
            .1
            .max((columns.disk_ramp_m[k] - number(&row[2])).abs());
    }
    largest
}

/// The reference keeps its modes below 40 kHz and resolves contact by events; on the same modes
/// the production scheme must follow it far closer than the modes themselves are converged.
#[test]
fn set_s1_on_the_reference_s_own_modes() {
    for case in cases() {
        let run = run(&case.structure, case.amplitude);
        let columns = run.columns.as_ref().unwrap();
        let all = [&columns.disk_slider_m[..], &columns.disk_ramp_m].concat();
        assert_digest(
            &format!("reference contact_trajectories {}", case.name),
            &all,
        );
        let (slider, ramp) = distance(&run, case.name);
        at_most(
            "disk-ramp-contact",
            "distance under the slider at any sample (m)",
            slider,
            1e-8,
        );
        at_most(
            "disk-ramp-contact",
            "distance at the ramp at any sample (m)",
            ramp,
            2e-8,
        );
    }
}

/// The basis a user gets, within what the reference is good for.
#[test]
fn set_s1_with_static_correction_within_the_reference_s_trust() {
    for mut case in cases() {
        case.structure.disk_resolution.static_correction = true;
        let trust = if case.name == "case1_rigid" {
            2e-7
        } else {
            8e-8
        };
        let (slider, ramp) = distance(&run(&case.structure, case.amplitude), case.name);
        assert!(
            slider < trust && ramp < 4e-7,
            "{}: {slider:e} {ramp:e}",
            case.name
        );
    }
}

#[test]
fn set_s1_first_impacts_impulses_and_contact_order() {
    let data = reference("contact_trajectories.json");
    for case in cases() {
        let run = run(&case.structure, case.amplitude);
        // Row 2 of the study is the 40 kHz one.
        let study = &data["S1"][case.name]["modes_study"][2];
        let first = number(&study["first_impacts"][0][0]);
        let found = run.first_touch_s.unwrap();
        at_most(
            "disk-ramp-contact",
            "error of the time of first touch (s)",
            (found - first).abs(),
            1e-7,
        );
        let sides = [("top", &run.top, 0), ("bottom", &run.bottom, 1)];
        for (key, side, index) in sides {
            let total = number(&study[key]["impulse"]);
            let share = match (case.name, index) {
                ("case2_rigid", 0) => 0.06,
                ("case2_rigid", _) => 0.15,
                _ => 0.02,
            };
            assert!(
                (side.impulse_n_s - total).abs() <= share * total,
                "{} {key}",
                case.name
            );
            let spells = study[key]["episodes_on_off_impulse"].as_array().unwrap();
            assert_eq!(side.episodes.len(), spells.len(), "{} {key}", case.name);
            for (episode, spell) in side.episodes.iter().zip(spells) {
                // Weak spells come and go within 2 us; strong ones are sharp.
                assert!((episode.on_s - number(&spell[0])).abs() < 2e-6);
                assert!((episode.off_s - number(&spell[1])).abs() < 20e-6);
            }
            // 20 us means: good to a few percent of the largest.
            let peak = side
                .episodes
                .iter()
                .map(|e| e.peak_20us_n)
                .fold(0.0, f64::max);
            let expected = number(&study[key]["peak_20us"]);
            assert!(
                (peak - expected).abs() <= 0.05 * expected,
                "{} {key}: {peak} {expected}",
                case.name
            );
        }
        let balance = &study["energy"];
        let peak = run.energy.h_peak_j;
        assert!((run.energy.h_end_j - number(&balance["H_end"])).abs() < 2e-4 * peak);
        assert!((run.energy.shock_work_j - number(&balance["W_load"])).abs() < 2e-4 * peak);
        assert!((run.energy.damping_loss_j - number(&balance["D_damp"])).abs() < 2e-4 * peak);
        assert!((run.energy.impact_loss_j - number(&balance["E_impact"])).abs() < 2e-4 * peak);
        let material = run.energy.kinetic_j + run.energy.elastic_j;
        assert!((material - number(&balance["E_phys_end"])).abs() < 2e-4 * peak);
    }
}

/// Energy, signs and complementarity of every case, with its limits.
fn assert_sound(run: &StructureRun, name: &str) {
    let e = &run.energy;
    assert!(e.closure < 1e-9, "{name}: closure {:e}", e.closure);
    assert!(
        e.algorithmic_j <= 0.0 && e.impact_loss_j >= -1e-15 * e.h_peak_j,
        "{name}: {e:?}"
    );
    assert!(e.algorithmic_j.abs() < 1e-5 * e.h_peak_j, "{name}: {e:?}");
    let c = &run.complementarity;
    assert!(c.min_multiplier_n_s >= 0.0, "{name}: {c:?}");
    assert!(c.max_penetration_m < 1e-7, "{name}: {c:?}");
    assert!(c.max_product_n_s_m < 1e-13, "{name}: {c:?}");
}

#[test]
fn hard_b1_energy_signs_and_complementarity() {
    for mut case in cases() {
        for (cut, corrected) in [(10e3, true), (20e3, true), (40e3, true)] {
            case.structure.disk_resolution.cut_hz = cut;
            case.structure.disk_resolution.static_correction = corrected;
            for restitution in [0.0, 0.5, 1.0] {
                case.structure.ramp.restitution = restitution;
                assert_sound(&run(&case.structure, case.amplitude), case.name);
            }
        }
    }
}

/// The material energy has its own balance: the spindle feeds it through contact.
#[test]
fn the_material_energy_balances_with_the_spindle() {
    // Without damping: E_end = shock work - impact loss + algorithmic + spindle work.
    for mut case in cases() {
        case.structure.disk.damping = opshock_solver::disk::DiskDamping::ModalRatio(0.0);
        for mode in case.structure.ramp.model.contacts.iter_mut().flatten() {
            mode.damping_ratio = 0.0;
        }
        let e = run(&case.structure, case.amplitude).energy;
        let expected = e.shock_work_j - e.impact_loss_j + e.algorithmic_j + e.spindle_work_j;
        let material = e.kinetic_j + e.elastic_j;
        assert!(
            (material - expected).abs() < 1e-9 * e.h_peak_j,
            "{}: {e:?}",
            case.name
        );
        assert!(e.spindle_work_j != 0.0 && e.damping_loss_j == 0.0);
    }
}

#[test]
fn recording_and_reused_memory_change_nothing() {
    let mut workspace = Workspace::default();
    let all = cases();
    let models: Vec<StructureModel> = all.iter().map(|c| c.structure.build()).collect();
    for (case, model) in all.iter().zip(&models) {
        let fresh = run(&case.structure, case.amplitude);
        let mut reused = model.run(case.amplitude, false, &mut workspace).unwrap();
        assert!(reused.columns.is_none());
        reused.columns.clone_from(&fresh.columns);
        assert_eq!(fresh, reused);
    }
}

pub(super) fn slider_distance(coarse: &StructureRun, fine: &StructureRun) -> f64 {
    let (a, b) = (
        coarse.columns.as_ref().unwrap(),
        fine.columns.as_ref().unwrap(),
    );
    let ratio = (a.time_s[1] / b.time_s[1]).round() as usize;
    a.disk_slider_m
        .iter()
        .zip(b.disk_slider_m.iter().step_by(ratio))
        .map(|(x, y)| (x - y).abs())
        .fold(0.0, f64::max)
}

/// Between impacts the scheme is exact, at located impacts too; what is left is the force of
/// lasting contact as impulses at nodes, of second order. Spells open and close between nodes, so
/// the order shows in the mean over a range of steps.
#[test]
fn hard_b14_order_of_the_production_scheme_is_two() {
    let mut orders = 0.0;
    for case in cases() {
        let structure = case.structure.with_cut(20e3);
        let fine = run(&structure.with_step(0.0625e-6), case.amplitude);
        let errors: Vec<f64> = [2e-6, 1e-6, 0.5e-6, 0.25e-6]
            .iter()
            .map(|&h| slider_distance(&run(&structure.with_step(h), case.amplitude), &fine))
            .collect();
        orders += 0.25 * (errors[0] / errors[3]).log2() / 3.0;
        assert!(
            errors[1] < 5e-9 && errors[2] < 2e-9,
            "{}: {errors:?}",
            case.name
        );
    }
    assert!(orders > 1.5, "mean order {orders}");
}

/// Two methods that share nothing but the modes meet as the step shrinks.
#[test]
fn production_and_moreau_jean_meet_as_the_step_shrinks() {
    for case in cases() {
        let structure = case.structure.with_cut(20e3);
        let production = run(&structure.with_step(0.125e-6), case.amplitude);
        let errors: Vec<f64> = [1e-6, 0.5e-6, 0.25e-6, 0.125e-6]
            .iter()
            .map(|&h| {
                let other = run(&structure.with_step(h).with_moreau_jean(), case.amplitude);
                slider_distance(&other, &production)
            })
            .collect();
        assert!(errors[3] < 0.4 * errors[0], "{}: {errors:?}", case.name);
        at_most(
            "two-contact-methods",
            "distance under the slider, steps of 0.125 us (m)",
            errors[3],
            5e-8,
        );
        let finest = run(
            &structure.with_step(0.125e-6).with_moreau_jean(),
            case.amplitude,
        );
        for (side, other) in [
            (&production.top, &finest.top),
            (&production.bottom, &finest.bottom),
        ] {
            let other = other.impulse_n_s;
            at_most(
                "two-contact-methods",
                "difference of the impulse on an arm, of it and 0.1 uN s",
                (side.impulse_n_s - other).abs() / (other.abs() + 1e-7),
                0.01,
            );
        }
        // Everything else a run says, from steps that have only the modes in common.
        let near = |a: f64, b: f64, share: f64| (a - b).abs() <= share * a.abs();
        let (a, b) = (&production, &finest);
        let first = [a.first_touch_s, b.first_touch_s].map(|t| t.expect("touches"));
        assert!((first[0] - first[1]).abs() < 0.5e-6, "{}", case.name);
        assert!(near(a.disk.rim_max_m, b.disk.rim_max_m, 1e-3));
        assert!(near(a.energy.h_peak_j, b.energy.h_peak_j, 1e-3));
        assert!(near(a.energy.shock_work_j, b.energy.shock_work_j, 1e-2));
        assert!(b.energy.impact_loss_j >= 0.0);
        assert!(b.energy.closure < 1e-9, "{:e}", b.energy.closure);
        assert!(b.complementarity.min_multiplier_n_s >= 0.0);
    }
}

/// Adding modes: distances to a rich basis fall, and the static correction gives with the modes
/// below 20 kHz what takes 40 kHz without it, or nearly so.
#[test]
fn the_answer_converges_with_modes() {
    for case in cases() {
        let mut rich = case.structure.with_cut(80e3).with_step(0.5e-6);
        rich.disk_resolution.static_correction = true;
        let truth = run(&rich, case.amplitude);
        let distance = |cut: f64, corrected: bool| {
            let mut structure = case.structure.with_cut(cut);
            structure.disk_resolution.static_correction = corrected;
            slider_distance(&run(&structure, case.amplitude), &truth)
        };
        let plain = [10e3, 20e3, 40e3].map(|cut| distance(cut, false));
        let corrected = [10e3, 20e3, 40e3].map(|cut| distance(cut, true));
        assert!(
            plain[2] < plain[0] && corrected[2] < corrected[0],
            "{}: {plain:?} {corrected:?}",
            case.name
        );
        for (a, b) in plain.iter().zip(&corrected) {
            assert!(b < a, "{}: {plain:?} {corrected:?}", case.name);
        }
    }
}

/// Onset amplitudes of the paper's set.
#[test]
fn first_touch_amplitudes_of_the_paper_set() {
    for (width, rigid, deformable) in [
        (0.5e-3, 195.5, 180.0),
        (1e-3, 183.2, 224.0),
        (2e-3, 255.5, 320.0),
        (3e-3, 268.6, 322.0),
    ] {
        let onset = |model: RampBody| {
            let model = paper(width, model).build();
            let (plus, minus) = (
                model.touch_amplitude_m_per_s2(true).unwrap() / G,
                model.touch_amplitude_m_per_s2(false).unwrap() / G,
            );
            assert!(
                (plus / minus - 1.0).abs() < 1e-12,
                "equal gaps: the signs mirror"
            );
            plus
        };
        assert!(
            (onset(RigidRamp.into()) / rigid - 1.0).abs() < 1e-2,
            "{width}"
        );
        assert!(
            (onset(paper_arms()) / deformable - 1.0).abs() < 0.01,
            "{width}"
        );
        assert_eq!(
            paper(width, NoRamp).build().touch_amplitude_m_per_s2(true),
            None
        );
    }
}

/// Hard case B5: contact begins exactly at the touch amplitude, and gently.
#[test]
fn hard_b5_grazing_at_the_touch_amplitude() {
    let mut workspace = Workspace::default();
    for model in [RampBody::from(RigidRamp), paper_arms()] {
        for width in [0.5e-3, 2e-3] {
            let model = paper(width, model.clone()).build();
            let onset = model.touch_amplitude_m_per_s2(true).unwrap();
            let mut last = f64::MAX;
            for excess in [1e-3, 1e-6, 1e-9] {
                let below = model
                    .run(onset * (1.0 - excess), false, &mut workspace)
                    .unwrap();
                assert_eq!(below.first_touch_s, None, "{excess}");
                let above = model
                    .run(onset * (1.0 + excess), false, &mut workspace)
                    .unwrap();
                assert!(above.first_touch_s.is_some(), "{excess}");
                let first = above
                    .top
                    .episodes
                    .first()
                    .or(above.bottom.episodes.first())
                    .unwrap();
                // The first spell's impulse falls with the excess, at least as its square root.
                assert!(first.impulse_n_s < last, "{excess}: {first:?}");
                last = first.impulse_n_s;
                assert_sound(&above, "grazing");
            }
        }
    }
}

/// Spells of a run are in order, apart, and sum to the total.
#[test]
fn episodes_are_ordered_and_complete() {
    for case in cases() {
        let run = run(&case.structure, case.amplitude);
        for side in [&run.top, &run.bottom] {
            let sum: f64 = side.episodes.iter().map(|e| e.impulse_n_s).sum();
            assert!((sum - side.impulse_n_s).abs() <= 1e-12 * sum);
            assert_eq!(side.first_touch_s, side.episodes.first().map(|e| e.on_s));
            assert!(
                side.episodes
                    .windows(2)
                    .all(|w: &[Episode]| w[1].on_s - w[0].off_s > 30e-6)
            );
        }
    }
}

/// The history between nodes: finer grids agree far below the film's resolution.
#[test]
fn the_history_is_smooth_between_contacts() {
    let mut structure = paper(2e-3, paper_arms());
    let amplitude = 400.0 * G;
    let coarse = run(&structure, amplitude);
    structure.resolution.step_s *= 0.125;
    let fine = run(&structure, amplitude);
    let spells: Vec<_> = coarse
        .top
        .episodes
        .iter()
        .chain(&coarse.bottom.episodes)
        .collect();
    let mut largest = 0.0_f64;
    for k in 0..80_000_usize {
        let t = (k as f64 + 0.5) * structure.resolution.step_s;
        if t > 5e-3 || spells.iter().any(|e| t > e.on_s - 1e-6) {
            break;
        }
        let difference =
            coarse.history.pose(t).displacement_m - fine.history.pose(t).displacement_m;
        largest = largest.max(difference.abs());
    }
    assert!(largest < 1e-14, "before contact: {largest:e}");
    // After contact: third differences of what the head reads, over a fifth of the step.
    let h = 1e-7;
    let free = |t: f64| {
        !spells
            .iter()
            .any(|e| t > e.on_s - 1e-6 && t < e.off_s + 2e-6)
    };
    let mut rough = 0.0_f64;
    for k in 0..45_000_usize {
        let t = k as f64 * h;
        if free(t) && free(t + 3.0 * h) {
            let w = |j: f64| coarse.history.pose(t + j * h).displacement_m;
            rough = rough.max((w(3.0) - 3.0 * w(2.0) + 3.0 * w(1.0) - w(0.0)).abs());
        }
    }
    assert!(rough < 1e-11, "third difference {rough:e}");
}
