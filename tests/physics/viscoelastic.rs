//! Arms whose stiffness relaxes: against roots and creep in closed form, elastic arms, and their energy.

use nalgebra::Complex;
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{ArmMode, Arms, ContactMode, POM, RampBody, RampModel, Relaxation};
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::structure::{StructureRun, Workspace};
use opshock_study::study::keys;
use opshock_tests::scenes;
use opshock_tests::sheet::at_most;
use opshock_tests::structures::{Structure, s1, s1_arms};
use std::f64::consts::TAU;

/// Elastic modes with a stiffness that relaxes.
#[derive(Clone)]
struct Relaxing {
    elastic: RampBody,
    terms: Vec<Relaxation>,
}

impl RampModel for Relaxing {
    fn name(&self) -> &'static str {
        "relaxing"
    }

    fn contacts(&self) -> Option<Vec<ContactMode>> {
        self.elastic.contacts.clone()
    }

    fn relaxation(&self) -> Vec<Relaxation> {
        self.terms.clone()
    }
}

const TERM: Relaxation = Relaxation {
    share: 0.2,
    time_s: 4e-4,
};

fn run(structure: &Structure, amplitude: f64) -> StructureRun {
    structure
        .build()
        .run(amplitude, true, &mut Workspace::default())
        .unwrap()
}

/// Two equal arms of one mode, a standard linear solid each.
fn one_term(mode: ArmMode) -> Structure {
    let elastic = Arms {
        top: vec![mode],
        bottom: vec![mode],
    };
    let relaxing = Relaxing {
        elastic: elastic.into(),
        terms: vec![TERM],
    };
    s1(1e-3, relaxing)
}

/// τ s³ + (1 + 2ζωτ) s² + (2ζω + ω²τ) s + ω² (1 − g): what (s² + 2ζωs + ω²)(1 + sτ) = ω² g leaves.
fn characteristic(mode: &ArmMode) -> [f64; 4] {
    let (omega, tau) = (TAU * mode.frequency_hz, TERM.time_s);
    let rate = 2.0 * mode.damping_ratio * omega;
    let lasting = omega * omega * (1.0 - TERM.share);
    [tau, 1.0 + rate * tau, rate + omega * omega * tau, lasting]
}

/// Roots of the cubic: the real one by bisection (all coefficients are positive, so it is negative), the pair
/// from what is left.
fn roots([a, b, c, d]: [f64; 4]) -> [Complex<f64>; 3] {
    let (mut low, mut high) = (-b / a, 0.0);
    for _ in 0..200 {
        let s: f64 = 0.5 * (low + high);
        match ((a * s + b) * s + c) * s + d > 0.0 {
            true => high = s,
            false => low = s,
        }
    }
    let real = 0.5 * (low + high);
    let half = -0.5 * (b / a + real);
    let product = -d / (a * real);
    let apart = Complex::from(half * half - product).sqrt();
    [Complex::from(real), half + apart, half - apart]
}

/// After the pulse an arm's motion is a sum of three exponentials, so any four samples at equal distance fulfil a
/// recurrence whose coefficients the roots give: frequency and rate of decay at once.
#[test]
fn free_vibration_decays_at_the_roots_of_the_characteristic_polynomial() {
    for frequency_hz in [300.0, 900.0, 16e3] {
        let mode = ArmMode {
            frequency_hz,
            mass_kg: 5e-5,
            participation: 0.4,
            damping_ratio: 0.0,
        };
        let found = run(&one_term(mode), 10.0 * G);
        assert_eq!(found.first_touch_s, None);
        let columns = found.columns.unwrap();
        // A quarter period, from the end of the pulse.
        let step_s = columns.time_s[1];
        let stride = (0.25 / frequency_hz / step_s).round() as usize;
        let first = (1e-3 / step_s).ceil() as usize + 1;
        let s = roots(characteristic(&mode));
        let [x, y, z] = s.map(|s| (s * (stride as f64 * step_s)).exp());
        let (e1, e2, e3) = (x + y + z, x * y + y * z + z * x, x * y * z);
        let at = &columns.ramp_top_m;
        let largest = at.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let mut worst = 0.0_f64;
        for k in first..at.len() - 3 * stride {
            let [p, q, r, t] = [0, 1, 2, 3].map(|j| at[k + j * stride]);
            worst = worst.max((t - e1.re * r + e2.re * q - e3.re * p).abs());
        }
        at_most(
            "relaxing-arm",
            "error of the recurrence after the pulse, of the largest displacement",
            worst / largest,
            1e-11,
        );
        // Against an elastic arm, or a rate of decay one per mille off, the recurrence fails by far.
        let elastic = 2.0 * (TAU * frequency_hz * stride as f64 * step_s).cos();
        assert!((e1.re - 1.0 - elastic).abs() > 1e-3, "{e1} {elastic}");
    }
}

