//! A run in the doubled window goes on where the study's window ended.

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::simulation::{Model, Request, Scope, Workspace, simulate};
use opshock_study::search::{Probe, ProbeResult};
use opshock_study::study::Study;
use opshock_study::sweep::{Physics, Simulator};
use opshock_tests::scenes::study;

const WINDOW: [(&str, &str); 2] = [("pulse.window_ms", "1.5"), ("pulse.signs", "[\"+\"]")];

fn of(ramp: &str, window: &[(&str, &str)]) -> Study {
    let ramp = format!("[\"{ramp}\"]");
    let mut sets = vec![
        ("pulse.widths_ms", "[0.5]"),
        ("ramp.models", ramp.as_str()),
        ("resolution.film_cells", "300"),
        ("resolution.disk_cut_khz", "20"),
    ];
    sets.extend(window);
    study("fig13-stiffness", &sets)
}

/// One shock in the study's window and in twice that window.
fn shaken(physics: &Physics, amplitude_g: f64) -> [ProbeResult; 2] {
    [1, 2].map(|window_factor| {
        let probe = Probe {
            window_factor,
            ..Probe::at(0)
        };
        physics.simulate(0, probe, m_per_s2_from_g(amplitude_g))
    })
}

/// What survives the study's window is not run again up to its end: the answer and the reported work are to the last
/// bit those of a run from the onset, with the full model too, without and with contact, in windows of fixed length
/// and of motion that decays.
#[test]
fn the_second_half_has_the_bits_of_a_run_from_the_onset() {
    let decays = [
        ("pulse.window_ms", "\"until_decayed\""),
        ("pulse.window_max_ms", "1.5"),
        ("pulse.signs", "[\"+\"]"),
    ];
    for (ramp, amplitude_g, window) in [
        ("none", 300.0, &WINDOW[..]),
        ("rigid", 201.0, &WINDOW[..]),
        ("deformable", 185.0, &decays[..]),
    ] {
        let study = of(ramp, window);
        let [single, double] = shaken(&Physics::of(&study), amplitude_g);
        let survives = |answer: &ProbeResult| answer.verdict.as_str() == "survives";
        assert!(survives(&single), "{ramp} {single:?}");
        // More work than in the study's window, and that of its first half counted.
        assert!(double.cost.steps > single.cost.steps + 20, "{double:?}");
        let doubled = Probe {
            window_factor: 2,
            ..Probe::at(0)
        };
        for fresh in [Physics::of(&study), Physics::in_full(&study)] {
            let from_onset = fresh.simulate(0, doubled, m_per_s2_from_g(amplitude_g));
            if survives(&double) {
                assert_eq!(from_onset, double, "{ramp}");
            } else {
                assert_eq!(from_onset.verdict, double.verdict, "{ramp}");
                assert_eq!(from_onset.h_min_m, double.h_min_m, "{ramp}");
            }
        }
    }
}

/// Beginning anew at the end of the study's window moves the clearance by less than its tolerance of 2 %.
#[test]
fn a_restart_moves_the_clearance_by_less_than_the_head_s_tolerance() {
    let study = of("none", &WINDOW);
    let amplitude_g = 400.0;
    let [_, double] = shaken(&Physics::of(&study), amplitude_g);
    let scene = study.points[0].scene.with_window_times(2.0);
    let model = Model::build(&scene, Scope::Full, None).expect("builds");
    let request = Request {
        amplitude_m_per_s2: m_per_s2_from_g(amplitude_g),
        record: false,
    };
    let at_once = simulate(&model, &request, &mut Workspace::default());
    let [restarted_m, at_once_m] = [double.h_min_m, at_once.min_clearance_m].map(Option::unwrap);
    assert!(
        (restarted_m / at_once_m - 1.0).abs() < 0.02,
        "{restarted_m} {at_once_m}"
    );
    assert!(double.cost.steps < at_once.cost.steps + 40, "{double:?}");
}
