//! Uses a ramp model of one's own, beside a rigid ramp: a spring behind each contact point, whose stiffness in N/m a
//! static test of one arm gives, with the mass that moves along.
//!
//! `cargo run --release -p opshock-solver --example own_ramp`

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::ramp::{ContactMode, RampBody, RampModel, RigidRamp};
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{Model, Request, Workspace, simulate};
use std::f64::consts::TAU;

/// Arms that are springs.
struct Springs {
    stiffness_n_per_m: f64,
    mass_kg: f64,
}

impl RampModel for Springs {
    fn name(&self) -> &'static str {
        "springs"
    }

    fn contacts(&self) -> Option<Vec<ContactMode>> {
        let at = |shape| ContactMode {
            frequency_hz: (self.stiffness_n_per_m / self.mass_kg).sqrt() / TAU,
            mass_kg: self.mass_kg,
            shape,
            participation: 1.3,
            damping_ratio: 0.03,
        };
        Some(vec![at([1.0, 0.0]), at([0.0, 1.0])])
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // An arm of polyoxymethylene: 17 N/mm and 12 mg at its contact point, 6 kHz.
    let own = Springs {
        stiffness_n_per_m: 17e3,
        mass_kg: 12e-6,
    };
    let mut scene = Scene::default_drive();
    for (name, ramp) in [("rigid", RampBody::from(RigidRamp)), ("own", own.into())] {
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
