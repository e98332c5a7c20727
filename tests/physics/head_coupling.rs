//! Film and structure solved together or in turn: same motion, other cost.

use opshock_solver::head::{Coupling, HeadRun, HeadWorkspace, ShockLoad, Verdict};
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_tests::heads::{SingleModeDisk, default_film, default_resolution, head_on};

const PULSE: Pulse = Pulse {
    shape: PulseShape::HalfSine,
    width_s: 0.5e-3,
};

fn run(coupling: Coupling) -> HeadRun {
    let (film, flight) = default_film(300);
    let mut resolution = default_resolution();
    resolution.coupling = coupling;
    resolution.tolerance = 1e-3;
    resolution.coupling_tolerance = 1e-7;
    let model = head_on(&film, &flight, &resolution);
    let amplitude_m_per_s2 = -2500.0;
    let disk = SingleModeDisk::new(amplitude_m_per_s2, PULSE.width_s);
    let load = ShockLoad {
        base: None,
        pulse: &PULSE,
        amplitude_m_per_s2,
    };
    model.run(
        &disk,
        &load,
        0.3e-3,
        true,
        false,
        &mut HeadWorkspace::new(&model),
    )
}

#[test]
fn hard_d1_partitioned_couplings_agree_with_the_monolithic_solve() {
    let together = run(Coupling::Monolithic);
    assert_eq!(together.verdict, Verdict::Survives);
    for coupling in [Coupling::Anderson, Coupling::Aitken, Coupling::FixedPoint] {
        let in_turn = run(coupling);
        assert_eq!(in_turn.verdict, Verdict::Survives, "{coupling:?}");
        let change = in_turn.min_clearance_m / together.min_clearance_m - 1.0;
        assert!(change.abs() < 2e-4, "{coupling:?}: {change:e}");
        assert!(
            in_turn.cost.film_residuals > together.cost.film_residuals,
            "{coupling:?}"
        );
        if coupling == Coupling::FixedPoint {
            // The plain iteration diverges at the steps that accuracy would allow; the guard cuts
            // them until it converges.
            assert!(
                in_turn.cost.steps > 2 * together.cost.steps,
                "{:?}",
                in_turn.cost
            );
        }
    }
}
