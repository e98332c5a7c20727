//! A drive whose masses, and with them all forces, moduli and pressures, are other powers of two moves the same: no tolerance
//! or limit of the program is a mass, force, energy or pressure of its own.

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::scene::plan::{Mode, Output, Plan};
use opshock_solver::simulation::{Model, Outcome, Request, Workspace, simulate};
use opshock_tests::scenes;

/// The scene with every quantity that has a mass in its unit times `factor`; a stiffness or density left out would change
/// the motion.
fn heavier(scene: &Scene, factor: f64) -> Scene {
    let mut scaled = scene.clone();
    let Scene {
        disk,
        ramp,
        slider,
        suspension,
        gas,
        ..
    } = &mut scaled;
    let mut all = vec![
        &mut disk.youngs_modulus_pa,
        &mut disk.density_kg_per_m3,
        &mut slider.density_kg_per_m3,
        &mut suspension.gram_load_n,
        &mut suspension.youngs_modulus_pa,
        &mut suspension.shear_modulus_pa,
        &mut suspension.density_kg_per_m3,
        &mut suspension.flexure.mass_kg,
        &mut suspension.gimbal.vertical_n_per_m,
        &mut suspension.gimbal.pitch_n_m_per_rad,
        &mut suspension.gimbal.roll_n_m_per_rad,
        &mut suspension.gimbal.dimple_preload_n,
        &mut suspension.dimple.stiffness_n_per_m,
        &mut gas.pressure_pa,
        &mut gas.viscosity_pa_s,
    ];
    all.extend(ramp.contact_stiffness_n_per_m.as_mut());
    for mode in ramp.model.contacts.iter_mut().flatten() {
        all.push(&mut mode.mass_kg);
    }
    for quantity in all {
        *quantity *= factor;
    }
    scaled
}

fn run(scene: &Scene, amplitude_g: f64) -> Outcome {
    let plan = Plan::new(&[Output::CriticalShock], Mode::Auto);
    let model = Model::assemble(scene, &plan, None).expect("the scene builds");
    let request = Request {
        amplitude_m_per_s2: m_per_s2_from_g(amplitude_g),
        record: false,
    };
    simulate(&model, &request, &mut Workspace::default())
}

#[test]
fn a_drive_of_other_masses_and_forces_moves_the_same() {
    // Below and above first touch, and beyond the critical shock.
    for (ramp, amplitudes_g) in [
        ("none", [-180.0, 300.0, 600.0]),
        ("rigid", [-150.0, 215.0, 600.0]),
        ("deformable", [-150.0, 250.0, 600.0]),
    ] {
        let sets = [
            ("resolution.preset", "\"coarse\""),
            ("pulse.window_ms", "2.0"),
        ];
        // With a ramp of finite contact stiffness.
        let scene = scenes::scene("fig13-stiffness", ramp, 1.0, &sets);
        assert!(scene.suspension.limiters.is_empty() && scene.suspension.lift_tab.is_none());
        for (place, amplitude_g) in amplitudes_g.into_iter().enumerate() {
            let own = run(&scene, amplitude_g);
            let own_m = own.min_clearance_m.expect("a clearance");
            let own_s = own.t_min_clearance_s.expect("a time");
            let touches = own.top.impulse_n_s + own.bottom.impulse_n_s > 0.0;
            assert_eq!(
                (own_m > 0.0, touches),
                (place < 2, ramp != "none" && place > 0)
            );
            for power in [-6.0_f64, 11.0] {
                let scaled = run(&heavier(&scene, power.exp2()), amplitude_g);
                let what = format!("{ramp}, {amplitude_g} G, masses times 2^{power}");
                let scaled_m = scaled.min_clearance_m.expect("a clearance");
                let scaled_s = scaled.t_min_clearance_s.expect("a time");
                println!(
                    "{what}: {own_m:.6e} m, {own_s:.6e} s; {scaled_m:.6e} m, {scaled_s:.6e} s"
                );
                assert_eq!(
                    scaled.verdict.as_ref().map(std::mem::discriminant),
                    own.verdict.as_ref().map(std::mem::discriminant),
                    "{what}"
                );
                assert_eq!(scaled.cost.steps, own.cost.steps, "{what}");
                assert_eq!(scaled.cost.film_solves, own.cost.film_solves, "{what}");
                // In units of the flying height: the clearance at which a failing run ends is zero.
                assert!((scaled_m - own_m).abs() < 1e-8 * 9e-9, "{what}");
                // At a flat minimum the time is known to the root of that.
                assert!((scaled_s / own_s - 1.0).abs() < 1e-5, "{what}");
            }
        }
    }
}
