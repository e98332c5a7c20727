//! Tests of the searches against laws of failure whose answers are known.

mod campaigns;
mod clearances;
mod points;

use super::probe::Verdict;
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