/// A constant force on an arm much faster than the relaxation: creep J(t) = (1 + g/(1 − g) (1 − e^{−(1−g)t/τ}))/k₀,
/// to the 2ζ/(ωτ) by which damping is late; and the step response of the cubic to rounding.
#[test]
fn a_constant_force_makes_the_arm_creep_as_the_standard_linear_solid() {
    let mode = ArmMode {
        frequency_hz: 2e5,
        mass_kg: 5e-5,
        participation: 0.4,
        damping_ratio: 0.7,
    };
    let mut structure = one_term(mode);
    structure.pulse = Pulse {
        shape: PulseShape::Square,
        width_s: 5e-3,
    };
    let a = 10.0 * G;
    let found = run(&structure, a);
    assert_eq!(found.first_touch_s, None);
    let columns = found.columns.unwrap();
    let (omega, g, tau) = (TAU * mode.frequency_hz, TERM.share, TERM.time_s);
    let [c3, c2, c1, c0] = characteristic(&mode);
    let s = roots([c3, c2, c1, c0]);
    let load = mode.participation * a;
    let late = 2.0 * mode.damping_ratio / (omega * tau);
    for at_s in [2e-5, 1e-4, 4e-4, 1e-3, 3e-3] {
        let k = (at_s / columns.time_s[1]).round() as usize;
        let t = columns.time_s[k];
        let transient: Complex<f64> = s
            .iter()
            .map(|s| {
                let slope = (s * 3.0 * c3 + 2.0 * c2) * s + c1;
                (s * tau + 1.0) / (s * slope) * (s * t).exp()
            })
            .sum();
        let exact = load * (c0.recip() + transient.re);
        let creep =
            load / (omega * omega) * (1.0 + g / (1.0 - g) * (1.0 - (-(1.0 - g) * t / tau).exp()));
        let x = columns.ramp_top_m[k];
        at_most(
            "relaxing-arm",
            "relative error of the creep under a constant force",
            (x / exact - 1.0).abs(),
            1e-9,
        );
        assert!((x / creep - 1.0).abs() < late, "{t}: {x:e} {creep:e}");
    }
    // It has crept by a quarter, g/(1 − g), of what it gave at once.
    let k = (3e-3 / columns.time_s[1]).round() as usize;
    let crept = columns.ramp_top_m[k] * omega * omega / load;
    assert!((crept - 1.25).abs() < 2e-3, "{crept}");
}

fn relaxing(share: f64) -> Relaxing {
    let times = [1e-4, 1e-5, 1e-6];
    Relaxing {
        elastic: s1_arms(),
        terms: times.map(|time_s| Relaxation { share, time_s }).to_vec(),
    }
}

/// Contact above and below the disk, arms that differ in nothing but shares of 1e-12.
#[test]
fn without_shares_the_arms_are_elastic() {
    for (g, width_s) in [(400.0, 2e-3), (200.0, 5e-4)] {
        let [a, b] = [s1_arms(), relaxing(1e-12).into()].map(|ramp| run(&s1(width_s, ramp), g * G));
        assert!(a.top.episodes.len() + a.bottom.episodes.len() > 0);
        assert_eq!(a.top.episodes.len(), b.top.episodes.len());
        let [x, y] = [&a, &b].map(|run| run.columns.as_ref().unwrap());
        for (x, y) in [
            (&x.disk_slider_m, &y.disk_slider_m),
            (&x.ramp_top_m, &y.ramp_top_m),
            (&x.ramp_bottom_m, &y.ramp_bottom_m),
        ] {
            let apart = x.iter().zip(y).map(|(x, y)| (x - y).abs());
            let apart = apart.fold(0.0, f64::max);
            println!("{g} g: {apart:.1e} m apart");
            assert!(apart < 1e-9, "{g} g: {apart:e} m");
        }
    }
}

