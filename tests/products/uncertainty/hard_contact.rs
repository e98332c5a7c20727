//! Which points have their disk modes confirmed by finer ones.

use opshock_study::study::Study;
use opshock_study::sweep::SweepInput;

/// Those of a ramp whose contact has no stiffness, and no others.
#[test]
fn disk_modes_are_confirmed_under_a_hard_contact() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../studies/fig13/study.toml");
    for (set, hard) in [
        ("pulse.signs=+", [false, true, true]),
        ("ramp.contact_stiffness_n_per_m=1e6", [false; 3]),
    ] {
        let sets = [set, "pulse.widths_ms=2"].map(|set| set.parse().unwrap());
        let study = Study::from_path(path.as_ref(), &sets).unwrap();
        let points = SweepInput::of(&study).unwrap().points;
        let mut seen = [false; 3];
        for (point, of_study) in points.iter().zip(&study.points) {
            let ramps = ["none", "rigid", "deformable"];
            let ramp = ramps
                .iter()
                .position(|name| *name == of_study.ramp.as_str());
            let ramp = ramp.unwrap();
            let plan = point.uncertainty.as_ref().unwrap();
            assert_eq!(plan.hard_contact, hard[ramp], "{set} {}", ramps[ramp]);
            seen[ramp] = true;
        }
        assert_eq!(seen, [true; 3]);
    }
}
