//! Limiters and lift tab of a whole head. Their law by itself, against closed forms: `head::stops` of the
//! solver.

use std::sync::Arc;

use opshock_solver::air_bearing::Film;
use opshock_solver::air_bearing::steady::Flight;
use opshock_solver::head::{Coupling, HeadModel, HeadRun, HeadWorkspace, ShockLoad};
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::suspension::{
    ContactLaw, LiftTab, Limiter, ReducedSuspension, SuspensionError, SuspensionMode,
    SuspensionParameters,
};
use opshock_tests::heads::{StillDisk, default_film, default_resolution, default_slider};
use opshock_tests::suspensions::default_suspension;

const G: f64 = 9.80665;
const PULSE: Pulse = Pulse {
    shape: PulseShape::HalfSine,
    width_s: 5e-4,
};
/// On a disk that stands still: the load beam leaves the slider by a tenth of a millimetre and slaps it onto the
/// disk when it comes back.
const SHOCK_G: f64 = 1000.0;
/// Limiters of the sample drive of the CMLAir 8.01 user manual (Mardan and Bogy, 2011), m.
const GAPS_M: [f64; 2] = [92.4e-6, 92.5e-6];

struct Bench {
    film: Arc<Film>,
    flight: Arc<Flight>,
    coupling: Coupling,
    tolerance: f64,
}

impl Bench {
    fn new() -> Self {
        let (film, flight) = default_film(150);
        Self {
            film,
            flight,
            coupling: Coupling::Monolithic,
            tolerance: 1e-3,
        }
    }

    fn run(&self, suspension: &SuspensionParameters) -> HeadRun {
        let mut resolution = default_resolution();
        resolution.coupling = self.coupling;
        resolution.tolerance = self.tolerance;
        resolution.coupling_tolerance = 0.1 * self.tolerance;
        let (film, flight) = (Arc::clone(&self.film), Arc::clone(&self.flight));
        let slider = default_slider();
        let model = HeadModel::build(suspension, &slider, film, flight, &resolution, 0.0);
        let model = model.expect("head builds");
        let load = ShockLoad {
            base: None,
            pulse: &PULSE,
            amplitude_m_per_s2: SHOCK_G * G,
        };
        let mut workspace = HeadWorkspace::new(&model);
        model.run(&StillDisk, &load, 2.5e-3, true, true, &mut workspace)
    }

    /// Largest opening at the limiters and largest rise of the tab, measured by stops too soft to matter.
    fn openings_m(&self) -> [f64; 2] {
        let soft = ContactLaw {
            stiffness_n_per_m: 1e-9,
            damping_ratio: 0.0,
        };
        let run = self.run(&with([0.0; 2], 0.0, soft));
        [run.limiters, run.lift_tab]
            .map(|record| record.expect("there is one").max_force_n)
            .iter()
            .zip([2e-9, 1e-9])
            .map(|(force, stiffness)| force / stiffness)
            .collect::<Vec<_>>()
            .try_into()
            .expect("two")
    }
}

fn with(limiters_m: [f64; 2], tab_m: f64, contact: ContactLaw) -> SuspensionParameters {
    // In the middle, where roll neither opens nor closes them.
    let limiter = |gap_m: f64| Limiter {
        gap_m,
        along_m: 0.0,
        across_m: 0.0,
        contact,
    };
    SuspensionParameters {
        limiters: limiters_m.map(limiter).to_vec(),
        lift_tab: Some(LiftTab {
            gap_m: tab_m,
            contact,
        }),
        ..default_suspension()
    }
}

const HARD: ContactLaw = ContactLaw {
    stiffness_n_per_m: 1e5,
    damping_ratio: 0.05,
};

/// What is never reached is not there: the same bits, step by step, as without. The tab's attachment mode
/// is part of the suspension, so the suspension with the tab is the other side of its pair.
#[test]
fn a_limiter_out_of_reach_changes_no_bit() {
    let bench = Bench::new();
    let [opening, _] = bench.openings_m();
    assert!(opening > 1e-4, "the dimple opens by {opening:e} m");
    let mut suspension = with([1.01 * opening; 2], 1.0, HARD);
    suspension.lift_tab = None;
    let far = bench.run(&suspension);
    let without = bench.run(&default_suspension());
    assert_eq!(far.limiters.map(|record| record.max_force_n), Some(0.0));
    assert_eq!(without.limiters, None);
    assert_eq!((far.verdict, far.dimple), (without.verdict, without.dimple));
    assert_eq!(far.cost, without.cost);
    let (mut far, without) = (far.columns.unwrap(), without.columns.unwrap());
    assert!(far.limiter_force_n.iter().all(|force| *force == 0.0));
    far.limiter_force_n.clear();
    assert!(far == without);
}

