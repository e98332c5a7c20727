//! The head (film, slider, suspension) without a shock, or under a negligible one.

use opshock_solver::head::{Cause, HeadWorkspace, ShockLoad, Verdict};
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_tests::heads::{SingleModeDisk, StillDisk, default_head, default_resolution};

const PULSE: Pulse = Pulse {
    shape: PulseShape::HalfSine,
    width_s: 2e-3,
};

/// E1, E10: no shock, no change, no failure; few steps.
#[test]
fn hard_e1_zero_amplitude_keeps_the_steady_clearance() {
    let model = default_head(300, &default_resolution());
    let mut workspace = HeadWorkspace::new(&model);
    for amplitude in [0.0, 1e-300] {
        let load = ShockLoad {
            base: None,
            pulse: &PULSE,
            amplitude_m_per_s2: amplitude,
        };
        let run = model.run(&StillDisk, &load, 5e-3, true, true, &mut workspace);
        assert_eq!(run.verdict, Verdict::Survives);
        let columns = run.columns.expect("recorded");
        let steady = model.steady_clearance_m();
        for clearance in columns.min_clearance_m {
            assert!((clearance / steady - 1.0).abs() < 1e-9, "{clearance}");
        }
        assert!(run.cost.steps < 550, "{} steps", run.cost.steps);
        assert_eq!(run.cost.rejected, 0);
        assert_eq!(run.dimple.open_s, 0.0);
        assert!((run.end_s - 5e-3).abs() < 1e-15);
    }
}

/// Nothing of an earlier run is left in the workspace.
#[test]
fn a_run_has_the_same_bits_in_a_used_workspace() {
    let model = default_head(300, &default_resolution());
    let disk = SingleModeDisk::new(2000.0, 2e-3);
    let load = ShockLoad {
        base: None,
        pulse: &PULSE,
        amplitude_m_per_s2: 2000.0,
    };
    let mut workspace = HeadWorkspace::new(&model);
    let first = model.run(&disk, &load, 1e-3, true, true, &mut workspace);
    let other = SingleModeDisk::new(-4000.0, 2e-3);
    let other_load = ShockLoad {
        base: None,
        pulse: &PULSE,
        amplitude_m_per_s2: -4000.0,
    };
    model.run(&other, &other_load, 1e-3, true, false, &mut workspace);
    let again = model.run(&disk, &load, 1e-3, true, true, &mut workspace);
    assert_eq!(first, again);
}

#[test]
fn the_step_limit_leaves_a_run_undecided() {
    let mut resolution = default_resolution();
    resolution.max_steps = 20;
    let model = default_head(300, &resolution);
    let load = ShockLoad {
        base: None,
        pulse: &PULSE,
        amplitude_m_per_s2: 0.0,
    };
    let run = model.run(
        &StillDisk,
        &load,
        5e-3,
        true,
        false,
        &mut HeadWorkspace::new(&model),
    );
    assert!(matches!(
        run.verdict,
        Verdict::Undecided { cause: Cause::StepLimit { max_steps: 20, time_s } } if time_s < 5e-3
    ));
}