/// Undamped disk and arms but for what relaxes: energy only falls after the pulse, and the balance closes.
#[test]
fn arms_that_relax_take_energy_and_give_none() {
    for (g, width_s) in [(400.0, 2e-3), (200.0, 5e-4), (-400.0, 2e-3)] {
        let mut ramp = relaxing(0.05);
        for mode in ramp.elastic.contacts.iter_mut().flatten() {
            mode.damping_ratio = 0.0;
        }
        let mut structure = s1(width_s, ramp);
        structure.disk.damping = opshock_solver::disk::DiskDamping::ModalRatio(0.0);
        let found = run(&structure, g * G);
        let energy = &found.energy;
        println!("{g} g: {energy:?}");
        assert!(found.first_touch_s.is_some());
        assert!(
            energy.closure < 1e-9 && energy.algorithmic_j <= 0.0,
            "{energy:?}"
        );
        let columns = found.columns.unwrap();
        let after = columns.time_s.iter().position(|t| *t > width_s).unwrap();
        let h = &columns.energy_h_j[after..];
        let rise = h.windows(2).map(|w| w[1] - w[0]).fold(f64::MIN, f64::max);
        assert!(
            rise < 1e-12 * energy.h_peak_j,
            "{rise:e} {:e}",
            energy.h_peak_j
        );
        // Undamped elastic arms lose nothing.
        assert!(energy.damping_loss_j > 1e-4 * energy.h_peak_j, "{energy:?}");
    }
}

/// Equal arms with a vibrating base under them are one system with it.
#[test]
fn relaxing_arms_on_a_base_close_their_balance_and_tend_to_elastic_ones() {
    let on_base = |ramp: RampBody| {
        let mut structure = s1(2e-3, ramp);
        structure.base = super::base::BASE.to_vec();
        (
            structure.ramp.clearance_top_m,
            structure.ramp.clearance_bottom_m,
        ) = (20e-6, 20e-6);
        run(&structure, 400.0 * G)
    };
    let found = on_base(relaxing(0.05).into());
    let energy = &found.energy;
    println!("{energy:?}");
    assert!(found.first_touch_s.is_some());
    assert!(
        energy.closure < 1e-9 && energy.algorithmic_j <= 0.0,
        "{energy:?}"
    );
    let [a, b] = [s1_arms(), relaxing(1e-12).into()].map(on_base);
    let [x, y] = [&a, &b].map(|run| &run.columns.as_ref().unwrap().ramp_top_m);
    let apart = x.iter().zip(y).map(|(x, y)| (x - y).abs());
    let apart = apart.fold(0.0, f64::max);
    println!("{apart:.1e} m apart");
    assert!(apart < 1e-9, "{apart:e} m");
}

/// Moreau and Jean's steps know nothing of the impact law of the production scheme.
#[test]
fn relaxing_arms_agree_with_the_other_contact_method() {
    let base = s1(2e-3, relaxing(0.05)).with_cut(20e3);
    let exact = run(&base.with_step(0.125e-6), 400.0 * G);
    let mut errors = Vec::new();
    for step_s in [0.5e-6, 0.125e-6] {
        let other = run(&base.with_step(step_s).with_moreau_jean(), 400.0 * G);
        errors.push((other.disk.slider_max_m - exact.disk.slider_max_m).abs());
        let impulse = other.top.impulse_n_s / exact.top.impulse_n_s - 1.0;
        assert!(impulse.abs() < 0.05, "{step_s:e}: {impulse:e}");
    }
    println!("{errors:?}");
    assert!(errors[1] < 0.1e-6, "{errors:?}");
}

/// The series that the table of keys shows is that for polyoxymethylene, with the loss factors it names.
#[test]
fn a_study_gives_its_ramp_a_series() {
    let text = keys::find("ramp.deformable.prony").unwrap().example();
    let scene = scenes::scene(
        "fig13-stiffness",
        "deformable",
        0.5,
        &[("ramp.deformable.prony", text)],
    );
    let elastic = scenes::scene("fig13-stiffness", "deformable", 0.5, &[]);
    let ramp = &scene.ramp.model;
    assert_eq!(
        (ramp.model, ramp.contacts.clone()),
        ("viscoelastic", elastic.ramp.model.contacts)
    );
    for (found, wanted) in ramp.relaxation.iter().zip(&POM) {
        assert_eq!(found.share, wanted.share);
        assert!((found.time_s / wanted.time_s - 1.0).abs() < 1e-12);
    }
    assert_eq!(ramp.relaxation.len(), POM.len());
    let modulus = |hz: f64| {
        let of = |term: &Relaxation| term.share / Complex::new(1.0, TAU * hz * term.time_s);
        Complex::from(1.0) - POM.iter().map(of).sum::<Complex<f64>>()
    };
    for (hz, loss_factor) in [(1e3, 0.0124), (1e4, 0.0213), (1e5, 0.0285)] {
        let e = modulus(hz);
        assert!((e.im / e.re - loss_factor).abs() < 5e-5, "{hz}: {e}");
    }
    assert!((modulus(1e3).re.recip() - 1.104).abs() < 5e-4);
    // No series that keeps no stiffness.
    let mut all = scene.ramp.clone();
    all.model.relaxation[0].share = 0.92;
    assert!(all.validate().is_err());
}
