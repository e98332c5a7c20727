//! Whole shocks on a disk of one mode: accuracy against tolerance, critical amplitudes.

use opshock_solver::head::{HeadRun, HeadWorkspace, ShockLoad, Verdict};
use opshock_solver::integrator::ESDIRK3;
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_tests::heads::{
    SingleModeDisk, default_film, default_head, default_resolution, head_on,
};

const PULSE: Pulse = Pulse {
    shape: PulseShape::HalfSine,
    width_s: 2e-3,
};
const G: f64 = 9.80665;

/// The smallest clearance of a surviving shock is as accurate as the local tolerance asks, and
/// another scheme converges to the same number.
#[test]
fn smallest_clearance_converges_with_the_tolerance() {
    let (film, flight) = default_film(300);
    let run = |tolerance: f64, third_order: bool| -> HeadRun {
        let mut resolution = default_resolution();
        resolution.tolerance = tolerance;
        resolution.coupling_tolerance = 0.1 * tolerance;
        let mut model = head_on(&film, &flight, &resolution);
        if third_order {
            model = model.with_tableau(ESDIRK3);
        }
        let disk = SingleModeDisk::new(400.0 * G, PULSE.width_s);
        let load = ShockLoad {
            base: None,
            pulse: &PULSE,
            amplitude_m_per_s2: 400.0 * G,
        };
        model.run(
            &disk,
            &load,
            2.5e-3,
            true,
            false,
            &mut HeadWorkspace::new(&model),
        )
    };
    let reference = run(1e-6, false).min_clearance_m;
    let error = |run: &HeadRun| (run.min_clearance_m / reference - 1.0).abs();
    for tolerance in [1e-2, 3e-3, 1e-3, 1e-4] {
        let run = run(tolerance, false);
        assert!(error(&run) < tolerance, "{tolerance}: {:e}", error(&run));
        assert!(run.cost.max_residual <= 0.1 * tolerance);
        assert!(run.cost.mass_balance_error < tolerance);
        assert!(run.cost.min_pressure_pa > 0.0);
    }
    assert!(error(&run(1e-5, true)) < 5e-5);
}

/// A prototype of the same drive on its own disk had 10 nm left at 647 G and touched at 669 G: the
/// load beam's inertia takes the preload away, and the disk's slope tips the slider over. The
/// disk here is its single-mode stand-in, so the bracket is tested 5 % wide on either side.
#[test]
fn positive_failure_without_a_ramp_is_abrupt() {
    let model = default_head(528, &default_resolution());
    let mut workspace = HeadWorkspace::new(&model);
    let mut at = |g: f64| {
        let disk = SingleModeDisk::new(g * G, PULSE.width_s);
        let load = ShockLoad {
            base: None,
            pulse: &PULSE,
            amplitude_m_per_s2: g * G,
        };
        model.run(&disk, &load, 2.5e-3, true, false, &mut workspace)
    };
    let below = at(615.0);
    assert_eq!(below.verdict, Verdict::Survives);
    assert!(below.min_clearance_m > 6e-9, "{:e}", below.min_clearance_m);
    let above = at(700.0);
    assert!(
        matches!(above.verdict, Verdict::Fails { .. }),
        "{:?}",
        above.verdict
    );
}
