//! Runs one shock: does the slider touch the disk, and when?
//!
//! `cargo run --release -p opshock-solver --example one_shock -- 400 2` (peak in g, width in ms)

use opshock_solver::quantity::m_per_s2_from_g;
use opshock_solver::scene::Scene;
use opshock_solver::simulation::{Model, Request, Verdict, Workspace, simulate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let numbers: Vec<f64> = std::env::args()
        .skip(1)
        .map(|text| text.parse())
        .collect::<Result<_, _>>()?;
    let &[peak_g, width_ms] = numbers.as_slice() else {
        return Err("peak in g and width in ms are wanted, as 400 2".into());
    };
    let mut scene = Scene::default_drive();
    scene.pulse.width_s = 1e-3 * width_ms;

    let model = Model::new(&scene)?;
    let request = Request {
        amplitude_m_per_s2: m_per_s2_from_g(peak_g),
        record: true,
    };
    let outcome = simulate(&model, &request, &mut Workspace::default());

    match &outcome.verdict {
        Some(Verdict::Survives) => println!("survives"),
        Some(Verdict::Fails { t_fail_s, .. }) => {
            println!("touches {:.4} ms after the onset", 1e3 * t_fail_s)
        }
        Some(Verdict::Undecided { cause }) => println!("no answer: {cause}"),
        None => println!("no head was simulated"),
    }
    if let Some(clearance_m) = outcome.min_clearance_m {
        println!("smallest clearance {:.3} nm", 1e9 * clearance_m);
    }
    println!("contacts with the top arm: {}", outcome.top.episodes.len());
    let history = outcome.history.ok_or("a history was asked for")?;
    println!(
        "{} times of disk and ramp kept",
        history.structure.time_s.len()
    );
    Ok(())
}
