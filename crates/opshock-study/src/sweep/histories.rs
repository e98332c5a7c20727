//! Histories kept beside the results, a file a run ([`KeptRun`]).
//!
//! Simulations of the search record nothing. When every point has its answer, those whose
//! histories are kept run once more with recording; the answer is the same to the bit. A file that
//! is there counts when it is whole and says that it is of this run.

use std::path::Path;

use super::input::SweepInput;
use super::ledger::Ledger;
use super::simulator::Simulator;
use crate::provenance;
use crate::search::Probe;
use crate::store::history::{HistoryHeader, KeptRun, write_hdf5};
use crate::store::{RunKey, StoreError};
use crate::study::KeepHistories;

/// A history to record.
#[derive(Clone, Debug)]
pub(super) struct Wanted {
    point: usize,
    probe: Probe,
    key: RunKey,
    amplitude_m_per_s2: f64,
    amplitude_g: f64,
}

impl Wanted {
    fn run<'a>(&self, input: &'a SweepInput) -> KeptRun<'a> {
        let at = &input.points[self.point].coordinates;
        KeptRun {
            ramp: &at.ramp,
            pulse_ms: at.pulse_ms,
            sign: at.sign,
            amplitude_g: self.amplitude_g,
            key: self.key,
            start_s: input.start_s,
            plan: &input.plan,
        }
    }

    /// Whether it is in the store in `folder`.
    ///
    /// # Errors
    ///
    /// A sentence about a file that is damaged or cannot be read.
    pub(super) fn is_kept(&self, input: &SweepInput, folder: &Path) -> Result<bool, String> {
        match self.run(input).read(folder) {
            Ok(kept) => Ok(kept.is_some()),
            Err(StoreError::Damaged { path, what, .. }) => {
                Err(format!("{}: {what}; it is recorded anew", path.display()))
            }
            Err(error) => {
                let reason = std::error::Error::source(&error).map(ToString::to_string);
                Err(format!(
                    "{error}: {}; it is recorded anew",
                    reason.unwrap_or_default()
                ))
            }
        }
    }
}

/// Histories of final points.
pub(super) fn wanted(input: &SweepInput, ledger: &Ledger<'_>) -> Vec<Wanted> {
    let mut wanted = Vec::new();
    for point in (0..input.points.len()).filter(|&point| ledger.wants(point)) {
        for probe in probes(input, ledger, point) {
            wanted.push(Wanted {
                point,
                probe,
                key: ledger.key(point, probe),
                amplitude_m_per_s2: ledger.amplitude_m_per_s2(point, probe),
                amplitude_g: input.settings.lattice.amplitude_g(probe.index),
            });
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

/// Records a history into the store in `folder`.
///
/// # Errors
///
/// E183: the file cannot be written.
pub(super) fn record(
    input: &SweepInput,
    simulator: &dyn Simulator,
    wanted: &Wanted,
    folder: &Path,
) -> Result<(), StoreError> {
    let run = wanted.run(input);
    let Wanted {
        point,
        probe,
        amplitude_m_per_s2,
        amplitude_g,
        ..
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
        run: run.content(),
    };
    write_hdf5(&run.path(folder), history, &header)
}
