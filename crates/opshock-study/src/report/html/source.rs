//! The input of a report: critical shocks, simulations, study, audit, accuracy.

use super::shock_film::ShockFilm;
use crate::accuracy::Accuracy;
use crate::report::answer::Answer;
use crate::report::chart::Figure;
use crate::report::coordinates;
use crate::report::critical_shock::critical_shock_over;
use crate::report::crossings::CrossingRow;
use crate::report::outcome_map::RunDot;
use crate::report::savings::Saving;
use crate::store::Audit;
use crate::store::summary::Summary;
use crate::study::Study;

/// What a report is made from.
#[derive(Clone, Copy, Debug)]
pub struct ReportSource<'a> {
    /// Critical shocks.
    pub summary: &'a Summary,
    /// Every simulation.
    pub runs: &'a [RunDot],
    /// Program that swept the store, as `provenance::program()` names it.
    pub program: &'a str,
    /// The study with every default written out, when the store has it.
    pub resolved_study: Option<&'a str>,
    /// The last audit of the store.
    pub audit: Option<&'a Audit>,
    /// What the rules saved.
    pub savings: &'a [Saving],
    /// Crossings of the ramps' curves, where the study asks for them.
    pub crossings: &'a [CrossingRow],
    /// What accuracy was measured to cost, if it was.
    pub accuracy: Option<&'a Accuracy>,
    /// Effects and rules of each ramp's scenes, as the JSON of the results; empty: not known.
    pub plan: &'a str,
    /// A kept shock to be shown moving.
    pub film: Option<&'a ShockFilm>,
    /// Coordinate on the abscissa of the critical shocks (see [`coordinates`]); `None`: the one with most numbers.
    pub abscissa: Option<usize>,
}

impl<'a> ReportSource<'a> {
    /// A report of the table and its simulations alone.
    pub fn of_table(summary: &'a Summary, runs: &'a [RunDot], program: &'a str) -> Self {
        Self {
            summary,
            runs,
            program,
            resolved_study: None,
            audit: None,
            savings: &[],
            crossings: &[],
            accuracy: None,
            plan: "",
            film: None,
            abscissa: None,
        }
    }

    /// Coordinate on the abscissa of the critical shocks.
    pub(super) fn x(&self) -> usize {
        let default = || coordinates::default_abscissa(self.summary);
        self.abscissa.unwrap_or_else(default)
    }

    /// The figure of the critical shocks.
    pub(in crate::report) fn figure(&self, provenance: &str) -> Figure {
        critical_shock_over(self.summary, self.x(), provenance)
    }

    /// The answer in words.
    pub fn answer(&self) -> String {
        Answer::of(self.summary).sentences().join(" ")
    }

    /// Discretisation parameters that are values of the study's model, in words.
    pub fn not_refined(&self) -> Option<String> {
        Study::from_text(self.resolved_study?, &[])
            .ok()?
            .not_refined()
    }

    /// The line under a table: program, study, audit.
    pub fn provenance(&self) -> String {
        let audit = self
            .audit
            .map_or(String::new(), |audit| format!("; {}", audit.sentence()));
        let values = self
            .not_refined()
            .map_or(String::new(), |values| values + "\n\n");
        let digest = &self.summary.digest;
        format!("{values}{}, study {digest}{audit}", self.program)
    }
}
