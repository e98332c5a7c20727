//! Energy balance of slider and suspension, with every contact and load that it counts.

use std::f64::consts::TAU;

use opshock_solver::disk::{DiskMotion, DiskPose};
use opshock_solver::head::{HeadEnergy, HeadModel, HeadRun, HeadWorkspace, ShockLoad};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::suspension::{ContactLaw, LiftTab, Limiter};
use opshock_tests::heads::{default_resolution, default_slider, rough_film};
use opshock_tests::rough::ROUGH;
use opshock_tests::suspensions::default_suspension;

/// A disk at rest under a suspension whose pivot swings by 3 um.
struct Swinging;

impl DiskMotion for Swinging {
    fn pose(&self, _: f64) -> DiskPose {
        DiskPose::default()
    }
    fn pose_rate(&self, _: f64) -> DiskPose {
        DiskPose::default()
    }
    fn events_s(&self) -> &[f64] {
        &[]
    }
    fn pivot(&self, time_s: f64) -> [f64; 2] {
        let omega = TAU / 2.5e-4;
        let (sine, cosine) = (omega * time_s).sin_cos();
        [1.5e-6 * (1.0 - cosine), 1.5e-6 * omega * sine]
    }
}

/// A shock that lifts the load beam onto limiters and lift tab, and ends on the disk.
fn slapped(tolerance: f64) -> HeadRun {
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
        gap_m: 2e-5,
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
    let mut workspace = HeadWorkspace::new(&model);
    model.run(&Swinging, &load, 1e-3, false, false, &mut workspace)
}

#[test]
fn the_balance_of_a_head_on_all_its_contacts_closes_with_the_steps() {
    let open = [1e-3, 1e-4].map(|tolerance| {
        let run = slapped(tolerance);
        let touches = [run.limiters, run.lift_tab].map(|stop| stop.expect("there").max_force_n);
        assert!(touches.iter().all(|&force_n| force_n > 0.0), "{touches:?}");
        let contact = run.slider_contact.expect("rough surfaces");
        assert!(!contact.episodes.is_empty());
        let energy: HeadEnergy = contact.energy.expect("the run goes on");
        energy.open_j.abs() / energy.peak_j
    });
    // The pivot's work alone is 4 % of the largest energy.
    assert!(open[0] < 2e-2 && open[1] < 5e-3, "{open:?}");
}
