//! Random disks, ramps and pulses: energy, signs and complementarity of every run, and relations
//! between runs that must hold exactly or to rounding.

use opshock_solver::disk::{DiskDamping, DiskResolution};
use opshock_solver::quantity::STANDARD_GRAVITY_M_PER_S2 as G;
use opshock_solver::ramp::{ArmMode, Arms, RigidRamp};
use opshock_solver::shock::{Pulse, PulseShape};
use opshock_solver::structure::{StructureRun, StructureWarning, Window, Workspace};
use opshock_tests::seeded::{OnPanic, Seeded, seeds};
use opshock_tests::structures::{Structure, paper};

/// A scene and its amplitude, m/s2.
fn random(seeded: &mut Seeded) -> (Structure, f64) {
    let mut s = paper(seeded.log_between(1e-4, 1.2e-3), RigidRamp);
    let disk = &mut s.disk;
    disk.inner_radius_m = seeded.between(0.006, 0.014);
    disk.thickness_m *= seeded.log_between(0.6, 2.0);
    disk.youngs_modulus_pa *= seeded.log_between(0.5, 2.0);
    disk.poisson = seeded.between(0.1, 0.45);
    disk.density_kg_per_m3 *= seeded.log_between(0.5, 2.0);
    disk.spin_rad_per_s *= seeded.between(-2.0, 2.0);
    disk.damping = match seeded.below(3) {
        0 => DiskDamping::ModalRatio(0.0),
        1 => DiskDamping::ModalRatio(seeded.between(0.0, 0.05)),
        _ => DiskDamping::Rayleigh {
            alpha_per_s: seeded.between(0.0, 200.0),
            beta_s: seeded.between(0.0, 3e-7),
        },
    };
    s.disk_resolution = DiskResolution {
        n_harmonics: 1 + seeded.below(10),
        cut_hz: seeded.log_between(2e3, 15e3),
        n_elements: 6 + seeded.below(8),
        static_correction: seeded.once_in(2),
    };
    let mut arm = |damped: bool| -> Vec<ArmMode> {
        (0..1 + seeded.below(3))
            .map(|_| ArmMode {
                frequency_hz: seeded.log_between(200.0, 2e4),
                mass_kg: seeded.log_between(1e-7, 1e-2),
                participation: seeded.between(0.0, 1.0),
                damping_ratio: if damped {
                    seeded.between(0.0, 0.1)
                } else {
                    0.0
                },
            })
            .collect()
    };
    let (top, bottom) = (arm(true), arm(true));
    s.ramp.model = match seeded.below(4) {
        0 => RigidRamp.into(),
        1 => Arms {
            top: top.clone(),
            bottom: top,
        }
        .into(),
        _ => Arms { top, bottom }.into(),
    };
    let gap = |seeded: &mut Seeded| match seeded.below(8) {
        0 => 0.0,
        _ => seeded.log_between(1e-7, 1e-4),
    };
    s.ramp.clearance_top_m = gap(seeded);
    s.ramp.clearance_bottom_m = gap(seeded);
    s.ramp.restitution = *seeded.one_of(&[0.0, 0.0, 0.3, 0.8, 1.0]);
    s.ramp.radius_m = seeded.between(0.025, 0.0325);
    s.ramp.angle_rad = seeded.between(-3.0, 3.0);
    s.slider.radius_m = seeded.between(0.016, 0.03);
    s.slider.angle_rad = seeded.between(-3.0, 3.0);
    s.slider.skew_rad = seeded.between(-0.3, 0.3);
    s.pulse = Pulse {
        shape: seeded
            .one_of(&[
                PulseShape::HalfSine,
                PulseShape::Haversine,
                PulseShape::Square,
                PulseShape::Trapezoid { rise_share: 0.2 },
            ])
            .clone(),
        width_s: s.pulse.width_s,
    };
    s.window = Window::Fixed {
        length_s: seeded.between(3e-4, 1.5e-3),
    };
    s.resolution.step_s = seeded.log_between(0.5e-6, 4e-6);
    let sign = if seeded.once_in(2) { 1.0 } else { -1.0 };
    (s, sign * seeded.log_between(1.0, 2000.0) * G)
}

