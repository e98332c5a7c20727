//! Rounds of a sweep that gives uncertainty intervals to decisive points alone (`search::decisive`): a round begins when
//! every bracket and every interval of the rounds before is finished, so that it depends on no order of their runs.

use super::searches::Registry;
use super::stage::{Depth, UncertaintyStage};
use crate::search::decisive::{Further, Question, Standing, decisive};
use crate::store::summary::{Flag, PointSummary, Status};
use crate::sweep::input::{SweepInput, SweepPoint};

/// Target uncertainties by which a bracket is widened as long as there is no interval: first one, which finds the points to
/// begin with; when these are settled, as many as the largest half-width of an unrefined interval of Fig. 13 has (3.8 at
/// the preset coarse, 4.7 at standard), which finds the points that a large error hides.
const WIDENED_BY: [f64; 2] = [1.0, 5.0];

/// What the row of a point says about its critical shock; its bracket is widened by so many target
/// uncertainties where it has no interval.
fn standing(
    point: &SweepPoint,
    row: &PointSummary,
    depth: Depth,
    targets: f64,
) -> Option<Standing> {
    let bracket_g = row.bracket_g()?;
    let value_g = row.known_g()?;
    let Some(plan) = point
        .uncertainty
        .as_ref()
        .filter(|_| row.status == Status::Ok)
    else {
        return Some(Standing {
            value_g,
            range_g: bracket_g,
            further: Further::Nothing,
        });
    };
    let is_missed = row.flags.contains(&Flag::TargetNotMet);
    let [low_g, high_g] = bracket_g;
    let wider = targets * plan.target;
    Some(Standing {
        value_g,
        range_g: row
            .interval_g()
            .unwrap_or([low_g * (1.0 - wider), high_g * (1.0 + wider)]),
        further: match depth {
            Depth::Bracket => Further::Interval,
            Depth::Refined(done) if is_missed && done < plan.refinements => Further::Refinement,
            Depth::Refined(_) => Further::Nothing,
        },
    })
}

/// Points whose uncertainty the next round takes further, by the rows of all and how far theirs has been taken; none where
/// the answer depends on no other run.
pub(in crate::sweep) fn next_round(
    input: &SweepInput,
    row: &dyn Fn(usize) -> PointSummary,
    depth: &dyn Fn(usize) -> Depth,
) -> Vec<usize> {
    let Some(question) = &input.decides else {
        return Vec::new();
    };
    let rows: Vec<PointSummary> = (0..input.points.len()).map(row).collect();
    let round = |targets: f64| {
        let points = input.points.iter().zip(&rows).enumerate();
        let standings: Vec<Option<Standing>> = points
            .map(|(place, (point, row))| {
                let mut at = standing(point, row, depth(place), targets)?;
                // An interval that is not whole decides nothing.
                let is_made = row.status == Status::Ok && at.further != Further::Interval;
                if matches!(question, Question::Survives(_)) && is_made && !row.has_whole_interval()
                {
                    at.range_g = [0.0, f64::INFINITY];
                }
                Some(at)
            })
            .collect();
        decisive(question, &standings)
    };
    let mut rounds = WIDENED_BY.into_iter().map(round);
    rounds.find(|round| !round.is_empty()).unwrap_or_default()
}

impl Registry<'_> {
    /// Begins the next round where the last one is finished. Returns the points whose uncertainty is taken further.
    pub(super) fn begin_round(&mut self) -> Vec<usize> {
        let mut places = 0..self.input.points.len();
        if self.is_decided
            || !self.campaign.is_done()
            || !places.all(|point| self.is_at_depth(point))
        {
            return Vec::new();
        }
        let row = |point: usize| self.row_with(point, self.campaign.findings(point));
        let depth = |point: usize| self.depths[self.source(point)];
        let round = next_round(self.input, &row, &depth).into_iter();
        let mut round: Vec<usize> = round.map(|point| self.source(point)).collect();
        round.sort_unstable();
        round.dedup();
        for &point in &round {
            self.depths[point] = self.depths[point].next();
        }
        if round.is_empty() {
            self.is_decided = true;
            self.n_changes += 1;
        }
        round
    }

    /// How far the uncertainty of every point is taken so far, by place.
    pub(in crate::sweep) fn depths(&self) -> &[Depth] {
        &self.depths
    }

    /// No later round takes the uncertainty of any point further.
    pub(in crate::sweep) fn is_decided(&self) -> bool {
        self.is_decided
    }

    /// The point whose interval is that of `point`.
    fn source(&self, point: usize) -> usize {
        match self.uncertainties[point] {
            UncertaintyStage::Taken { companion } => companion,
            _ => point,
        }
    }
}
