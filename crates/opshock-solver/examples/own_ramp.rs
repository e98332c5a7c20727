//! A ramp of one's own: arms by a mode each, as a measurement of one arm would give them, against a rigid ramp.
//!
//! `cargo run --release -p opshock-solver --example own_ramp`

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::ramp::{ArmMode, RampModel};
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{Model, Request, Workspace, simulate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // An arm of polyoxymethylene: 6 kHz on its body, 12 mg at its contact point.
    let arm = vec![ArmMode {
        frequency_hz: 6e3,
        mass_kg: 12e-6,
        participation: 1.3,
        damping_ratio: 0.03,
    }];
    let flexible = RampModel::Deformable {
        top: arm.clone(),
        bottom: arm,
    };
    let mut scene = Scene::default_drive();
    for (name, ramp) in [("rigid", RampModel::Rigid), ("own", flexible)] {
        scene.ramp.model = ramp;
        let model = Model::new(&scene)?;
        let request = Request {
            amplitude_m_per_s2: m_per_s2_from_g(250.0),
            record: false,
        };
        let outcome = simulate(&model, &request, &mut Workspace::default());
        println!(
            "{name} ramp: {} contacts with the top arm, {:.2} mN s in all",
            outcome.top.episodes.len(),
            1e3 * outcome.top.impulse_n_s
        );
    }
    Ok(())
}
