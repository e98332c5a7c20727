//! Histories recorded beside the results, a file for each kept run ([`KeptRun`]).
//!
//! Simulations of the search record nothing. When every point has its answer, those whose histories are kept run once
//! more with recording; the answer is the same to the bit. An existing file is used when it is whole and belongs to
//! this run.

use std::collections::HashSet;
use std::path::Path;

use opshock_solver::simulation::{FailureEvidence, Verdict};

use super::input::SweepInput;
use super::registry::Registry;
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
        let point = &input.points[self.point];
        let at = &point.coordinates;
        KeptRun {
            ramp: at.ramp.as_str(),
            pulse_ms: at.pulse_ms,
            sign: at.sign,
            axes: &input.axes,
            values: &point.axes,
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

/// Histories of final points. Points of equal content share theirs, which is that of the first.
pub(super) fn wanted(input: &SweepInput, registry: &Registry<'_>) -> Vec<Wanted> {
    let (mut wanted, mut keys) = (Vec::new(), HashSet::new());
    for point in (0..input.points.len()).filter(|&point| registry.wants(point)) {
        for probe in probes(input, registry, point) {
            let key = registry.key(point, probe);
            if !keys.insert(key) {
                continue;
            }
            wanted.push(Wanted {
                point: registry.first_of_content(point),
                probe,
                key,
                amplitude_m_per_s2: registry.amplitude_m_per_s2(point, probe),
                amplitude_g: input.settings.grid.amplitude_g(probe.index),
            });
        }
    }
    wanted
}

/// Probes of a point whose histories are kept.
fn probes(input: &SweepInput, registry: &Registry<'_>, point: usize) -> Vec<Probe> {
    let Some(search) = registry.campaign().search(point) else {
        return Vec::new();
    };
    if !registry.campaign().is_final(point) {
        return Vec::new();
    }
    let findings = registry.campaign().findings(point);
    let probes = search.log().iter().map(|asked| asked.probe);
    match input.keep_histories {
        KeepHistories::None => Vec::new(),
        KeepHistories::All => probes.collect(),
        KeepHistories::Bracket => {
            let ends = [findings.survivor, findings.failure];
            let is_end =
                |probe: &Probe| probe.window_factor == 1 && ends.contains(&Some(probe.index));
            // An amplitude decided by a retry keeps that run, which is its last.
            let mut kept: Vec<Probe> = Vec::new();
            for probe in probes.filter(is_end) {
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
    let (verdict, t_fail_s) = match &outcome.verdict {
        Some(Verdict::Survives) => ("survives", None),
        Some(Verdict::Fails { t_fail_s, .. }) => ("fails", Some(input.start_s + t_fail_s)),
        Some(Verdict::Undecided { .. }) => ("undecided", None),
        None => ("none", None),
    };
    let at = &input.points[*point];
    let axes = input.axes.iter().cloned().zip(at.axes.iter().cloned());
    let header = HistoryHeader {
        study: input.texts.name.clone(),
        digest: input.texts.digest.clone(),
        program_version: provenance::VERSION.to_owned(),
        commit: provenance::COMMIT.to_owned(),
        ramp: at.coordinates.ramp.to_string(),
        pulse_ms: at.coordinates.pulse_ms,
        sign: at.coordinates.sign,
        axes: axes.collect(),
        amplitude_g: *amplitude_g,
        start_s: input.start_s,
        verdict: verdict.to_owned(),
        t_fail_s,
        mechanism: FailureEvidence::of(&outcome).map(|evidence| evidence.mechanism()),
        effects: outcome
            .effects
            .iter()
            .map(|&name| name.to_owned())
            .collect(),
        run: run.content(),
    };
    write_hdf5(&run.path(folder), history, &header)
}
