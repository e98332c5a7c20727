//! Finds the critical shock of both signs, without a ramp and with a rigid one.
//!
//! `cargo run --release -p opshock-solver --example critical_shock`

use opshock_solver::quantity::{STANDARD_GRAVITY_M_PER_S2, m_per_s2_from_g};
use opshock_solver::ramp::{NoRamp, RampBody, RigidRamp};
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{Model, Workspace, critical_shock};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = Scene::default_drive();
    for (name, ramp) in [
        ("no ramp", RampBody::from(NoRamp)),
        ("rigid ramp", RigidRamp.into()),
    ] {
        scene.ramp.model = ramp;
        let model = Model::new(&scene)?;
        for sign in [1.0, -1.0] {
            let range = [20.0, 2000.0].map(|g| sign * m_per_s2_from_g(g));
            let found = critical_shock(&model, range, 0.01, &mut Workspace::default())?;
            let [survives_g, fails_g] = [found.survives_m_per_s2, found.fails_m_per_s2]
                .map(|amplitude| amplitude / STANDARD_GRAVITY_M_PER_S2);
            println!(
                "{name}: survives {survives_g:.1} G, fails at {fails_g:.1} G ({} shocks)",
                found.n_runs
            );
        }
    }
    Ok(())
}