/// Depth at which a run warns, m.
const WARNED_M: f64 = 1e-7;

/// Twice the largest motion of disk and arms in a step, m: time nodes see half of a swing.
fn motion_m(run: &StructureRun) -> f64 {
    let columns = run.columns.as_ref().expect("recorded");
    let most = |column: &[f64]| {
        let steps = column.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        steps.fold(0.0, f64::max)
    };
    let arms = most(&columns.ramp_top_m).max(most(&columns.ramp_bottom_m));
    2.0 * (most(&columns.disk_ramp_m) + arms)
}

/// No deeper than disk and arms move towards each other in a step, and what a run warns of. Beyond
/// that (energy forbids to give back at once what swings on between nodes) the depth must be the
/// step's: a warned run at an eighth of the step sinks a third as deep at most.
fn judge_depth(run_at: impl Fn(f64) -> StructureRun, plain: &StructureRun) {
    let depth = plain.complementarity.max_penetration_m;
    if depth <= motion_m(plain) + WARNED_M {
        return;
    }
    let warns = |w: &StructureWarning| matches!(w, StructureWarning::Penetration { .. });
    assert!(
        plain.warnings.iter().any(warns),
        "{depth:e} m and no warning"
    );
    let finer = run_at(0.125).complementarity.max_penetration_m;
    assert!(
        finer <= depth / 3.0,
        "{depth:e} m, at an eighth of the step {finer:e} m"
    );
}

fn run(structure: &Structure, amplitude: f64, workspace: &mut Workspace) -> StructureRun {
    structure
        .build()
        .run(amplitude, true, workspace)
        .expect("a run")
}

/// What must hold of any run.
fn judge(run: &StructureRun) {
    let (e, c) = (&run.energy, &run.complementarity);
    let columns = run.columns.as_ref().expect("recorded");
    let all_finite = [
        &columns.disk_slider_m,
        &columns.disk_ramp_m,
        &columns.disk_pitch_rad,
        &columns.disk_roll_rad,
        &columns.ramp_top_m,
        &columns.ramp_bottom_m,
        &columns.contact_top_n,
        &columns.contact_bottom_n,
        &columns.energy_h_j,
    ]
    .iter()
    .all(|column| column.iter().all(|value| value.is_finite()));
    assert!(all_finite, "a number that is none");
    assert!(e.closure < 1e-9, "closure {:e}", e.closure);
    let rounding = 1e-13 * e.h_peak_j;
    assert!(
        e.algorithmic_j <= rounding,
        "the scheme feeds energy: {e:?}"
    );
    assert!(e.impact_loss_j >= -rounding, "{e:?}");
    assert!(c.min_multiplier_n_s >= 0.0, "{c:?}");
    let reach = motion_m(run) + c.max_penetration_m;
    let impulse = run.top.impulse_n_s + run.bottom.impulse_n_s;
    assert!(c.max_product_n_s_m <= impulse * reach, "{c:?}");
}

