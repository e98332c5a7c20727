//! Audit of a store: a reproducible sample of finished simulations is run again with the full model.

use rayon::prelude::*;

use super::guard;
use super::input::SweepInput;
use super::simulator::Simulator;
use crate::provenance;
use crate::search::{Probe, ProbeResult, Purpose, Retry, Verdict};
use crate::store::audit::{Audit, Difference};
use crate::store::{Results, RunKey, RunRow};

/// Runs `share` (0 to 1, at least one run) of the simulations behind the answers of `results`
/// again on `simulator` and compares every number of each bit by bit.
///
/// The sample is those with the smallest digests: the same for the same simulations, whatever the
/// threads, and no choice of anybody.
pub fn audit(
    input: &SweepInput,
    results: &Results,
    simulator: &dyn Simulator,
    share: f64,
    threads: usize,
) -> Audit {
    let mut rows: Vec<&RunRow> = results.runs.iter().collect();
    rows.sort_by_cached_key(|row| drawn(&row.run.key));
    rows.dedup_by_key(|row| row.run.key);
    let of_runs = rows.len();
    let n = (share * of_runs as f64).ceil() as usize;
    rows.truncate(n.clamp(1, of_runs.max(1)));
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.max(1))
        .build()
        .expect("threads can be started");
    let again = |row: &&RunRow| compare(input, row, simulator);
    let differences: Vec<Vec<Difference>> = pool.install(|| rows.par_iter().map(again).collect());
    Audit {
        study_digest: input.texts.digest.clone(),
        program_version: provenance::VERSION.to_owned(),
        commit: provenance::COMMIT.to_owned(),
        share,
        of_runs,
        runs: rows.len(),
        differences: differences.concat(),
    }
}

/// Sorting key of a simulation in the sample.
fn drawn(key: &RunKey) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(b"opshock audit 1");
    hasher.update(&key.point.0);
    hasher.update(&key.amplitude_bits.to_le_bytes());
    hasher.update(&[key.window_factor, key.retry]);
    *hasher.finalize().as_bytes()
}

fn compare(input: &SweepInput, row: &RunRow, simulator: &dyn Simulator) -> Vec<Difference> {
    let key = row.run.key;
    let probe = Probe {
        index: row.index,
        is_fine: row.purpose == Purpose::Uncertainty,
        levels: row.levels,
        window_factor: key.window_factor,
        retry: Retry::from_place(key.retry).unwrap_or_default(),
    };
    let amplitude = f64::from_bits(key.amplitude_bits);
    let full = guard::simulate(simulator, row.point, probe, amplitude);
    let point = &input.points[row.point].coordinates;
    let label = format!(
        "{} {} ms {}",
        point.ramp,
        point.pulse_ms,
        point.sign.as_str()
    );
    quantities(row.result())
        .into_iter()
        .zip(quantities(&full))
        .filter(|(stored, full)| stored != full)
        .map(|((quantity, stored), (_, full))| Difference {
            point: label.clone(),
            amplitude_g: row.amplitude_g,
            quantity: quantity.to_owned(),
            stored,
            full,
        })
        .collect()
}

/// Every number of an answer but the work, written so that different bits give different text.
fn quantities(result: &ProbeResult) -> [(&'static str, String); 6] {
    let number = |value: Option<f64>| value.map_or("none".to_owned(), |v| format!("{v:e}"));
    let (verdict, [t, x, y]) = match &result.verdict {
        Verdict::Survives => ("survives".to_owned(), [None; 3]),
        Verdict::Fails { t_fail_s, x_m, y_m } => (
            "fails".to_owned(),
            [Some(*t_fail_s), Some(*x_m), Some(*y_m)],
        ),
        Verdict::Undecided { message, .. } => (format!("undecided ({message})"), [None; 3]),
    };
    [
        ("verdict", verdict),
        ("t_fail_s", number(t)),
        ("x_m", number(x)),
        ("y_m", number(y)),
        ("h_min_m", number(result.h_min_m)),
        ("t_min_s", number(result.t_min_s)),
    ]
}
