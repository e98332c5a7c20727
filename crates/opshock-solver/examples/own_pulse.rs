//! Compares a pulse from samples, a sawtooth, with a half-sine of the same peak and width.
//!
//! `cargo run --release -p opshock-solver --example own_pulse`

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::shock::PulseShape;
use opshock_solver::simulation::{Model, Request, Workspace, simulate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = Scene::default_drive();
    let sawtooth = PulseShape::Table {
        time_s: vec![0.0, 0.95e-3, 1e-3],
        relative: vec![0.0, 1.0, 0.0],
    };
    for (name, shape) in [("half-sine", PulseShape::HalfSine), ("sawtooth", sawtooth)] {
        scene.pulse.shape = shape;
        let model = Model::new(&scene)?;
        let request = Request {
            amplitude_m_per_s2: m_per_s2_from_g(200.0),
            record: false,
        };
        let outcome = simulate(&model, &request, &mut Workspace::default());
        let clearance_m = outcome.min_clearance_m.ok_or("the model has a head")?;
        println!("{name}: smallest clearance {:.3} nm", 1e9 * clearance_m);
    }
    Ok(())
}
