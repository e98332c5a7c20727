//! Histories kept beside the results: `histories/RAMP_WIDTHms_SIGN_AMPLITUDEg_DIGEST.h5`.
//!
//! Simulations of the search record nothing. When every point has its answer, those whose
//! histories are kept run once more with recording; the answer is the same to the bit. The name
//! carries the amplitude and the content of the point, so a file that is there is the right one.

use std::path::{Path, PathBuf};

use super::input::SweepInput;
use super::ledger::Ledger;
use super::simulator::Simulator;
use crate::provenance;
use crate::search::{Probe, Retry};
use crate::store::RunKey;
use crate::store::history::{HistoryHeader, write_hdf5};
use crate::study::KeepHistories;

/// A history to record.
#[derive(Clone, Debug)]
pub(super) struct Wanted {
    point: usize,
    probe: Probe,
    amplitude_m_per_s2: f64,
    amplitude_g: f64,
    path: PathBuf,
}

/// Histories of final points that are not in `folder` yet.
pub(super) fn wanted(input: &SweepInput, ledger: &Ledger<'_>, folder: &Path) -> Vec<Wanted> {
    let mut wanted = Vec::new();
    for point in (0..input.points.len()).filter(|&point| ledger.wants(point)) {
        for probe in probes(input, ledger, point) {
            let key = ledger.key(point, probe);
            let amplitude_g = input.settings.lattice.amplitude_g(probe.index);
            let path = folder
                .join("histories")
                .join(name(input, point, amplitude_g, &key));
            if !path.exists() {
                wanted.push(Wanted {
                    point,
                    probe,
                    amplitude_m_per_s2: ledger.amplitude_m_per_s2(point, probe),
                    amplitude_g,
                    path,
                });
            }
        }
    }
    wanted
}

/// Probes of a point whose histories are kept.
fn probes(input: &SweepInput, ledger: &Ledger<'_>, point: usize) -> Vec<Probe> {
    let Some(search) = ledger.campaign().search(point) else {
        return Vec::new();
    };
    if !ledger.campaign().is_final(point) {
        return Vec::new();
    }
    let findings = ledger.campaign().findings(point);
    let told = search.log().iter().map(|asked| asked.probe);
    match input.keep_histories {
        KeepHistories::None => Vec::new(),
        KeepHistories::All => told.collect(),
        KeepHistories::Bracket => {
            let ends = [findings.survivor, findings.failure];
            let is_end =
                |probe: &Probe| probe.window_factor == 1 && ends.contains(&Some(probe.index));
            // A node decided on a retry keeps that run, which is its last.
            let mut kept: Vec<Probe> = Vec::new();
            for probe in told.filter(is_end) {
                kept.retain(|other| other.index != probe.index);
                kept.push(probe);
            }
            kept
        }
    }
}

fn name(input: &SweepInput, point: usize, amplitude_g: f64, key: &RunKey) -> String {
    let at = &input.points[point].coordinates;
    let mut labels = String::new();
    if key.window_factor != 1 {
        labels += "_window";
    }
    if let Some(retry) = Retry::from_level(key.retry).filter(|&retry| retry != Retry::None) {
        labels += "_";
        labels += &retry.label().replace('/', "_");
    }
    format!(
        "{}_{}ms_{}_{amplitude_g:.3}g{labels}_{}.h5",
        at.ramp,
        at.pulse_ms,
        if at.sign.factor() > 0.0 {
            "plus"
        } else {
            "minus"
        },
        &key.point.hex()[..12]
    )
}

/// Records one history.
///
/// # Errors
///
/// A sentence for a warning: the file cannot be written.
pub(super) fn record(
    input: &SweepInput,
    simulator: &dyn Simulator,
    wanted: &Wanted,
) -> Result<(), String> {
    let Wanted {
        point,
        probe,
        amplitude_m_per_s2,
        amplitude_g,
        path,
    } = wanted;
    let Some(outcome) = simulator.record(*point, *probe, *amplitude_m_per_s2) else {
        return Ok(());
    };
    let Some(history) = &outcome.history else {
        return Ok(());
    };
    use opshock_solver::simulation::Verdict;
    let (verdict, t_fail_s) = match &outcome.verdict {
        Verdict::Survives => ("survives", None),
        Verdict::Fails { t_fail_s, .. } => ("fails", Some(input.start_s + t_fail_s)),
        Verdict::Undecided { .. } => ("undecided", None),
    };
    let at = &input.points[*point];
    let mut coordinates = vec![
        ("ramp".to_owned(), at.coordinates.ramp.clone()),
        ("pulse_ms".to_owned(), at.coordinates.pulse_ms.to_string()),
        ("sign".to_owned(), at.coordinates.sign.as_str().to_owned()),
    ];
    for (name, value) in input.axes.iter().zip(&at.axes) {
        coordinates.push((name.clone(), value.to_string()));
    }
    let header = HistoryHeader {
        study: input.texts.name.clone(),
        digest: input.texts.digest.clone(),
        program_version: provenance::VERSION.to_owned(),
        commit: provenance::COMMIT.to_owned(),
        point: coordinates,
        amplitude_g: *amplitude_g,
        start_s: input.start_s,
        verdict: verdict.to_owned(),
        t_fail_s,
        effects: outcome
            .effects
            .iter()
            .map(|&name| name.to_owned())
            .collect(),
    };
    write_hdf5(path, history, &header).map_err(|error| error.to_string())
}
