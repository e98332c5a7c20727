//! Tests of the searches against laws of failure whose answers are known.

mod campaigns;
mod clearances;
mod points;

use super::campaign::{Campaign, Touch};
use super::order::Coordinates;
use super::probe::{Probe, Verdict};
use super::settings::{MonotonicityScan, SearchSettings};

fn settings() -> SearchSettings {
    SearchSettings::new((20.0, 2000.0), 0.01, MonotonicityScan::Sampled, 0.10, true)
        .expect("settings")
}

fn fails() -> Verdict {
    Verdict::Fails {
        t_fail_s: 1e-3,
        x_m: 0.0,
        y_m: 0.0,
    }
}

/// Searches all points by a law of point, probe and amplitude in G, which gives the verdict and the smallest clearance, m.
/// Served is always the point that `choose` picks among those with a request.
fn searched(
    points: &[Coordinates],
    touch: impl Fn(&Coordinates) -> Touch,
    law: impl Fn(&Coordinates, Probe, f64) -> (Verdict, Option<f64>),
    mut choose: impl FnMut(usize) -> usize,
) -> Campaign {
    let settings = settings();
    let mut campaign = Campaign::new(settings, points);
    for (point, at) in points.iter().enumerate() {
        campaign.set_touch(point, touch(at));
    }
    while !campaign.is_done() {
        let asking: Vec<usize> = (0..points.len())
            .filter(|&point| campaign.ask(point).is_some())
            .collect();
        assert!(!asking.is_empty(), "nobody asks and nothing is final");
        let point = asking[choose(asking.len())];
        let probe = campaign.ask(point).expect("asks").probe;
        let amplitude_g = settings.grid.amplitude_g(probe.index);
        let (verdict, h_min_m) = law(&points[point], probe, amplitude_g);
        campaign.report_margin(point, &verdict, h_min_m);
    }
    campaign
}