/// Within reach they end the opening: what is left beyond the gaps is force by stiffness.
#[test]
fn limiters_bound_an_opening_dimple() {
    let bench = Bench::new();
    let [opening, _] = bench.openings_m();
    let mut suspension = with(GAPS_M, 1.0, HARD);
    suspension.lift_tab = None;
    let run = bench.run(&suspension);
    let record = run.limiters.expect("there are some");
    // Both closed at the largest force: k (o − g₁) + k (o − g₂).
    let mean = 0.5 * (GAPS_M[0] + GAPS_M[1]);
    let bounded = mean + 0.5 * record.max_force_n / HARD.stiffness_n_per_m;
    println!("opening {opening:.3e} m, bounded {bounded:.3e} m, {record:?}");
    assert!(record.max_force_n > HARD.stiffness_n_per_m * (GAPS_M[1] - GAPS_M[0]));
    assert!(run.dimple.min_force_n == 0.0 && run.dimple.open_s > record.closed_s);
    assert!(opening > 1.2 * mean && bounded < 1.05 * mean, "{bounded:e}");
    // Film and structure in turn, and smaller steps, find the same: the slap comes back at the same time.
    let find = |coupling: Coupling, tolerance: f64| {
        let other = Bench {
            film: Arc::clone(&bench.film),
            flight: Arc::clone(&bench.flight),
            coupling,
            tolerance,
        };
        let run = other.run(&suspension);
        let record = run.limiters.expect("there are some");
        println!(
            "{coupling:?} {tolerance}: {record:?}, slap at {:e}",
            run.end_s
        );
        [record.max_force_n, run.end_s]
    };
    let reference = find(Coupling::Monolithic, 1e-7);
    let error = |found: [f64; 2]| [0, 1].map(|i| (found[i] / reference[i] - 1.0).abs());
    for (coupling, tolerance, allowed) in [
        (Coupling::Monolithic, 1e-3, [0.2, 0.02]),
        (Coupling::Anderson, 1e-3, [0.2, 0.02]),
        (Coupling::Monolithic, 1e-4, [0.05, 0.005]),
        (Coupling::Monolithic, 1e-5, [0.02, 0.003]),
    ] {
        let error = error(find(coupling, tolerance));
        println!("{error:?}");
        assert!(
            error[0] < allowed[0] && error[1] < allowed[1],
            "{coupling:?} {error:?}"
        );
    }
}

/// The tab under its stop ends the rise of the load beam's end.
#[test]
fn a_lift_tab_ends_the_rise_of_the_tip() {
    let bench = Bench::new();
    let [_, rise] = bench.openings_m();
    assert!(rise > 2e-6, "{rise:e}");
    let mut suspension = with([1.0; 2], 0.5 * rise, HARD);
    suspension.limiters.clear();
    let run = bench.run(&suspension);
    let record = run.lift_tab.expect("there is one");
    let bounded = 0.5 * rise + record.max_force_n / HARD.stiffness_n_per_m;
    println!("rise {rise:.3e} m, bounded {bounded:.3e} m, {record:?}");
    assert!(record.max_force_n > 0.0 && run.limiters.is_none());
    assert!(bounded < 0.6 * rise, "{bounded:e} {rise:e}");
}

/// Another program's modes say how the dimple moves, not how the tab does.
#[test]
fn a_lift_tab_needs_a_geometry() {
    let mode = |frequency_hz: f64, vertical: f64, roll: f64| SuspensionMode {
        frequency_hz,
        vertical_per_sqrt_kg: vertical,
        slope_per_m_sqrt_kg: 0.0,
        roll_per_m_sqrt_kg: roll,
        participation_sqrt_kg: 0.0,
    };
    let mut suspension = with([1e-6; 2], 1e-6, HARD);
    suspension.modes = vec![mode(333.0, 700.0, 0.0), mode(4e3, 0.0, 1e6)];
    let built = ReducedSuspension::build(&suspension, 1);
    assert_eq!(built.map(|_| ()), Err(SuspensionError::NoTab));
    suspension.lift_tab = None;
    assert!(ReducedSuspension::build(&suspension, 1).is_ok());
}