fn slider_distance(a: &StructureRun, b: &StructureRun) -> f64 {
    let (a, b) = (
        a.columns.as_ref().expect("recorded"),
        b.columns.as_ref().expect("recorded"),
    );
    assert_eq!(a.disk_slider_m.len(), b.disk_slider_m.len());
    let pairs = a.disk_slider_m.iter().zip(&b.disk_slider_m);
    pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

/// Other side up: gaps and arms exchanged, the shock of the other sign. Bit by bit.
fn mirrored(structure: &Structure) -> Structure {
    let mut other = structure.clone();
    let ramp = &mut other.ramp;
    std::mem::swap(&mut ramp.clearance_top_m, &mut ramp.clearance_bottom_m);
    ramp.model = ramp.model.mirrored();
    other
}

/// Every density, modulus and mass times four: the same motion, forces times four.
fn heavier(structure: &Structure) -> Structure {
    let mut other = structure.clone();
    other.disk.density_kg_per_m3 *= 4.0;
    other.disk.youngs_modulus_pa *= 4.0;
    for mode in other.ramp.model.contacts.iter_mut().flatten() {
        mode.mass_kg *= 4.0;
    }
    other
}

/// One scene; every third has a relation checked too. Returns whether there was contact.
fn one(seed: u64, workspace: &mut Workspace) -> bool {
    let _named = OnPanic(seed);
    let mut seeded = Seeded::new(seed);
    let (structure, amplitude) = random(&mut seeded);
    let plain = run(&structure, amplitude, workspace);
    judge(&plain);
    let finer = |share: f64| {
        let mut finer = structure.clone();
        finer.resolution.step_s *= share;
        run(&finer, amplitude, &mut Workspace::default())
    };
    judge_depth(finer, &plain);
    let touched = plain.first_touch_s.is_some();
    let travel = plain.disk.slider_max_m.max(-plain.disk.slider_min_m);
    match seed % 12 {
        0 => {
            let other = run(&mirrored(&structure), -amplitude, workspace);
            assert_eq!(plain.top, other.bottom);
            assert_eq!(plain.bottom, other.top);
            for (a, b) in plain.history.nodes().iter().zip(other.history.nodes()) {
                assert_eq!(a.displacement_m, -b.displacement_m);
                assert_eq!(a.pitch_rad, -b.pitch_rad);
                assert_eq!(a.roll_rad, -b.roll_rad);
            }
        }
        3 => {
            // Where angles are counted from does not matter, but to rounding before contact; in
            // contact rounding grows with every impact.
            let mut other = structure.clone();
            let turn = seeded.between(-3.0, 3.0);
            other.ramp.angle_rad += turn;
            other.slider.angle_rad += turn;
            let other = run(&other, amplitude, workspace);
            judge(&other);
            let bound = if touched { 1e-6 } else { 1e-12 };
            let apart = slider_distance(&plain, &other);
            assert!(apart <= bound * travel, "turned: {apart:e} of {travel:e}");
        }
        6 => {
            let other = run(&heavier(&structure), amplitude, workspace);
            let apart = slider_distance(&plain, &other);
            let bound = if touched { 1e-6 } else { 1e-12 };
            assert!(apart <= bound * travel, "heavier: {apart:e} of {travel:e}");
        }
        9 => {
            // Twice the shock through twice the gaps is twice the motion, bit by bit up to the
            // first touch; that is found within a tolerance which does not scale.
            let mut other = structure.clone();
            other.ramp.clearance_top_m *= 2.0;
            other.ramp.clearance_bottom_m *= 2.0;
            let other = run(&other, 2.0 * amplitude, workspace);
            let at = |run: &StructureRun| run.first_touch_s.unwrap_or(f64::MAX);
            let apart = (at(&plain) - at(&other)).abs();
            assert!(apart < 1e-9, "twice: first touch {apart:e} s apart");
            let step = plain.history.step_s();
            let before = (at(&plain) / step).min(plain.history.nodes().len() as f64) as usize;
            let (a, b) = (plain.history.nodes(), other.history.nodes());
            for (a, b) in a[..before].iter().zip(b) {
                assert_eq!(2.0 * a.displacement_m, b.displacement_m);
            }
        }
        _ => {}
    }
    touched
}

#[test]
fn random_structures_keep_energy_signs_and_symmetries() {
    let mut workspace = Workspace::default();
    let touched = (0..48).filter(|&seed| one(seed, &mut workspace)).count();
    assert!((10..48).contains(&touched), "{touched} of 48 touch");
}

#[test]
#[ignore = "slow: 10000 scenes, 2 to 10 minutes"]
fn scenes_slow_structures() {
    let mut workspace = Workspace::default();
    let range = seeds(0..10_000);
    let mut touched = 0;
    for seed in range.clone() {
        touched += u64::from(one(seed, &mut workspace));
        let done = seed + 1 - range.start;
        if done.is_multiple_of(500) || seed + 1 == range.end {
            println!(
                "structures: {done} scenes from seed {} hold, {touched} with contact",
                range.start
            );
        }
    }
}
