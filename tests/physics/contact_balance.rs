//! Energy balance of slider and suspension, with every contact and load that it counts.

use opshock_solver::head::{HeadModel, HeadRun, HeadWorkspace, ShockLoad};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::suspension::{ContactLaw, LiftTab, Limiter};
use opshock_tests::heads::{default_resolution, default_slider, rough_film};
use opshock_tests::rough::ROUGH;
use opshock_tests::suspensions::default_suspension;

use super::base_pivot::{MovedPivot, swung};

/// A shock that lifts the load beam onto limiters and lift tab, and then throws the slider onto the disk.
fn slapped(tolerance: f64, window_s: f64) -> HeadRun {
    let (film, flight) = rough_film(150, &ROUGH);
    let contact = ContactLaw {
        stiffness_n_per_m: 1e5,
        damping_ratio: 0.05,
    };
    let mut suspension = default_suspension();
    suspension.limiters = [-3e-4, 3e-4]
        .map(|across_m| Limiter {
            gap_m: 5e-6,
            along_m: 2e-4,
            across_m,
            contact,
        })
        .to_vec();
    suspension.lift_tab = Some(LiftTab {
        gap_m: 1e-6,
        contact,
    });
    let mut resolution = default_resolution();
    resolution.tolerance = tolerance;
    let slider = default_slider();
    let model = HeadModel::build(&suspension, &slider, film, flight, &resolution, 0.0);
    let model = model.expect("head builds");
    let pulse = Pulse {
        shape: PulseShape::HalfSine,
        width_s: 5e-4,
    };
    let load = ShockLoad {
        base: None,
        pulse: &pulse,
        amplitude_m_per_s2: 700.0 * G,
    };
    let swinging = MovedPivot {
        disk_m: |_| [0.0; 2],
        // From rest at the onset.
        pivot_m: |time_s| swung(time_s + 1e-4),
        events_s: Vec::new(),
    };
    let mut workspace = HeadWorkspace::new(&model);
    model.run(&swinging, &load, window_s, false, true, &mut workspace)
}

/// Imbalance over the largest energy.
fn imbalance(run: &HeadRun) -> f64 {
    let contact = run.slider_contact.as_ref().expect("rough surfaces");
    let energy = contact.energy.expect("the run goes on");
    energy.imbalance_j.abs() / energy.peak_j
}

/// While a limiter is closed, with the load beam off the slider, and after the first contact with the disk: further contacts depend on
/// the last digits of these.
#[test]
fn the_balance_of_a_head_on_all_its_contacts_closes_with_the_steps() {
    let closed = slapped(1e-4, 2.855e-4);
    let columns = closed.columns.as_ref().expect("recorded");
    assert!(columns.limiter_force_n.last() > Some(&1e-3));
    let apart = slapped(1e-4, 4e-4);
    let after = slapped(1e-5, 5.57e-4);
    assert!(after.lift_tab.expect("there is one").max_force_n > 1e-3);
    let contact = after.slider_contact.as_ref().expect("rough surfaces");
    assert!(!contact.episodes.is_empty() && !contact.goes_on);
    let imbalances = [&closed, &apart, &after].map(imbalance);
    assert!(
        imbalances[..2].iter().all(|&one| one < 2e-4),
        "{imbalances:?}"
    );
    assert!(imbalances[2] < 2e-3, "{imbalances:?}");
}
