//! Mechanisms of failure of whole drives, one shock of each: those that `docs/mechanisms.md` shows.

use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::{FailureEvidence, Mechanism};
use opshock_tests::{pairs, scenes};

fn evidence(ramp: &str, pulse_ms: f64, amplitude_g: f64, sets: &[(&str, &str)]) -> FailureEvidence {
    evidence_of("fig13", ramp, pulse_ms, amplitude_g, sets)
}

fn evidence_of(
    study: &str,
    ramp: &str,
    pulse_ms: f64,
    amplitude_g: f64,
    sets: &[(&str, &str)],
) -> FailureEvidence {
    let mut all = vec![("resolution.preset", "\"coarse\"")];
    all.extend(sets);
    let scene = scenes::scene(study, ramp, pulse_ms, &all);
    let outputs = [
        Output::CriticalShock,
        Output::BearingForce,
        Output::DimpleForce,
        Output::ContactForce,
    ];
    let (_, outcome) = pairs::run(&scene, &Plan::new(&outputs, Mode::Auto), amplitude_g, None);
    FailureEvidence::of(&outcome).expect("a failure")
}

#[test]
fn shocks_fail_by_the_mechanism_that_their_forces_show() {
    let limiters = [("suspension.limiters.gap_um", "10.0")];
    let lift_tab = [("suspension.lift_tab.gap_um", "10.0")];
    for (expected, found) in [
        (Mechanism::Compression, evidence("none", 2.0, -671.0, &[])),
        (
            Mechanism::DimpleSeparation,
            evidence("none", 1.0, 417.0, &[]),
        ),
        (Mechanism::RampImpact, evidence("rigid", 2.0, -327.0, &[])),
        (Mechanism::Limiter, evidence("none", 1.0, 600.0, &limiters)),
        (Mechanism::LiftTab, evidence("none", 1.0, 450.0, &lift_tab)),
        (
            Mechanism::LiftLoss,
            evidence_of("fig13-stiffness", "none", 3.0, 497.0, &[]),
        ),
    ] {
        println!("{expected:?}: {found:?}");
        assert_eq!(found.mechanism(), expected, "{found:?}");
        match expected {
            // A load of more than twice the steady one, carried to the end.
            Mechanism::Compression => {
                assert!(
                    found.bearing_over_steady > 2.0
                        && found.dimple_over_steady > 2.0
                        && found.bearing_range_over_steady < 0.25
                );
                assert_eq!(
                    (found.dimple_open_before_s, found.ramp_contact_before_s),
                    (None, None)
                );
            }
            // Suction holds the slider while the dimple is open.
            Mechanism::DimpleSeparation => {
                assert!(found.bearing_over_steady < 0.0 && found.ramp_contact_before_s.is_none())
            }
            Mechanism::RampImpact => {
                assert!(
                    found.bearing_range_over_steady > 1.0 && found.dimple_open_before_s.is_none()
                );
                // Not before waves of 80 kHz, the fastest of the disk's modes, have come 10.5 mm.
                assert!(found.ramp_began_before_s.expect("a contact") > 7e-6);
            }
            Mechanism::LiftTab => {
                assert!(found.lift_tab_before_s.expect("closed") < 20e-6);
                assert!(found.limiter_before_s.is_none() && found.dimple_open_before_s.is_none());
            }
            // Suction at a dimple that has not opened.
            Mechanism::LiftLoss => {
                assert!(found.bearing_over_steady < 0.0 && found.dimple_over_steady > 0.0);
                assert_eq!(found.dimple_open_before_s, None);
            }
            _ => assert!(found.limiter_before_s.expect("closed") < 20e-6),
        }
    }
}
