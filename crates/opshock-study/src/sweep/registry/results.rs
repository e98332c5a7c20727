//! Rows of the table, runs and store content from the evidence of the searches.

use super::searches::Registry;
use super::stage::{UncertaintyStage, uncertainty_asked};
use crate::search::{Findings, Status, Touch, uncertainty};
use crate::store::summary::{PointSummary, Summary, Totals};
use crate::store::{PointKeep, Results, RunRecord, RunRow, Session, machine};
use crate::sweep::rows;
use std::collections::HashSet;

impl Registry<'_> {
    /// Row of a point as the evidence has it.
    pub(in crate::sweep) fn row(&self, point: usize) -> PointSummary {
        let mut findings = self.campaign.findings(point);
        if !self.is_final(point) {
            findings.status = Status::Open;
        }
        self.row_with(point, findings)
    }

    /// Row of a point with these findings, and its interval where that is finished.
    pub(super) fn row_with(&self, point: usize, findings: Findings) -> PointSummary {
        let onset_g = self.campaign.touch(point).and_then(Touch::onset_g);
        rows::row(
            &self.input.points[point],
            &findings,
            self.finished_uncertainty(point),
            onset_g,
            &self.input.settings.grid,
        )
    }

    /// Lowest failure that the search of a point found at the study's own resolution, G.
    pub(in crate::sweep) fn failure_g(&self, point: usize) -> Option<f64> {
        let failure = self.campaign.findings(point).failure?;
        Some(self.input.settings.grid.amplitude_g(failure))
    }

    /// Table, runs and the data stored beside them.
    pub(in crate::sweep) fn results(&self, session: &Session) -> Results {
        let mut used = HashSet::new();
        let mut runs = Vec::new();
        for (point, _) in self.input.points.iter().enumerate() {
            let Some(search) = self.campaign.search(point) else {
                continue;
            };
            let uncertainty: &[uncertainty::Ask] = match &self.uncertainties[point] {
                UncertaintyStage::Begun { log, .. } => log,
                _ => &[],
            };
            let asked = search.log().iter().copied();
            let asked = asked.chain(uncertainty.iter().map(|&ask| uncertainty_asked(ask)));
            for (sequence, asked) in asked.enumerate() {
                let key = self.key(point, asked.probe);
                used.insert(key);
                runs.push(RunRow {
                    point,
                    sequence,
                    purpose: asked.purpose,
                    index: asked.probe.index,
                    levels: asked.probe.levels,
                    amplitude_g: self.amplitude_g(asked.probe),
                    run: self.runs[&key].clone(),
                });
            }
        }
        let mut outside: Vec<RunRecord> = self
            .runs
            .values()
            .filter(|record| !used.contains(&record.key))
            .cloned()
            .collect();
        outside.sort_by_key(|record| record.key);
        let rows: Vec<PointSummary> = (0..self.input.points.len())
            .map(|point| self.row(point))
            .collect();
        let totals = Totals::of(&rows, runs.iter().map(RunRow::counted));
        Results {
            summary: Summary {
                study: self.input.texts.name.clone(),
                digest: self.input.texts.digest.clone(),
                axes: self.input.axes.clone(),
                points: rows,
                totals,
            },
            steps_per_octave: self.input.settings.grid.steps_per_octave,
            start_s: self.input.start_s,
            plan: self.input.plan.clone(),
            points: self
                .input
                .points
                .iter()
                .map(|point| PointKeep {
                    digest: point.digest,
                    touch: self.touches.get(&point.digest).copied(),
                })
                .collect(),
            runs,
            outside,
            session: session.clone(),
            written_unix_s: machine::unix_now_s(),
        }
    }
}
