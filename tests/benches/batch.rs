//! A batch of 1000 shocks on all cores: what scripts/verify-python compares with the same batch of the Python package.

use opshock_study::batch::{Shock, simulate_all};
use opshock_study::study::{Choice, Ramp, SetArg, Sign, Study};
use opshock_study::sweep::StopFlag;

/// Shocks of a batch.
const SHOCKS: usize = 1000;

fn main() {
    let sets: Vec<SetArg> = ["resolution.preset=coarse"]
        .map(|set| set.parse().expect("a key"))
        .to_vec();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../studies/fig13/study.toml");
    let study = Study::from_path(path.as_ref(), &sets).expect("valid");
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let choice = |amplitude_g| Choice {
        ramp: Some(Ramp::None),
        pulse_ms: Some(2.0),
        sign: Some(Sign::Plus),
        amplitude_g: Some(amplitude_g),
    };
    let shots: Vec<_> = (0..SHOCKS)
        .map(|k| {
            study
                .select(&choice(100.0 + 0.5 * k as f64))
                .expect("a shock")
        })
        .collect();
    let shocks: Vec<Shock> = shots
        .iter()
        .map(|shot| Shock {
            scene: 0,
            amplitude_m_per_s2: shot.amplitude_m_per_s2,
        })
        .collect();
    let plan = study.plan();
    let scenes = [(&shots[0].point.scene, &plan)];
    let answers = simulate_all(&scenes, &shocks, threads, &StopFlag::default());
    let smallest_m = answers.iter().map(|answer| {
        let answer = answer.as_ref().expect("not stopped");
        answer
            .outcome
            .as_ref()
            .expect("built")
            .min_clearance_m
            .expect("a head")
    });
    // The sum is what both must agree on.
    println!("{:e}", smallest_m.sum::<f64>());
}
